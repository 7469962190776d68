"""The two-link arm: published critical friction, both sides of it in the run, and the closed form of its impact."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.modes import mode_shares
from scenarios.two_link_arm import TwoLinkArm
from scenarios.two_link_arm.painleve import (
    critical_friction,
    least_critical_friction,
    mobility,
    reduced_coefficient,
    second_angle,
)

RATIO = 5.0 / 3.0
SIZES = (RATIO, 1.0, 1.0)


def _run(scenario: TwoLinkArm, t_end: float | None = None) -> ns.Solution:
    return ns.simulate(scenario.build(), t_end or scenario.t_end)


def test_published_numbers() -> None:
    """Least critical friction 0.4807 at (0.716, 0.421), A = -0.0167 at (0.7, 0.4468) with mu = 0.5: to their digits."""
    least, angle = least_critical_friction(*SIZES)
    assert least == pytest.approx(0.4807, abs=1e-4)
    assert angle == pytest.approx(0.716, abs=5e-4)
    assert second_angle(angle, RATIO) == pytest.approx(0.421, abs=5e-4)
    scenario = TwoLinkArm()
    assert scenario.second_angle == pytest.approx(0.4468, abs=5e-5)
    assert scenario.reduced_coefficient == pytest.approx(-0.0167, abs=5e-5)


def test_least_critical_friction_is_the_least() -> None:
    """No posture on a fine grid has less, and at it the reduced coefficient changes its sign."""
    least, angle = least_critical_friction(*SIZES)
    postures = np.linspace(0.01, math.acos(RATIO - 1.0) - 0.001, 5000)
    assert min(critical_friction(x, *SIZES) for x in postures) >= least - 1e-12
    assert reduced_coefficient(angle, least - 1e-9, *SIZES) > 0.0 > reduced_coefficient(angle, least + 1e-9, *SIZES)


@pytest.mark.parametrize(("factor", "expected"), [(0.9999, 0), (1.0001, 1)])
def test_both_sides_of_the_critical_friction(factor: float, expected: int) -> None:
    """Below it the tip slides on; above it, by a ten-thousandth, an impact without collision stops it at once."""
    angle = 0.7
    friction = critical_friction(angle, *SIZES) * factor
    solution = _run(TwoLinkArm(angle=angle, friction=friction, spring=0.0, damping=0.0), 1e-4)
    assert solution.events.count(Cause.PAINLEVE) == expected
    assert mode_shares(solution).get("{1,0,1}", 0.0) == (0.0 if expected else 1.0)


def test_sliding_the_other_way_is_no_paradox() -> None:
    """With the belt running the other way friction lifts the tip, and it slides on."""
    solution = _run(TwoLinkArm(belt_speed=-1.0), 0.2)
    assert solution.events.count(Cause.PAINLEVE) == 0
    assert mode_shares(solution) == {"{1,0,1}": pytest.approx(1.0)}


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
def test_impact_without_collision_in_closed_form(restitution: float) -> None:
    """One contact in the impulse P of its normal force: slip ends at P_1, compression at P_2, and e^2 comes back."""
    scenario = TwoLinkArm(restitution=restitution, belt_speed=0.4)
    g = mobility(scenario.angle, *SIZES)
    mu, slip = scenario.friction, scenario.belt_speed
    reduced = scenario.reduced_coefficient
    p_1 = slip / (mu * g[1, 1] - g[0, 1])
    pressed = reduced * p_1
    held = g[0, 0] - g[0, 1] ** 2 / g[1, 1]
    stored = -0.5 * reduced * p_1**2 + pressed**2 / (2.0 * held)
    rate = math.sqrt(2.0 * held * restitution**2 * stored)
    solution = _run(scenario, 1e-5)
    event = int(np.flatnonzero(solution.events.cause == Cause.PAINLEVE)[0])
    assert solution.events.time[event] == 0.0
    u = solution.events.u_after[event]
    angles = np.array([scenario.angle, scenario.second_angle])
    normal, slip_after = float(np.sin(angles) @ u), float(np.cos(angles) @ u) + slip
    assert normal == pytest.approx(rate, abs=1e-6 * slip)
    assert slip_after == pytest.approx(0.0, abs=1e-7)
    impulse = p_1 + (rate - pressed) / held
    assert solution.events.impulse[event, 0, 0] == pytest.approx(impulse, rel=1e-6)


@pytest.mark.parametrize(("spring", "damping"), [(100.0, 0.1), (100.0, 2.0), (150.0, 0.1), (150.0, 2.0)])
def test_motions(spring: float, damping: float) -> None:
    """The tip leaves the belt by an impact without collision and comes back; every joule is accounted for."""
    scenario = TwoLinkArm(spring=spring, damping=damping, t_end=1.0)
    solution = _run(scenario)
    summary = scenario.summarise(solution)
    assert solution.status == "done"
    assert solution.events.cause[0] == Cause.PAINLEVE
    assert summary["impacts"] >= 1
    assert 0.01 < summary["largest_gap"] < 0.1
    assert np.min(scenario.gap(solution)) > -1e-9
    assert solution.energy.residual < 1e-8
    # the last coordinate is the work of the damper, which only takes
    assert np.all(np.diff(solution.q[:, 2]) <= 1e-12)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"angle": 1.5}, ("TwoLinkArm.angle", "reach the belt 1.66667 m", "1.5")),
        ({"height": 3.0}, ("TwoLinkArm.angle", "reach the belt 3 m", "cosine 2.23")),
        ({"damping": -1.0}, ("TwoLinkArm.damping", ">= 0", "-1.0")),
        ({"spring": math.nan}, ("TwoLinkArm.spring", "finite", "nan")),
    ],
)
def test_wrong_input(wrong: dict[str, float], words: tuple[str, ...]) -> None:
    """The message names the parameter, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        TwoLinkArm(**wrong)
    for word in words:
        assert word in str(caught.value)
