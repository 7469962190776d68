"""A contact that touches had a bound of at most the displacement of the bodies, from wherever these came."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BoxBody, CapsuleBody, HullBody, MeshBody
from bodies.meshes.triangles import Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import blocks
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from nonsmooth.testing.functions import plain_caller
from tests.benchmarks.head_on.measured import Pose, separation
from tests.benchmarks.random_systems.pieces import pieces_of, rotations
from tests.bodies.every_pair import all_features

_REACH = 0.1
"""Distance from the origin of either body that no point of it exceeds [m]."""
_TOUCHES = 1e-10
_WEDGE = [(0.05, 0.0, 0.0), (-0.02, 0.03, 0.01), (-0.02, -0.03, 0.01), (0.01, 0.0, -0.04)]
_FACES = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]
BRICK, CUBE = BoxBody(0.05, 0.03, 0.02), BoxBody(0.03, 0.03, 0.03)
HULL, MESH = HullBody(_WEDGE, 1000.0), MeshBody(Triangles(_WEDGE, _FACES))
PAIRS: dict[str, tuple[Body, Body]] = {
    "boxes": (BRICK, CUBE),
    "box and hull": (BRICK, HULL),
    "rounded boxes": (BoxBody(0.05, 0.03, 0.02, rounding=0.004), BoxBody(0.03, 0.03, 0.03, rounding=0.002)),
    "rounded box and capsule": (BoxBody(0.05, 0.03, 0.02, rounding=0.004), CapsuleBody(0.03, 0.01)),
    "meshes": (MESH, MeshBody(Triangles(_WEDGE, _FACES))),
    "mesh and box": (MESH, CUBE),
}


def _block(pose: Pose) -> Vector:
    """Return the frame block of a body."""
    block = np.zeros(blocks.FRAME)
    block[blocks.POSITION : blocks.ROTATION], block[blocks.ROTATION : blocks.VELOCITY] = pose[0], pose[1].ravel()
    return block


def _turn(rng: np.random.Generator, angle: float) -> Vector:
    """Return the matrix of a rotation by an angle [rad] about any axis."""
    axis = rng.normal(size=3)
    (turned,) = rotations(np.array([[math.cos(0.5 * angle), *(math.sin(0.5 * angle) * axis / np.linalg.norm(axis))]]))
    return np.asarray(turned)


def _touching(first: Body, second: Body, rng: np.random.Generator) -> tuple[Pose, Pose]:
    """Return poses at which two bodies touch, from any side and in any orientation, some of them aligned."""
    aligned = rng.random() < 0.3
    a, b = (np.eye(3) if aligned else _turn(rng, 3.0 * rng.random()) for _ in range(2))
    here, there = np.zeros(3), 0.2 * (way := rng.normal(size=3)) / np.linalg.norm(way)
    for _ in range(60):
        gap, _ = separation(pieces_of(first), pieces_of(second), (here, a), (there, b), 1.0)
        if gap <= 0.01 * _TOUCHES:
            break
        # along the line of centres, by no more than the gap
        there = there - gap * there / np.linalg.norm(there)
    return (here, a), (there, b)


def _moved(pose: Pose, rng: np.random.Generator, size: float) -> tuple[Pose, float]:
    """Return a pose nearby, and the largest displacement of a point of the body on the way [m]."""
    shift, angle = size * rng.normal(size=3), size / _REACH * rng.normal()
    return (pose[0] + shift, _turn(rng, angle) @ pose[1]), float(np.linalg.norm(shift)) + abs(angle) * _REACH


def _contacts(first: Body, second: Body) -> Iterator[Any]:
    """Yield the kinematics of the contacts that have a bound."""
    system = ns.System([first, second])
    with all_features():
        system.contact(first, second, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    assert any(contact.kinematics.bound is not None for contact in system.contacts)
    for contact in system.contacts:
        if contact.kinematics.bound is not None:
            yield contact.kinematics


@pytest.mark.parametrize("name", PAIRS)
def test_bodies_touch_after_moving_by_the_bound_at_least(name: str) -> None:
    rng, found = np.random.default_rng(7), 0
    first, second = PAIRS[name]
    functions = [
        [plain_caller(f, "pair", one.parameters()) for f in (one.evaluator, one.bound)]
        for one in _contacts(first, second)
    ]
    for _ in range(30):
        at = _touching(first, second, rng)
        (one, path), (two, other) = (_moved(pose, rng, 10.0 ** rng.uniform(-6.0, -1.5)) for pose in at)
        for evaluate, bound in functions:
            out, least = np.zeros(blocks.PAIR), np.zeros(1)
            evaluate(*map(_block, at), out)
            if abs(out[blocks.GAP]) > _TOUCHES or out[blocks.PAST_END] > 0.0:
                continue
            bound(_block(one), _block(two), least)
            assert least[0] <= path + other + _TOUCHES
            found += 1
    assert found > 20
