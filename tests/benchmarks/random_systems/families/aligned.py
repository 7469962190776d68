"""How flush bodies lie to each other: axes in line but for small shifts and angles, faces at a distance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth import ContactLaws
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems.case import Start
from tests.benchmarks.random_systems.contact_laws import laws_of
from tests.benchmarks.random_systems.gaps import farthest
from tests.benchmarks.random_systems.pieces import pieces_of, rotations
from tests.benchmarks.random_systems.solids import Random, number

Turn = tuple[float, float, float, float]
UPRIGHT: Turn = (1.0, 0.0, 0.0, 0.0)
DOWN, UP = np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0])
_SAMPLES = 0.1
"""Part of the widths of two bodies by which they move between two samples: none passes through unseen."""
_THINNEST = 0.05
"""Width relative to the size that a body without thickness counts with."""


def size_of(random: Random) -> float:
    """Draw half of the length of a body [m]."""
    return float(random.choice([0.006, 0.012, 0.02]))


def shift(random: Random, size: float) -> float:
    """Draw a shift [m]: 0, or 1e-12 to 1e-3 of the size to either side."""
    if random.random() < 0.4:
        return 0.0
    return float(random.choice([-1.0, 1.0]) * size * 10.0 ** random.uniform(-12.0, -3.0))


def tiny(random: Random, size: float) -> float:
    """Draw a gap [m]: 0 exactly, or 1e-12 to 1e-3 of the size."""
    return abs(shift(random, size))


def product(one: Turn, two: Turn) -> Turn:
    """Return the unit quaternion of two rotations, the second one first."""
    w, v, other = one[0], np.array(one[1:]), np.array(two[1:])
    q = np.array([w * two[0] - v @ other, *(w * other + two[0] * v + np.cross(v, other))])
    return tuple((q / np.linalg.norm(q)).tolist())


def about(axis: Vector, angle: float) -> Turn:
    """Return the quaternion of a rotation by an angle [rad]."""
    return (math.cos(0.5 * angle), *(math.sin(0.5 * angle) * axis).tolist())


def small_turn(random: Random, axis: Vector) -> Turn:
    """Draw a rotation by 0, or 1e-9 to 1e-2 rad: mostly about an axis, else about any."""
    other = random.normal(size=3)
    chosen = axis if random.random() < 0.7 else other / np.linalg.norm(other)
    if random.random() < 0.4:
        return UPRIGHT
    return about(chosen, float(random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-9.0, -2.0)))


def face(random: Random, upright: float) -> Turn:
    """Draw which faces of a body point along the axes: those it is made with, of a chance, or any."""
    first, second = np.eye(3)[random.integers(3, size=2)]
    quarters = 0.5 * math.pi * random.integers(4, size=2)
    return UPRIGHT if random.random() < upright else product(about(first, quarters[0]), about(second, quarters[1]))


@dataclass(frozen=True)
class Laid:
    """A body with its orientation."""

    body: Body
    turn: Turn

    def reach(self, way: Vector) -> float:
        """Return how far it reaches from its origin along a unit vector [m], with the feet of a disc."""
        local = rotations(np.array([self.turn]))[0].T @ way
        ends = (farthest(piece, local) + (piece.slack if piece.flat else 0.0) for piece in pieces_of(self.body))
        return max(ends)

    def width(self, way: Vector) -> float:
        """Return the least width of its pieces along a unit vector [m]."""
        local = rotations(np.array([self.turn]))[0].T @ way
        return min(farthest(piece, local) + farthest(piece, -local) for piece in pieces_of(self.body))


def lay(random: Random, bodies: list[Body], turn: Turn, axis: Vector) -> list[Laid]:
    """Lay bodies with the same faces along an axis, all but the first turned by small angles."""
    return [Laid(body, product(small_turn(random, axis), turn) if k else turn) for k, body in enumerate(bodies)]


def next_to(random: Random, place: Vector, one: Laid, other: Laid, way: Vector, gap: float) -> Vector:
    """Return where a body is next to another one: ahead of it by a gap along a unit vector, shifted across."""
    size = one.reach(way)
    across = np.array([shift(random, size) for _ in range(3)])
    across -= (across @ way) * way
    return np.asarray(place + (one.reach(way) + other.reach(-way) + gap) * way + across)


def start(laid: Laid, place: Vector, velocity: Vector | None = None) -> Start:
    """Return the start of a body at a place [m] with a velocity [m/s], at rest without."""
    words: dict[str, Any] = {"position": tuple(place.tolist()), "orientation": laid.turn}
    if velocity is not None:
        words["velocity"] = tuple(velocity.tolist())
    return Start("place", tuple(words.items()))


def interval(laid: list[Laid], way: Vector, speed: float, size: float) -> float:
    """Return the time between samples [s] in which bodies of a size [m] move by a part of their widths at a speed."""
    widths = sorted(max(one.width(way), _THINNEST * size) for one in laid)
    return float(f"{min(_SAMPLES * (widths[0] + widths[1]) / speed, 1e-3):.3g}")


def laws(random: Random) -> Callable[[], ContactLaws]:
    """Return what gives each contact its laws: Coulomb or no friction and one restitution mostly, else any."""
    if random.random() < 0.35:
        return laws_of(random)
    friction = Frictionless() if random.random() < 0.3 else Coulomb(number(random, 0.02, 0.8))
    chosen = ContactLaws(Unilateral(), friction, EnergeticImpact(float(random.choice([0.0, 0.3, 0.5, 0.8, 1.0]))))
    return lambda: chosen


def all_pairs(n: int, draw: Callable[[], ContactLaws]) -> tuple[tuple[int, int, ContactLaws], ...]:
    """Return contacts between all of ``n`` bodies."""
    return tuple((i, j, draw()) for j in range(n) for i in range(j))
