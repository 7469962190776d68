"""The paper's coordinates, there and back, and against Eqs. (2) and (8)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenarios.dumbbell import coordinates

DISTANCE = 0.0276
_turn = st.floats(-math.pi, math.pi)
_tilt = st.floats(-1.4, 1.4)
_place = st.floats(-1.0, 1.0)
_rate = st.floats(-50.0, 50.0)
_places = st.tuples(_place, _place, _place, _turn, _tilt, _turn)
_rates = st.tuples(_place, _place, _place, _rate, _rate, _rate)


def _back(state: dict[str, Any]) -> tuple[Any, Any]:
    q = np.concatenate([state["position"], state["orientation"]])[None]
    u = np.concatenate([state["velocity"], state["angular_velocity"]])[None]
    found_q, found_u = coordinates.from_state(np.zeros(1), q, u, DISTANCE)
    return found_q[0], found_u[0]


@pytest.mark.slow
@given(_places, _rates)
def test_round_trip(q: tuple[float, ...], u: tuple[float, ...]) -> None:
    found_q, found_u = _back(coordinates.to_state(np.array(q), np.array(u), DISTANCE))
    difference = found_q - np.array(q)
    difference[[3, 5]] = np.remainder(difference[[3, 5]] + math.pi, 2.0 * math.pi) - math.pi
    np.testing.assert_allclose(difference, 0.0, atol=1e-12)
    np.testing.assert_allclose(found_u, u, atol=1e-11)


@given(_places)
def test_orientation_is_that_of_eq_2(q: tuple[float, ...]) -> None:
    state = coordinates.to_state(np.array(q), np.zeros(6), DISTANCE)
    s_t, s_b, s_g = np.sin(q[3:])
    c_t, c_b, c_g = np.cos(q[3:])
    expected = np.array(
        [
            [-s_t * c_b, -c_t * c_g + s_t * s_b * s_g, c_t * s_g + s_t * s_b * c_g],
            [c_t * c_b, -s_t * c_g - c_t * s_b * s_g, s_t * s_g - c_t * s_b * c_g],
            [s_b, c_b * s_g, c_b * c_g],
        ]
    )
    a, v = state["orientation"][0], state["orientation"][1:]
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    found = np.eye(3) + 2.0 * a * cross + 2.0 * cross @ cross
    np.testing.assert_allclose(found, expected, atol=1e-14)
    np.testing.assert_allclose(state["position"], np.array(q[:3]) + DISTANCE / 2.0 * expected[:, 0], atol=1e-15)


@given(_places, _rates)
def test_rates_are_derivatives(q: tuple[float, ...], u: tuple[float, ...]) -> None:
    step = 1e-6
    before, after = (
        coordinates.to_state(np.array(q) + sign * step * np.array(u), np.array(u), DISTANCE) for sign in (-1.0, 1.0)
    )
    now = coordinates.to_state(np.array(q), np.array(u), DISTANCE)
    velocity = (after["position"] - before["position"]) / (2.0 * step)
    np.testing.assert_allclose(now["velocity"], velocity, atol=1e-6)


def test_angles_stay_continuous_over_turns_between_samples() -> None:
    t = np.linspace(0.0, 1.0, 11)
    q = np.zeros((11, 6))
    u = np.zeros((11, 6))
    u[:, 5] = 200.0
    q[:, 5] = 200.0 * t
    states = [coordinates.to_state(a, b, DISTANCE) for a, b in zip(q, u, strict=True)]
    found, _ = coordinates.from_state(
        t,
        np.array([np.concatenate([s["position"], s["orientation"]]) for s in states]),
        np.array([np.concatenate([s["velocity"], s["angular_velocity"]]) for s in states]),
        DISTANCE,
    )
    np.testing.assert_allclose(found[:, 5], q[:, 5], atol=1e-10)
