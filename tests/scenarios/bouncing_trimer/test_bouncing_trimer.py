"""The trimer against closed forms, a ball that does the same, conservation, and its own symmetry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from scenarios.bouncing_ball import BouncingBall
from scenarios.bouncing_trimer import BouncingTrimer
from scenarios.bouncing_trimer.figures import survey
from scenarios.bouncing_trimer.motion import GRAVITY, TrimerMotion, repetition, summary


def _run(**start: Any) -> tuple[BouncingTrimer, ns.Solution]:
    scenario = BouncingTrimer(**start)
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-7
    return scenario, solution


def test_mass_and_inertia() -> None:
    """Three balls at d / sqrt(3) from the mass centre."""
    scenario = BouncingTrimer()
    body = scenario.body()
    r, d = scenario.radius, scenario.spacing
    m = scenario.density * 4.0 / 3.0 * math.pi * r**3
    assert body.total_mass == pytest.approx(3.0 * m, rel=1e-14)
    across, along = 1.2 * m * r * r + m * d * d / 2.0, 1.2 * m * r * r + m * d * d
    np.testing.assert_allclose(body.inertia, (across, across, along), rtol=1e-13)
    np.testing.assert_allclose(body.products, 0.0, atol=1e-15 * along)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("gamma", [0.0, 0.7, 1.1])
def test_level_trimer_is_a_ball(gamma: float) -> None:
    """Dropped level, three equal impacts at once do what one ball does: the same impact times to 1e-9 s."""
    start: dict[str, Any] = {"gamma": gamma, "frequency": 50.0, "restitution": 0.8, "height": 4e-3, "t_end": 0.25}
    exact = ns.EventDriven(impact_tolerance=1e-12)
    solution = ns.simulate(BouncingTrimer(tilt=0.0, **start).build(), 0.25, engine=exact)
    ball = BouncingBall(**start)
    reference = ns.simulate(ball.build(), ball.t_end, engine=exact)
    found = solution.events.time[solution.events.cause == Cause.IMPACT][:6]
    assert len(found) == 6
    np.testing.assert_allclose(found, ball.impact_times(reference)[:6], rtol=0, atol=1e-9)
    # what round-off leaves of the level grows in the next impacts
    assert np.max(np.abs(solution.u[solution.t < found[-1]][:, [0, 1, 3, 4, 5]])) < 1e-9


def test_first_impact_in_closed_form() -> None:
    """One ball meets the plate: without friction P = (1 + e) |g'| / G along the vertical at that ball."""
    scenario, solution = _run(friction=0.0, tilt=0.1, restitution=0.7, t_end=0.02)
    events = solution.events
    first = int(np.flatnonzero(events.cause == Cause.IMPACT)[0])
    contact = int(events.contact[first])
    turn = Rotation.from_quat(events.q[first, [4, 5, 6, 3]])
    arm = turn.apply(scenario.corners[contact]) - np.array([0.0, 0.0, scenario.radius])
    body = scenario.body()
    # gap rate = v_z + (omega x arm)_z, omega in body axes
    w = np.concatenate([[0.0, 0.0, 1.0], turn.inv().apply(np.cross(arm, [0.0, 0.0, 1.0]))])
    inverse = 1.0 / np.array([body.total_mass] * 3 + list(body.inertia))
    omega = 2.0 * math.pi * scenario.frequency
    driven = scenario.amplitude * omega * math.cos(omega * events.time[first])
    rate = w @ events.u_before[first] - driven
    impulse = 1.7 * -rate / (w @ (inverse * w))
    assert rate < -0.1
    np.testing.assert_allclose(events.u_after[first], events.u_before[first] + inverse * w * impulse, atol=1e-7)
    assert events.impulse[first, contact, 0] == pytest.approx(impulse, rel=1e-8)


def test_conservation_without_friction() -> None:
    """Vertical forces only: the mass centre stays over its place, and no moment acts about the vertical."""
    scenario, solution = _run(friction=0.0, gamma=3.0, tilt=0.2, t_end=2.0)
    assert solution.counters.impacts > 100
    assert np.max(np.abs(solution.q[:, :2])) < 1e-12
    moments = np.array(scenario.body().inertia)
    turns = Rotation.from_quat(solution.q[:, [4, 5, 6, 3]])
    momentum = turns.apply(moments * solution.u[:, 3:])
    scale = float(np.max(np.abs(momentum)))
    assert np.max(np.abs(momentum[:, 2])) < 1e-8 * scale


