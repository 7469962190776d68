"""A hundred cubes that fell onto a plate: few contacts are listed, and none of them is a ghost."""

from __future__ import annotations

import itertools
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

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
MOST = 3000
"""Contacts that may be listed: thirty a cube."""
DEEPER = 1e-6
"""By how much a contact may be deeper than its bodies are inside of each other [m]."""
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


@pytest.fixture(scope="module")
def fallen() -> Fallen:
    """Poses of cubes 0.5 s after they fell in a heap of any orientations, computed by time stepping."""
    poses = np.array(json.loads(_POSES.read_text(encoding="utf-8")))
    cubes = [BoxBody(HALF, HALF, HALF) for _ in poses]
    system = ns.System([Plate(), *cubes])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.2), EnergeticImpact(0.5)))
    for cube, pose in zip(cubes, poses, strict=True):
        system.place(cube, position=tuple(pose[:3]), orientation=tuple(pose[3:]))
    return Fallen(poses, listed(system))


@pytest.mark.slow
def test_few_contacts_are_listed(fallen: Fallen) -> None:
    assert len(fallen.contacts.contact) <= MOST


@pytest.mark.slow
def test_no_contact_is_deeper_than_its_bodies(fallen: Fallen) -> None:
    """No two cubes are deeper inside of each other than the time stepping lets them be, 1e-4 of their extent."""
    pairs = {tuple(row) for row in fallen.contacts.bodies.tolist()}
    least = {pair: fallen.least(*pair) for pair in pairs}
    assert min(least.values()) > -2e-6
    bounds = np.array([least[tuple(row)] for row in fallen.contacts.bodies.tolist()])
    ghosts = fallen.contacts.gap < bounds - DEEPER
    assert np.sum(ghosts) == 0


@pytest.mark.slow
def test_every_pair_that_touches_has_a_contact_as_deep(fallen: Fallen) -> None:
    """Nearer than a micrometre there is a contact of the pair with its gap."""
    near = 0
    for i, j in itertools.combinations(range(len(fallen.poses) + 1), 2):
        if i and np.linalg.norm(fallen.poses[i - 1, :3] - fallen.poses[j - 1, :3]) > 4.0 * HALF:
            continue
        least = fallen.least(i, j)
        if least < 1e-6:
            mine = np.all(np.sort(fallen.contacts.bodies, axis=1) == (i, j), axis=1) & fallen.contacts.within
            assert np.min(np.abs(fallen.contacts.gap[mine] - least), initial=np.inf) < 1e-9, (i, j)
            near += 1
    assert near > 50
