"""Pairs that touch when they start: at rest, pushed, or one on the other."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

import nonsmooth as ns
from bodies import Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from tests.benchmarks.head_on.meeting import Meeting, Placed
from tests.benchmarks.head_on.pairs import PAIRS
from tests.benchmarks.random_systems.families.aligned import UPRIGHT
from tests.benchmarks.random_systems.gaps import farthest
from tests.benchmarks.random_systems.pieces import pieces_of
from tests.physics.limited import limited

GRAVITY = 9.81
"""Gravity [m/s^2]."""


def axes_of(name: str) -> tuple[int, ...]:
    """Return the axes along which a pair can touch: along the third one not where bodies have feet that stand out."""
    feet = sum(piece.slack for make in PAIRS[name].seen for piece in pieces_of(make()))
    return (0, 1) if feet > 0.0 else (0, 1, 2)


def moved(name: str, axis: int, turn: float = 0.0, speed: float = 0.0) -> float:
    """Return how far off its way a body is 0.1 s after two in touch started with one velocity [m, rad], any axes."""
    placed = Placed.of(Meeting(name, axis, turn=turn, distance=0.0))
    system = placed.system()
    velocity = tuple(speed * placed.way)
    for body, turned, place in zip(placed.bodies, placed.turns, (np.zeros(3), placed.place), strict=True):
        system.place(body, orientation=turned, position=tuple(place), velocity=velocity)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        solution = ns.simulate(system, 0.1)
    assert solution.status == "done"
    off = 0.0
    for body in placed.bodies:
        q, u = solution.of(body)
        went = q[-1, :3] - q[0, :3] - 0.1 * np.array(velocity)
        off = max(off, *np.abs(went), *np.abs(q[-1, 3:] - q[0, 3:]), *np.abs(u[-1] - u[0]))
    return off


@dataclass(frozen=True)
class Stacked:
    """Two bodies on a plate after 0.1 s.

    Attributes
    ----------
    off : float
        Largest change of a coordinate or velocity.
    forces : tuple of float
        Sums of the normal forces on the plate and between the bodies, relative to the weights that they carry.
    points : int
        Number of closed contacts between the bodies.
    """

    off: float
    forces: tuple[float, float]
    points: int


_UP = (ns.turned_about((0.0, 1.0, 0.0), -0.5 * np.pi), ns.turned_about((1.0, 0.0, 0.0), 0.5 * np.pi), UPRIGHT)
"""Orientations in which each of the axes of a body points up."""


def stacked(name: str, axis: int, turn: float = 0.0, shift: tuple[float, float] = (0.0, 0.0)) -> Stacked:
    """Put the second body of a pair on the first one, along an axis of theirs, and run."""
    world = tuple(float(x) for x in _UP[axis])
    placed = Placed.of(Meeting(name, axis, shift, turn, world=world, distance=0.0))  # type: ignore[arg-type]
    plate, (low, high) = Plate(), placed.bodies
    system = ns.System([plate, low, high], GRAVITY)
    laws = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5))
    for one, other in ((plate, low), (low, high)):
        system.contact(one, other, normal=laws.normal, friction=laws.friction, impact=laws.impact)
    height = max(farthest(piece, -np.eye(3)[axis]) for piece in placed.pieces[0]) * placed.way
    for body, turned, place in zip(placed.bodies, placed.turns, (height, height + placed.place), strict=True):
        system.place(body, orientation=turned, position=tuple(place))
    solution = limited(system, 0.1)
    assert solution.status == "done", solution.message
    last = solution.history("normal_force", "mode", times=0.09)
    # equal bodies are told apart by what they are
    below = np.array([c.first is plate for c in system.contacts])
    between = ~below
    weights = [float(body.total_mass) * GRAVITY for body in (low, high)]  # type: ignore[attr-defined]
    forces = last["normal_force"]
    parts = float(forces[below].sum()) / sum(weights), float(forces[between].sum()) / weights[1]
    off = float(max(np.abs(solution.q_end - solution.q[0]).max(), np.abs(solution.u_end).max()))
    return Stacked(off, parts, int(np.sum(last["mode"][between] != ns.Mode.OPEN)))