@pytest.mark.parametrize("gamma", [0.99, 1.01])
def test_it_leaves_the_plate_above_one_g(gamma: float) -> None:
    """Below it stays, above it takes off level where the plate falls away at g."""
    _, solution = _run(gamma=gamma, height=0.0, tilt=0.0, restitution=0.0, t_end=0.06)
    after = solution.events.cause == Cause.LIFT_OFF
    assert np.any(after) == (gamma > 1.0)
    if gamma > 1.0:
        last = solution.events.time[after]
        phase = np.mod(last * 50.0, 1.0) * 2.0 * math.pi
        np.testing.assert_allclose(np.sin(phase), 1.0 / gamma, atol=1e-6)


@pytest.mark.parametrize("mapping", ["third of a turn", "mirror"])
def test_symmetry(mapping: str) -> None:
    """A start turned by a third of a turn, or mirrored, gives the path turned or mirrored, until chaos tells."""
    _, plain = _run(gamma=3.0, tilt=0.1, t_end=0.25)
    if mapping == "mirror":
        _, other = _run(gamma=3.0, tilt=0.1, direction=math.pi - 0.3, t_end=0.25)
        expected = plain.q[:, :3] * [1.0, -1.0, 1.0]
    else:
        _, other = _run(gamma=3.0, tilt=0.1, direction=0.3 + 2.0 * math.pi / 3.0, t_end=0.25)
        expected = Rotation.from_euler("z", 2.0 * math.pi / 3.0).apply(plain.q[:, :3])
    assert plain.counters.impacts > 10
    assert np.max(np.abs(plain.q[:, :2])) > 1e-4
    np.testing.assert_allclose(other.q[:, :3], expected, rtol=0, atol=1e-7)


@pytest.mark.parametrize("gamma", [1.2, 1.5])
def test_the_closest_tolerances_ask_for_no_more_than_they_explain(gamma: float) -> None:
    """Its balls close one after the other, and turn it about those that are closed by a gap over a lever."""
    scenario = BouncingTrimer(gamma=gamma, t_end=2.0)
    exact = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12, time_tolerance=1e-14)
    solution = ns.simulate(scenario.build(), scenario.t_end, engine=exact)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-11


def test_survey() -> None:
    """At rest below one g; above, wandering and turning, at speeds that go with g/f at the same Gamma."""
    runs = survey(BouncingTrimer(), (3.0,), (50.0, 100.0), 400, ns.run_scenario)
    runs += survey(BouncingTrimer(restitution=0.2), (0.9,), (50.0,), 40, ns.run_scenario)
    assert [solution.status for _, solution in runs] == ["done"] * 3
    assert all(solution.energy.residual < 1e-7 for _, solution in runs)
    slow, fast, rest = (scenario.summarise(solution) for scenario, solution in runs)
    assert rest["attractor"] == "rest"
    assert rest["wandering"] < 1e-9
    for numbers, frequency in ((slow, 50.0), (fast, 100.0)):
        assert 0.07 < numbers["wandering"] / (GRAVITY / frequency) < 0.16
        assert numbers["drift"] < 0.5 * numbers["wandering"]
        assert abs(numbers["rotation"]) < numbers["turning"]


def _bounce(repeats: int, drift: float = 0.0) -> TrimerMotion:
    t = np.arange(4000) / (50.0 * 20.0)
    gap = 1e-3 * (1.0 + np.sin(2.0 * math.pi * t * 50.0 / repeats) ** 2 + drift * t)
    place = np.column_stack([0.01 * t, np.zeros(len(t))])
    return TrimerMotion(t, 0.02, np.column_stack([gap] * 3), place, np.full(len(t), -2.0), np.zeros(len(t)))


@pytest.mark.parametrize("repeats", [1, 3, 5])
def test_repetition(repeats: int) -> None:
    """The number of plate periods after which the gaps repeat; sin^2 repeats twice as often as sin."""
    # sin^2 of a wave over k periods repeats after k / 2, seen in whole periods after k
    assert repetition(_bounce(repeats)) == repeats
    assert repetition(_bounce(repeats, drift=5.0)) is None
    numbers = summary(_bounce(repeats))
    assert numbers["attractor"] == f"period_{repeats}"
    assert numbers["drift"] == pytest.approx(0.01, rel=1e-9)
    assert numbers["wandering"] == pytest.approx(0.01, rel=0.02)
    assert numbers["rotation"] == pytest.approx(-2.0)


def test_wrong_input() -> None:
    """Balls must not overlap."""
    with pytest.raises(ns.InvalidInput) as caught:
        BouncingTrimer(spacing=9e-3)
    for word in ("BouncingTrimer.spacing", "diameter 0.01", "0.009"):
        assert word in str(caught.value)
