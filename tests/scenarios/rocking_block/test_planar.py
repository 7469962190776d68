"""The planar block: fall and double impact by scipy, Housner's velocity ratio, amplitudes and quarter period."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from scenarios.rocking_block import RockingBlock, housner

FINE = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)
GRAVITY = 9.81


def _fall(block: RockingBlock) -> tuple[float, float, float]:
    """Return time, velocity and tilt rate at which a frictionless block lies flat, by scipy.

    The mass centre falls along a vertical: z(tilt) is its only motion besides the turn.
    """
    x, z = 0.5 * block.base, 0.5 * block.height
    moment = (block.base**2 + block.height**2) / 12.0

    def slope(t: float, y: Any) -> list[float]:
        s, c = math.sin(y[0]), math.cos(y[0])
        first, second = x * c - z * s, -x * s - z * c
        return [y[1], -first * (GRAVITY + second * y[1] ** 2) / (moment + first**2)]

    def flat(t: float, y: Any) -> float:
        return float(y[0])

    flat.terminal = True  # type: ignore[attr-defined]
    done = solve_ivp(slope, (0.0, 5.0), [block.tilt, 0.0], "DOP853", events=flat, rtol=1e-13, atol=1e-14)
    rate = float(done.y[1, -1])
    return float(done.t[-1]), x * rate, rate


def _bounce(block: RockingBlock, velocity: float, rate: float) -> tuple[float, float]:
    """Return velocity and tilt rate after the impact of both lower corners on lossy linear springs, by scipy."""
    x, moment = 0.5 * block.base, (block.base**2 + block.height**2) / 12.0
    arms, squared = np.array([-x, x]), block.restitution**2

    def slope(t: float, y: Any) -> Any:
        gap_rate = y[0] + arms * y[1]
        force = np.maximum(y[2:], 0.0)
        squeeze = np.where(gap_rate <= 0.0, -gap_rate, np.where(y[2:] > 0.0, -gap_rate / squared, 0.0))
        return [force.sum(), arms @ force / moment, *squeeze]

    def guard(i: int) -> Any:
        def value(t: float, y: Any) -> float:
            return float(y[2 + i] if i < 2 else y[0] + arms[i - 2] * y[1])

        value.terminal, value.direction = True, -1.0 if i < 2 else 0.0  # type: ignore[attr-defined]
        return value

    t, y = 0.0, np.array([velocity, rate, 0.0, 0.0])
    while t < 100.0:
        # a short first step leaves the zero of the guard that has just fired
        done = solve_ivp(slope, (t, t + 1e-7), y, "DOP853", rtol=1e-13, atol=1e-15)
        t, y = float(done.t[-1]), done.y[:, -1]
        pressed = [i for i in range(2) if y[2 + i] > 0.0]
        guards = [guard(i) for i in (*pressed, 2, 3)]
        done = solve_ivp(slope, (t, t + 100.0), y, "DOP853", events=guards, rtol=1e-13, atol=1e-15)
        t, y = float(done.t[-1]), done.y[:, -1]
        y[2:] = np.where(y[2:] < 1e-13, 0.0, y[2:])
        if not np.any(y[2:]) and np.all(y[0] + arms * y[1] >= 0.0):
            return float(y[0]), float(y[1])
    raise AssertionError("the impact does not end")


def test_first_double_impact() -> None:
    """At t = 0.58747797, as published, with the first corner still closed; time, rates and rebound as by scipy."""
    block = RockingBlock(t_end=0.6)
    solution = ns.simulate(block.build(), block.t_end, engine=FINE)
    first = block.summarise(solution)["first_impact"]
    assert first["time"][0] == pytest.approx(0.58747797, abs=5e-9)
    assert first["mode"] == ["{0011,0010,0011}"]
    time, velocity, rate = _fall(block)
    assert first["time"][0] == pytest.approx(time, abs=1e-10)
    assert first["velocity_before"][0] == pytest.approx(velocity, abs=1e-9)
    assert first["tilt_rate_before"][0] == pytest.approx(rate, abs=1e-9)
    after = first["velocity_after"][0], first["tilt_rate_after"][0]
    np.testing.assert_allclose(after, _bounce(block, velocity, rate), rtol=0, atol=1e-8)
    assert np.max(np.abs(solution.q[:, 0])) <= 1e-12


def _no_slip(alpha: float, share: float = 1.05, **more: float) -> RockingBlock:
    friction = share * housner.least_friction(alpha)
    start = {"tilt": 0.1 * alpha, "restitution": 0.0, "friction": friction, "t_end": 0.5, **more}
    return RockingBlock(base=math.tan(alpha), height=1.0, **start)


def _first_impact(block: RockingBlock) -> tuple[float, float]:
    """Return the ratio of the tilt rates and the share of the normal impulse that the corner at rest takes."""
    solution = ns.simulate(block.build(), block.t_end, engine=FINE)
    first = np.flatnonzero(solution.events.cause == Cause.IMPACT)[0]
    impulse = solution.events.impulse[first, :, 0]
    ratio = solution.events.u_after[first, 2] / solution.events.u_before[first, 2]
    return float(ratio), float(impulse[0] / impulse.sum())


def _ratio(block: RockingBlock) -> float:
    return _first_impact(block)[0]


@pytest.mark.parametrize("alpha", [0.02, 0.2, 0.5, 0.9])
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_velocity_ratio(alpha: float, exponent: float) -> None:
    """Housner's ratio is met without slip and bounce at every slenderness: the other corner takes no impulse."""
    ratio, share = _first_impact(_no_slip(alpha, exponent=exponent))
    assert ratio == pytest.approx(1.0 - 1.5 * math.sin(alpha) ** 2, abs=1e-9)
    assert share == 0.0


