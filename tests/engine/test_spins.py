"""Spins along axes in space: what is exact there stays so along the axes of a body, at samples and at any speed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Dumbbell, Plate
from laws import Coulomb, NewtonImpact, Unilateral
from nonsmooth.rotations import rotation

G, R, MU = 9.81, 0.01, 0.2


def _in_space(q: Any, w: Any) -> Any:
    """Return angular velocities along axes in space; between steps the quaternions have not quite unit length."""
    unit = q / np.linalg.norm(q, axis=1)[:, None]
    return np.array([rotation(attitude) @ spin for attitude, spin in zip(unit, w, strict=True)])


@pytest.mark.parametrize("about_normal", [0.0, 400.0])
def test_a_spin_in_space_is_exact_where_it_is_linear(about_normal: float) -> None:
    """A ball slides obliquely on the plane, its slip along one line: its spin is w + 5 mu g t (n x d) / 2 r."""
    plate, ball = Plate(), Ball(R)
    system = ns.System([plate, ball], G)
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(MU), impact=NewtonImpact(0.0))
    v, spin = np.array([0.7, -0.2, 0.0]), np.array([-90.0, 150.0, about_normal])
    ns.touching(system, ball, velocity=tuple(v), angular_velocity=tuple(spin))
    slip = v + np.cross(spin, [0.0, 0.0, -R])
    direction = slip / np.linalg.norm(slip)
    t_end = 0.9 * 2.0 * float(np.linalg.norm(slip)) / (7.0 * MU * G)
    solution = ns.simulate(system, t_end, sample_interval=t_end / 300.0)
    turned: Any = np.outer(solution.t, 2.5 * MU * G / R * np.cross([0.0, 0.0, 1.0], direction))
    found = _in_space(solution.q[:, 3:7], solution.u[:, 3:])
    size = float(np.linalg.norm(spin))
    np.testing.assert_allclose(found, spin + turned, rtol=0, atol=1e-11 * size)
    np.testing.assert_allclose(solution.u[:, :3], v - np.outer(solution.t, MU * G * direction), rtol=0, atol=1e-12)


def _dumbbell(spin: float, tolerance: float, t_end: float, height: float = 0.0) -> ns.Solution:
    """Return the run of a tilted dumbbell that slides over its lower ball and spins about its rod."""
    plate, body = Plate(), Dumbbell()
    system = ns.System([plate, body], G)
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(MU), impact=NewtonImpact(0.5))
    tilt, half = 0.3, 0.5 * body.centre_distance
    system.place(
        body,
        position=(half * math.cos(tilt), 0.0, height + body.radius + half * math.sin(tilt)),
        orientation=(math.cos(0.5 * tilt), 0.0, -math.sin(0.5 * tilt), 0.0),
        velocity=(0.2, 0.3, 0.0),
        angular_velocity=(spin, 0.0, 0.0),
    )
    return ns.simulate(system, t_end, engine=ns.EventDriven(tolerance=tolerance))


def test_order_of_a_spin() -> None:
    """Fifth order: the error falls with the fifth power of the work, and stays within the tolerance times a bound."""
    truth = _dumbbell(300.0, 1e-13, 0.01)
    assert truth.events.causes() == ["start"]
    tolerances = 10.0 ** -np.arange(5.0, 12.0, 1.0)
    runs = [_dumbbell(300.0, float(tolerance), 0.01) for tolerance in tolerances]
    errors = np.array([np.max(np.abs(run.u_end[3:] - truth.u_end[3:])) for run in runs])
    work = np.array([run.counters.steps + run.counters.rejected for run in runs], dtype=float)
    assert -np.polyfit(np.log(work), np.log(errors), 1)[0] >= 4.8
    assert np.all(errors <= 1e4 * tolerances)


def test_a_spin_about_the_rod_asks_for_no_looks_at_gaps() -> None:
    """It moves no surface along its normal: flights of the dumbbell are looked at as often as without it."""
    still, spinning = (_dumbbell(spin, 1e-9, 0.12, height=0.01) for spin in (0.0, 500.0))
    assert [len(run.events) > 3 for run in (still, spinning)] == [True, True]
    looks, flights = spinning.counters.gap_looks, len(spinning.events)
    assert looks <= 4 * flights
    assert spinning.counters.limits.get("turning in flight", 0) == 0
    assert still.counters.gap_looks <= 4 * len(still.events)
