"""A hundred cubes that fell onto a plate, with the contacts on the neighbour list."""

from __future__ import annotations

import functools
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import nonsmooth as ns
from bodies import BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.head_on.measured import FAR, gap
from tests.benchmarks.random_systems.gaps import farthest
from tests.benchmarks.random_systems.pieces import pieces_of, rotations
from tests.bodies.listed import Listed, listed

HALF = 0.01
"""Half of a side [m]."""
_POSES = Path(__file__).parent / "fallen_cubes.json"


@dataclass(frozen=True)
class Fallen:
    """Poses of the cubes, shape [100, 7], and the contacts on the neighbour list there."""

    poses: Vector
    contacts: Listed

    def least(self, one: int, other: int) -> float:
        """Return the gap of two bodies [m], of distant ones a lower bound; body 0 is the plate."""
        pieces, axes = pieces_of(BoxBody(HALF, HALF, HALF)), rotations(self.poses[:, 3:])
        i, j = min(one, other) - 1, max(one, other) - 1
        if i < 0:
            return float(self.poses[j, 2]) - farthest(pieces[0], -axes[j].T @ np.array([0.0, 0.0, 1.0]))
        first, second = (self.poses[i, :3], axes[i]), (self.poses[j, :3], axes[j])
        return min(gap(pieces, pieces, first, second), FAR)


@functools.cache
def fallen(of_all: bool = True) -> Fallen:
    """Cubes 0.5 s after they fell in a heap of any orientations, computed by time stepping.

    Parameters
    ----------
    of_all : bool
        False for the contacts that a run lists: those of cubes that touch.
    """
    poses = np.array(json.loads(_POSES.read_text(encoding="utf-8")))
    cubes = [BoxBody(HALF, HALF, HALF) for _ in poses]
    system = ns.System([Plate(), *cubes])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.2), EnergeticImpact(0.5)))
    for cube, pose in zip(cubes, poses, strict=True):
        system.place(cube, position=tuple(pose[:3]), orientation=tuple(pose[3:]))
    return Fallen(poses, listed(system, of_all))