def test_a_squat_block_stops() -> None:
    """Beyond sin^2(alpha) = 2/3 the ratio would be negative: the other corner holds the block, which stops."""
    limit = math.asin(math.sqrt(2.0 / 3.0))
    assert _ratio(_no_slip(limit - 0.01)) == pytest.approx(housner.velocity_ratio(limit - 0.01), abs=1e-9)
    assert housner.velocity_ratio(limit - 0.01) > 0.01
    ratio, share = _first_impact(_no_slip(limit + 0.01))
    assert abs(ratio) <= 1e-12
    assert share > 0.0


@pytest.mark.parametrize("alpha", [0.2, 0.5])
def test_least_friction(alpha: float) -> None:
    """Just below the least friction the ratio is missed, and without friction it is that of a smooth block."""
    expected = housner.velocity_ratio(alpha)
    assert _ratio(_no_slip(alpha, 1.001)) == pytest.approx(expected, abs=1e-9)
    assert _ratio(_no_slip(alpha, 0.99)) < expected - 1e-3
    assert _ratio(_no_slip(alpha, 0.0)) == pytest.approx(housner.frictionless_ratio(alpha), abs=1e-9)


def test_amplitudes() -> None:
    """Every landing multiplies the tilt rate by the ratio, and no slip happens; the tilts follow."""
    block = RockingBlock(base=0.25, height=1.0, tilt=0.15, restitution=0.0, friction=0.5, t_end=4.0)
    solution = ns.simulate(block.build(), block.t_end, engine=FINE)
    events, alpha = solution.events, housner.slenderness(0.25, 1.0)
    assert solution.energy.friction_loss <= 1e-12
    impacts = events.cause == Cause.IMPACT
    before = np.abs(events.u_before[impacts, 2])
    assert len(before) >= 8
    np.testing.assert_allclose(before[1:] / before[:-1], housner.velocity_ratio(alpha), rtol=0, atol=1e-8)
    tilt, landings = -solution.q[:, 2], np.append(0.0, events.time[impacts])
    for peak, start, end in zip(housner.amplitudes(alpha, 0.15, 8), landings[:8], landings[1:9], strict=True):
        part = np.abs(tilt[(solution.t >= start) & (solution.t <= end)])
        assert part.max() == pytest.approx(peak, abs=1e-5)


def test_quarter_period_of_slender_blocks() -> None:
    """The time to the first impact tends to Housner's as the square of the slenderness."""
    errors = []
    for alpha in (0.2, 0.1, 0.05):
        block = _no_slip(alpha, 1.5, tilt=0.5 * alpha, t_end=1.0)
        solution = ns.simulate(block.build(), block.t_end, engine=FINE)
        time = block.summarise(solution)["first_impact"]["time"][0]
        exact = housner.quarter_period(alpha, block.tilt, math.hypot(block.base, block.height))
        errors.append(abs(time / exact - 1.0))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.05)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize(("restitution", "friction"), [(0.8, 0.0), (0.5, 0.3), (0.0, 0.8), (1.0, 0.0)])
def test_energy(restitution: float, friction: float) -> None:
    """The account closes over many impacts, no corner sinks in, and nothing is lost where nothing can be."""
    block = RockingBlock(restitution=restitution, friction=friction, t_end=1.5)
    solution = ns.simulate(block.build(), block.t_end, sample_interval=block.sample_interval, engine=FINE)
    assert solution.energy.residual <= 1e-10
    assert (solution.energy.restitution_loss > 1e-3) == (restitution < 1.0)
    assert np.min(block.corner_heights(solution)) >= -1e-9
    if restitution == 1.0:
        assert solution.energy.change == pytest.approx(0.0, abs=1e-7)


def test_wrong_input() -> None:
    """A block that stands, lies beyond its side or is nothing is refused."""
    for wrong in ({"tilt": 0.0}, {"tilt": 2.0}, {"base": 0.0}, {"restitution": 1.1}, {"friction": -0.1}):
        with pytest.raises(ns.InvalidInput, match=rf"RockingBlock\.{next(iter(wrong))}"):
            RockingBlock(**wrong)


@pytest.mark.slow
def test_coordinates_and_end_agree() -> None:
    block = RockingBlock(t_end=0.7)
    solution = ns.simulate(block.build(), block.t_end, sample_interval=block.sample_interval)
    coordinates = block.coordinates(solution)
    assert coordinates["tilt"][0] == block.tilt
    assert [coordinates[name][-1] for name in ("x", "z", "tilt")] == pytest.approx(block.final(solution)["q"])
