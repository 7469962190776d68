"""Orientations out of an axis and an angle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball


def test_it_is_the_turn_by_the_right_hand_rule() -> None:
    axis, angle = np.array([2.0, -1.0, 2.0]) / 3.0, 0.7
    found = ns.turned_about(tuple(axis), angle)
    expected = np.roll(Rotation.from_rotvec(angle * axis).as_quat(), 1)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-15)
    q, _ = Ball(0.1).state(orientation=found)
    np.testing.assert_array_equal(q[3:], found)


@pytest.mark.parametrize(
    ("axis", "angle", "told"),
    [
        ((0.0, 0.0, 0.0), 0.1, "axis must have a direction"),
        ((1.0, 0.0), 0.1, "axis must be 3 finite numbers"),
        ((1.0, 0.0, 0.0), math.inf, "angle must be a finite number"),
        ((1.0, 0.0, 0.0), "0.1", "angle must be a finite number"),
    ],
)
def test_what_is_none_is_refused(axis: Any, angle: Any, told: str) -> None:
    with pytest.raises(ns.InvalidInput, match=f"turned_about: {told}"):
        ns.turned_about(axis, angle)
