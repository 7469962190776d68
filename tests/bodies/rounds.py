"""Poses of cylinders, cones and discs whose nearest features are known because they are made from them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Frustum
from bodies.shapes.frustum import AXIS
from tests.benchmarks.touches import ROUND, ROUNDED_ROUND, Touch, on_round

Array = NDArray[np.float64]
_SHARPEST = 0.2
"""Sine of the angle at which tangents cross at least."""


def touch_round(rng: Generator, name: str, part: str, is_on_feet: bool = True) -> Touch:
    """Return a cylinder, cone or disc, sharp or rounded, a point of a part of it and a normal there.

    Bodies with faces touch one ``is_on_feet`` at rims and caps that are set back by its feet.
    """
    return on_round({**ROUND, **ROUNDED_ROUND}[name][0], part, is_on_feet)(rng)


def tangent(shape: Any, part: str, normal: Array) -> Array | None:
    """Return the direction that a crossing edge must not have: along a rim, or along the side."""
    axis = np.array(shape.frustum[AXIS::3][:3]) if isinstance(shape, Frustum) else np.zeros(3)
    around = np.cross(axis, normal)
    if part == "rim":
        return np.asarray(around / np.linalg.norm(around))
    if part == "side":
        along = np.cross(around, normal)
        return np.asarray(along / np.linalg.norm(along))
    return None


class PosedRound:
    """Two bodies whose nearest points are known: gap, normal, witness points.

    Parameters
    ----------
    rng : Generator
        Draws the pose.
    first, second : Touch
        The shapes, their points and their outward normals.
    tangents : tuple
        Direction of the first and of the second at the point that must not be parallel, None where any may be.
    gap : float
        How far the points are apart [m].
    """

    def __init__(self, rng: Generator, first: Touch, second: Touch, tangents: Any, gap: float) -> None:
        (_, own, n), (_, other, out) = first, second
        turn, place = Rotation.random(random_state=rng), rng.uniform(-0.1, 0.1, 3)
        while True:
            facing = self._turn(out, -n, rng.uniform(0.0, 2.0 * np.pi))
            if tangents[0] is None or tangents[1] is None:
                break
            if np.linalg.norm(np.cross(tangents[0], facing.apply(tangents[1]))) > _SHARPEST:
                break
        self.gap, self.normal = gap, turn.apply(n)
        self.witness = turn.apply(own) + place, turn.apply(own + gap * n) + place
        second_turn = turn * facing
        self.poses = [
            (place, np.roll(turn.as_quat(), 1)),
            (self.witness[1] - second_turn.apply(other), np.roll(second_turn.as_quat(), 1)),
        ]

    @staticmethod
    def _turn(start: Array, end: Array, spin: float) -> Rotation:
        """Return a rotation that turns one unit vector into another, and then by an angle about it."""
        axis = np.cross(start, end)
        angle = np.arctan2(np.linalg.norm(axis), start @ end)
        return Rotation.from_rotvec(spin * end) * Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))

    def found_in(self, blocks: Array) -> list[int]:
        """Return the numbers of the contacts that have this gap, normal and witness points."""
        right = (blocks[:, 30] <= 0.0) & (np.abs(blocks[:, 0] - self.gap) <= 1e-15)
        right &= np.linalg.norm(blocks[:, 1:4] - self.normal, axis=1) <= 1e-9
        for i in range(2):
            right &= np.linalg.norm(blocks[:, 7 + 3 * i : 10 + 3 * i] - self.witness[i], axis=1) <= 1e-12
        return [int(i) for i in np.flatnonzero(right)]

    def moved(self, u: Array, t: float) -> list[tuple[Array, Array]]:
        """Return the poses after a time with constant velocity and body-fixed spin."""
        poses = []
        for i, (place, q) in enumerate(self.poses):
            v, spin = u[6 * i : 6 * i + 3], u[6 * i + 3 : 6 * i + 6]
            turn = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(t * spin)
            poses.append((place + t * v, np.roll(turn.as_quat(), 1)))
        return poses
