"""Next to the bound of sticking: a lone impact against its closed form, and blocks on slopes just steep enough."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Plate, Rest, RigidBody, Sphere
from laws import Coulomb, EnergeticImpact, Unilateral
from tests.physics.moved_systems import quaternion

Array = NDArray[np.float64]
PARTS = (0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3)
"""What friction is more or less than the bound, as a part of it."""


def _planar(delassus: Array, mu: float, e: float, slip: float) -> tuple[float, float]:
    """Return the rates after an impact with normal rate -1 in a plane, whose phases are linear in the impulse.

    The bound is |G_tn| / G_tt: what comes to rest sticks above it, and slips on along G_tn below.
    """
    (nn, nt), (_, tt) = delassus
    rate, stored, left, expands = -1.0, 0.0, math.inf, False
    while True:
        sense = math.copysign(1.0, slip) if slip != 0.0 else math.copysign(float(abs(nt) > mu * tt), nt)
        sticks = slip == 0.0 and sense == 0.0
        growth = nn - nt * nt / tt if sticks else nn - mu * sense * nt
        turning = 0.0 if sticks else nt - mu * sense * tt
        stop = -slip / turning if slip * turning < 0.0 else math.inf
        end = (math.sqrt(rate * rate + 2.0 * growth * left) - rate) / growth if expands else -rate / growth
        step = min(stop, end)
        work = rate * step + 0.5 * growth * step * step
        rate, slip = rate + growth * step, 0.0 if step == stop else slip + turning * step
        if expands:
            left -= work
        else:
            stored -= work
        if step == end and expands:
            return rate, slip
        if step == end:
            rate, expands, left = 0.0, True, e * e * stored


@settings(max_examples=60)
@given(
    inertia=st.tuples(st.floats(0.2, 5.0), st.floats(0.2, 5.0), st.floats(0.2, 5.0)),
    lean=st.floats(-0.95, 0.95),
    e=st.just(0.0) | st.floats(0.01, 1.0),
    slip=st.just(0.0) | st.floats(-1.0, 1.0),
)
def test_a_lone_impact_is_continuous_across_the_bound(
    inertia: tuple[float, float, float], lean: float, e: float, slip: float
) -> None:
    """From 0.1 % below to 0.1 % above: the closed form on both sides, to slips that count as none."""
    nn, tt, across = inertia
    nt = lean * math.sqrt(nn * tt)
    bound = abs(nt) / tt
    assume(0.02 < bound < 1.9 and (slip == 0.0 or abs(slip) > 1e-6))
    delassus = np.array([[nn, nt, 0.0], [nt, tt, 0.0], [0.0, 0.0, across]])
    columns = np.linalg.cholesky(delassus).T
    before = np.linalg.solve(columns.T, [-1.0, slip, 0.0])
    # what friction does in all of it; from rest an excess of 1e-7 of that is not told from none
    reach = 2.0 * abs(nt) / (nn * (1.0 - lean * lean))
    limit = np.array([*_planar(delassus[:2, :2], bound, e, slip), 0.0])
    for part in PARTS:
        for mu in (bound * (1.0 - part), bound * (1.0 + part)):
            result = ns.solve_impact(
                np.eye(3), columns[:, :1], columns[:, 1:].reshape(3, 1, 2), before, [EnergeticImpact(e)], [Coulomb(mu)]
            )
            rates = columns.T @ result.velocity
            exact = np.array([*_planar(delassus[:2, :2], mu, e, slip), 0.0])
            np.testing.assert_allclose(rates, exact, rtol=0, atol=1e-7 * reach + 1e-8)
            np.testing.assert_allclose(rates, limit, rtol=0, atol=(10.0 * part + 1e-7) * (1.0 + reach))
            assert result.steps < 100


HEIGHT, FOOT, GRAVITY = 0.01, 0.004, 9.81


@settings(max_examples=25, deadline=None)
@given(
    turns=st.lists(st.floats(-0.12, 0.12), min_size=3, max_size=7),
    mu=st.floats(0.05, 0.8),
    heading=st.floats(0.0, 2.0 * math.pi),
    excess=st.floats(-7.0, -3.0),
)
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_slope_next_to_the_angle_of_friction(
    side: float, turns: list[float], mu: float, heading: float, excess: float
) -> None:
    """Blocks on several feet about a circle, their loads all beneath: g (sin - mu cos) to 1e-6, or rest."""
    n, seconds, slope = len(turns), 0.1, math.atan(mu) + side * 10.0**excess
    angles = 2.0 * math.pi / n * (np.arange(n) + np.array(turns))
    feet = tuple(Sphere(FOOT, 0.06 * math.cos(a), 0.06 * math.sin(a), FOOT - HEIGHT) for a in angles)
    block, plate = RigidBody(1.0, (2e-3, 3e-3, 4e-3), feet), Plate(Rest(slope=slope))
    system = ns.System([plate, block], GRAVITY)
    system.contact(plate, block, normal=Unilateral(), friction=Coulomb(mu), impact=EnergeticImpact(0.5))
    yaw, pitch = quaternion((0.0, 0.0, 1.0), heading), quaternion((0.0, 1.0, 0.0), slope)
    (a, *p), (b, *q) = pitch, yaw
    turn = [a * b - float(np.dot(p, q)), *(a * np.array(q) + b * np.array(p) + np.cross(p, q))]
    system.place(block, position=(HEIGHT * math.sin(slope), 0.0, HEIGHT * math.cos(slope)), orientation=turn)
    solution = ns.simulate(system, seconds, sample_interval=seconds, engine=ns.EventDriven(tolerance=1e-12))
    speed = seconds * max(0.0, GRAVITY * (math.sin(slope) - mu * math.cos(slope)))
    along = speed * np.array([math.cos(slope), 0.0, -math.sin(slope)])
    np.testing.assert_allclose(solution.u_end[:3], along, rtol=0, atol=1e-6 * speed + 1e-12)
    assert solution.counters.steps < 100
