"""Contacts within a step, in which the quaternion of a body has another length than 1, and its axes are as long."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Cone, Cylinder, Disc, Ellipsoid, Sphere, Superellipsoid
from nonsmooth.binding.source import name_of
from nonsmooth.engine.memory.blocks import FRAME, GEOMETRY, PAST_END
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.every_pair import pairs_of
from tests.contact_calls import pair_caller

SHAPES: dict[str, Any] = {
    "box": Box(7e-3, 5e-3, 4e-3),
    "rounded box": Box(7e-3, 5e-3, 4e-3, rounding=1e-3),
    "capsule": Capsule(3e-3, 6e-3),
    "sphere": Sphere(5e-3),
    "cylinder": Cylinder(6e-3, 8e-3),
    "rounded cylinder": Cylinder(6e-3, 8e-3, rounding=2e-3),
    "cone": Cone(8e-3, 15e-3),
    "disc": Disc(9e-3),
    "ellipsoid": Ellipsoid(1e-2, 6e-3, 4e-3),
    "superellipsoid": Superellipsoid(8e-3, 6e-3, 5e-3, 0.6, 0.8),
}
LONGER = 1e-7
"""By how much the axes of a frame are too long, as within a step of a body that turns by a thousandth."""
POSES = 20 if PLAIN else 100


@pytest.mark.fast_cases(10)
@pytest.mark.parametrize(("one", "two"), list(itertools.combinations_with_replacement(SHAPES, 2)))
def test_a_contact_stays_valid_in_a_frame_with_longer_axes(one: str, two: str) -> None:
    """Its gap changes by no more than the points of both bodies move, so that no step meets another force."""
    first, second = SHAPES[one], SHAPES[two]
    size, rng, checked = first.extent + second.extent, np.random.default_rng(1), 0
    calls = [pair_caller(c.evaluator, c.values, name_of(c.evaluator)) for c in pairs_of(first, second)]
    for _ in range(POSES):
        axes = Rotation.random(2, random_state=int(rng.integers(2**31))).as_matrix()
        place = rng.normal(size=3)
        place *= rng.uniform(0.3, 1.1) * size / np.linalg.norm(place)
        blocks = []
        for longer in ((0.0, 0.0), (LONGER, 0.0), (0.0, LONGER)):
            a, b, rows = np.zeros(FRAME), np.zeros(FRAME), np.zeros((len(calls), GEOMETRY))
            a[3:12], b[3:12], b[:3] = (1.0 + longer[0]) * axes[0].ravel(), (1.0 + longer[1]) * axes[1].ravel(), place
            for call, row in zip(calls, rows, strict=True):
                call(a, b, row)
            blocks.append(rows)
        # a contact next to its end may end (0 is that of one without end), and deeper than springs are another one may
        # be valid; contacts far away are not followed
        gap, past = blocks[0][:, 0], blocks[0][:, PAST_END]
        is_valid = ((past < -1e-5 * size) | (past == 0.0)) & (-0.02 * size < gap) & (gap < 0.3 * size)
        checked += int(np.count_nonzero(is_valid))
        for rows in blocks[1:]:
            assert np.all(rows[is_valid, PAST_END] <= 0.0)
            np.testing.assert_allclose(rows[is_valid, 0], gap[is_valid], rtol=0.0, atol=3.0 * LONGER * size)
    assert checked > 0
