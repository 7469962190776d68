"""Painleve's paradox with a tilted sliding dumbbell: an impact without collision, and the run goes on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Dumbbell
from nonsmooth.engine.modes import PAINLEVE

BODY = Dumbbell(rod_mass_fraction=0.9)
TILT = math.radians(45.0)


def _critical(tilt: float) -> float:
    """Friction at which g_nn - mu g_nt vanishes for ball 1 sliding ahead of the mass centre."""
    half, across = BODY.centre_distance / 2.0, BODY.inertia[1] / BODY.total_mass
    x, z = half * math.cos(tilt), half * math.sin(tilt) + BODY.radius
    return (across + x * x) / (x * z)


def _run(build: Any, friction: float, slip: float, t_end: float = 5e-3, rate: float = 0.0) -> ns.Solution:
    body = Dumbbell(rod_mass_fraction=0.9)
    system = build.over(body, friction=friction, restitution=0.3)
    # rod along y: (x1, y1, z1, theta, beta, gamma); ball 1 slides towards -y
    start = build.paper_start(body, (0, 0, body.radius, 0.0, TILT, 0.0), (0, slip, 0, 0, rate, 0))
    system.place(body, **start)
    return ns.simulate(system, t_end, options=ns.Options(tolerance=1e-10))


@pytest.mark.parametrize("side", [-1e-3, 1e-3])
def test_both_sides_of_the_critical_friction(build: Any, side: float) -> None:
    """Below it the contact slides on, above it no force exists: an impact without collision at once.

    Below it the tilt grows until the coefficient vanishes, 74 us after the start: the run ends before.
    """
    solution = _run(build, _critical(TILT) * (1.0 + side), -1.0, t_end=5e-3 if side > 0.0 else 5e-5)
    assert solution.status == "done"
    first = solution.events.cause[0]
    assert (first == PAINLEVE) == (side > 0.0)
    if side > 0.0:
        event = int(np.flatnonzero(solution.events.cause == PAINLEVE)[0])
        assert solution.events.causes()[event] == "impact without collision"
        assert solution.events.contact[event] == 0
        assert solution.events.impulse[event, 0, 0] > 0.0
        # it stops the slip, loses energy, and leaves the contact at least not approaching
        assert solution.events.friction_loss[event] > 0.0
    else:
        assert solution.events.words("after")[0] == "{01,00,01}"
    energy = solution.energy
    assert energy.kinetic_end + energy.potential_end < energy.kinetic_start + energy.potential_start
    assert energy.residual <= 1e-8


def test_sliding_into_the_singularity_is_refused(build: Any) -> None:
    """Where the normal force grows without bound the run stops, says why and keeps what it computed."""
    with pytest.raises(ns.RunFailed, match="Painleve singularity") as caught:
        _run(build, _critical(TILT) * 0.999, -1.0)
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert 5e-5 < solution.t_end < 1e-4
    assert solution.status == "failed"


def test_the_other_way_there_is_no_paradox(build: Any) -> None:
    """Ball 1 trailing: friction lifts the normal load, whatever mu."""
    solution = _run(build, 1.5 * _critical(TILT), 1.0)
    assert solution.events.count(PAINLEVE) == 0
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8


def test_falling_into_the_paradox(build: Any) -> None:
    """Started below the critical tilt and turning up into it: the run passes the singularity and ends."""
    friction = _critical(TILT) * 1.02
    solution = _run(build, friction, -3.0, 0.05, rate=-20.0)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8
    after = _run(build, friction, -3.0, 0.05, rate=20.0)
    assert after.status == "done"
    assert after.energy.residual <= 1e-8


def test_dissipation_over_many_starts(build: Any) -> None:
    """Whatever happens, no energy comes out of an impact without collision."""
    for factor in (1.01, 1.2, 1.5):
        for slip in (-0.05, -0.5, -4.0):
            solution = _run(build, _critical(TILT) * factor, slip)
            events = solution.events
            hit = events.cause == PAINLEVE
            assert np.any(hit)
            assert np.all(events.restitution_loss[hit] >= -1e-12)
            assert np.all(events.friction_loss[hit] >= -1e-12)
            assert solution.energy.residual <= 1e-8
