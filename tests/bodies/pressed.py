"""Two bodies that are pressed into each other, and what their contacts have to be there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.head_on.measured import gap, separation
from tests.benchmarks.random_systems.convex import CORNERS
from tests.benchmarks.random_systems.families.aligned import Turn
from tests.benchmarks.random_systems.gaps import farthest
from tests.benchmarks.random_systems.pieces import Piece, pieces_of, rotations
from tests.bodies.listed import Listed, listed

ACCURACY = 1e-9
"""Error of a gap and of a point [m]."""
DIRECTION = 1e-6
"""Error of a normal [rad]."""
_POINT = Piece(CORNERS, np.zeros(5), np.zeros((1, 3)), 0.0, np.zeros(3), np.eye(3))


@dataclass(frozen=True)
class Pressed:
    """Two bodies: the first one at the origin, both with their orientations, the second one at a place [m]."""

    bodies: tuple[Body, Body]
    turns: tuple[Turn, Turn]
    place: Vector

    @property
    def axes(self) -> tuple[Vector, Vector]:
        """The axes of both bodies as columns."""
        one, two = rotations(np.array(self.turns))
        return one, two

    @property
    def pieces(self) -> tuple[list[Piece], list[Piece]]:
        """The convex pieces of both bodies."""
        return pieces_of(self.bodies[0]), pieces_of(self.bodies[1])

    def measured(self) -> tuple[float, Vector]:
        """Return the gap [m] and its direction, by support functions."""
        return separation(*self.pieces, (np.zeros(3), self.axes[0]), (self.place, self.axes[1]))

    def moved(self, way: Vector) -> Pressed:
        """Return the same with the second body moved [m]."""
        return Pressed(self.bodies, self.turns, self.place + way)

    def along(self, way: Vector) -> float:
        """Return the gap along a direction from the first body to the second [m]: the best one is that of the pair."""
        (first, second), (one, other) = self.pieces, self.axes
        behind = min(float(self.place @ way) - farthest(piece, -other.T @ way) for piece in second)
        return behind - max(farthest(piece, one.T @ way) for piece in first)

    def contacts(self, of_all: bool = True) -> Listed:
        """Return the contacts on the neighbour list, as of the second body against the first.

        ``of_all`` is False for the list of a run, which leaves out the contacts that cannot close soon.
        """
        system = ns.System(list(self.bodies), gravity=0.0)
        system.contact(*self.bodies, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
        system.place(self.bodies[0], orientation=self.turns[0])
        system.place(self.bodies[1], position=tuple(self.place), orientation=self.turns[1])
        found = listed(system, of_all)
        swapped = found.bodies[:, :1] == 1
        points = np.where(swapped, found.second, found.first), np.where(swapped, found.first, found.second)
        normal = np.where(swapped, -found.normal, found.normal)
        return Listed(found.contact, found.bodies, found.gap, found.past, normal, *points)


def stacked(bodies: tuple[Body, Body], axis: int, depth: float, shift: Vector, turns: tuple[Turn, Turn]) -> Pressed:
    """Return two bodies, the second one pressed in along an axis of the world and shifted across it."""
    way = np.eye(3)[axis]
    axes = rotations(np.array(turns))
    ahead = max(farthest(piece, axes[0].T @ way) for piece in pieces_of(bodies[0]))
    behind = max(farthest(piece, -axes[1].T @ way) for piece in pieces_of(bodies[1]))
    return Pressed(bodies, turns, (ahead + behind - depth) * way + np.roll([0.0, *shift], axis))


def brought(bodies: tuple[Body, Body], turns: tuple[Turn, Turn], way: Vector, depth: float) -> Pressed:
    """Return two bodies, of which the second one came along a direction and is pressed in by a depth [m]."""
    reach = sum(max(piece.reach + float(np.linalg.norm(piece.place)) for piece in pieces_of(b)) for b in bodies)
    pose = Pressed(bodies, turns, reach * way)
    for _ in range(60):
        found, normal = pose.measured()
        if abs(found + depth) < 1e-13:
            break
        pose = pose.moved(-(found + depth) * (normal if found < 1e-4 else way))
    return pose


def _size(body: Body) -> float:
    return max(piece.reach for piece in pieces_of(body))


def _set_back(body: Body) -> float:
    """Height of the feet by which rims are set back [m]."""
    return max((shape.solid.set_back for frame in body.frames for shape in frame if shape.solid), default=0.0)


def faults(pose: Pressed, angle: float = 0.0) -> list[str]:
    """Return what is wrong with the contacts of two convex bodies that overlap.

    The deepest contact is as deep as the bodies are, but for rims that are set back by their feet.  Along the normal of
    a contact below zero the bodies are no deeper than along the best direction, but for the angle [rad] of faces that
    are nearly parallel.  Its points are on the surfaces of the bodies, as far apart as its gap.
    """
    (least, way), contacts = pose.measured(), pose.contacts()
    gaps = contacts.gap[contacts.within]
    found = []
    accuracy = ACCURACY + sum(map(_set_back, pose.bodies))
    if not np.any((gaps >= least - ACCURACY) & (gaps <= least + accuracy)):
        found.append(f"none: the bodies are at {least:.3g} m, the contacts at {np.sort(gaps)[:3]} m")
    allowed = ACCURACY + (angle + DIRECTION) * max(map(_size, pose.bodies))
    for k in np.flatnonzero(contacts.within & (contacts.gap < -ACCURACY)):
        gap_, normal, points = float(contacts.gap[k]), contacts.normal[k], (contacts.first[k], contacts.second[k])
        said = f"gap {gap_:.3g} m along {normal.round(6)}, bodies at {least:.3g} m along {way.round(6)}"
        if pose.along(normal) < least - allowed:
            found.append(f"ghost: {said}, but at {pose.along(normal):.3g} m along the normal")
            continue
        if abs((points[1] - points[0]) @ normal - gap_) > ACCURACY:
            found.append(f"apart: points by {(points[1] - points[0]) @ normal:.3g} m, {said}")
        for body, axes, place, point in zip(pose.pieces, pose.axes, (np.zeros(3), pose.place), points, strict=True):
            off = gap(body, [_POINT], (place, axes), (point, np.eye(3)))
            if abs(off) > accuracy:
                found.append(f"point: {off:.3g} m off the surface, {said}")
    return found


def any_turn(random: np.random.Generator) -> Turn:
    """Draw any orientation."""
    q = random.normal(size=4)
    return tuple((q / np.linalg.norm(q)).tolist())
