"""States at any time: against closed forms, and against runs that have samples exactly there."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic, Plate
from laws import Bristle, Directional, EnergeticImpact, HuntCrossley, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.plugins import registry

GRAVITY = 9.81


@pytest.fixture(scope="module")
def bounces(build: Any) -> ns.Solution:
    """Return the run of a ball that bounces, with hardly a sample."""
    ball = Ball(0.01)
    system = build.over(ball, restitution=0.8, friction=0.0)
    system.place(ball, position=(0.0, 0.0, 0.11), velocity=(0.3, 0.0, 0.0))
    return ns.simulate(system, 0.9, sample_interval=0.5)


def test_a_ball_between_bounces_is_on_its_parabola(bounces: ns.Solution) -> None:
    """At times in no order, at the last number before an event, at it, and after it."""
    events = bounces.events
    assert len(events) > 4
    before, after = np.nextafter(events.time[1:], -1.0), np.nextafter(events.time, 9.0)
    drawn = np.random.default_rng(3).uniform(0.0, 0.9, 40)
    times = np.concatenate([drawn, before, events.time, after])
    states = bounces.at(times)
    last = np.searchsorted(events.time, times, side="right") - 1
    since = times - events.time[last]
    fall = events.u_after[last, 2] - GRAVITY * since
    np.testing.assert_array_equal(states.time, times)
    np.testing.assert_allclose(states["u"][:, 2], fall, rtol=0, atol=1e-12)
    height = events.q[last, 2] + 0.5 * since * (events.u_after[last, 2] + fall)
    np.testing.assert_allclose(states["q"][:, 2], height, rtol=0, atol=1e-12)
    # limits: before an event its velocity before, at it exactly that after
    n = len(drawn)
    np.testing.assert_allclose(states["u"][n : n + len(before)], events.u_before[1:], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(states["u"][n + len(before) : -len(after)], events.u_after)


def test_a_single_time_has_no_axis_of_times(bounces: ns.Solution) -> None:
    """It is the same state."""
    one, many = bounces.at(0.37), bounces.at([0.8, 0.37])
    np.testing.assert_array_equal(one["q"], many["q"][1])
    assert one.time == 0.37
    assert one["u"].shape == (6,)
    assert one["mode"].shape == (1,)
    assert bounces.history("position", times=0.37, of=bounces.system.bodies[1])["position"].shape == (1, 3)
    energy = "kinetic_energy"
    assert bounces.history(energy, times=0.37)[energy] == bounces.history(energy, times=[0.37])[energy][0]
    assert len(bounces.at().time) == len(bounces.t)
    np.testing.assert_array_equal(bounces.at(0.9)["u"], bounces.u_end)


@pytest.mark.parametrize("times", [-1e-9, [0.1, 0.9000001], math.nan, [[0.1]], "now"])
def test_times_that_are_none_of_the_run_are_refused(bounces: ns.Solution, times: Any) -> None:
    """By name, with what the run has."""
    for name in ("q", "normal_force", "gap", "joint_force", "kinetic_energy"):
        with pytest.raises(ns.InvalidInput, match=r"Solution\.history: times must be"):
            bounces.history(name, times=times)


def test_what_is_not_of_the_system_is_refused(bounces: ns.Solution, build: Any) -> None:
    """Bodies, contacts, and a system that has changed since it ran."""
    with pytest.raises(ns.InvalidInput, match="needs a body of this system"):
        bounces.history("position", of=Ball(0.01))
    with pytest.raises(ns.InvalidInput, match="must be below 1"):
        bounces.history("normal_force", of=1)
    one, other = Ball(0.01), Ball(0.02)
    system = ns.System([one, other])
    system.exclude(one, other)
    system.place(one, position=(0.0, 0.0, 0.1))
    solution = ns.simulate(system, 0.1)
    system.contact(one, other, **build.laws())
    with pytest.raises(ns.InvalidInput, match="must be as it ran"):
        solution.history("kinetic_energy", times=0.05)


def test_poses_are_those_of_the_frames(bounces: ns.Solution) -> None:
    """Of a ball that flies and does not turn, and of the plate."""
    _, ball = bounces.system.bodies
    times = [0.7, 0.05]
    poses = bounces.history("position", "rotation", times=times, of=ball)
    np.testing.assert_allclose(poses["position"][:, 0], bounces.at(times)["q"][:, :3], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(poses["rotation"], np.broadcast_to(np.eye(3), (2, 1, 3, 3)))
    np.testing.assert_array_equal(bounces.history("position", of="plate")["position"], np.zeros((len(bounces.t), 1, 3)))


def _differences(system: ns.System, t_end: float) -> tuple[ns.Solution, ns.Solution, np.ndarray]:
    """Return a run with few samples, one with many, and times of the many that no event has."""
    model = ns.assemble(system)
    few, many = (model.run(t_end, sample_interval=t_end / n) for n in (17.3, 301.7))
    np.testing.assert_array_equal(few.events.time, many.events.time)
    drawn = np.random.default_rng(5).permutation(np.flatnonzero(~np.isin(many.t, many.events.time)))
    return few, many, drawn


@pytest.mark.slow
@pytest.mark.parametrize(("name", "t_end"), [("dumbbell", 0.6), ("dice_throw", 0.12)])
def test_states_are_those_of_a_run_with_samples_there(name: str, t_end: float) -> None:
    """Slips that turn round without an event, and changes of features, included; to what samples are exact to."""
    few, many, drawn = _differences(registry.load("scenarios", name)().build(), t_end)
    states = few.at(many.t[drawn])
    np.testing.assert_allclose(states["q"], many.q[drawn], rtol=0, atol=1e-8)
    np.testing.assert_allclose(states["u"], many.u[drawn], rtol=0, atol=1e-7 * np.max(np.abs(many.u)))
    names = ("normal_force", "friction_force")
    one, other = (run.history("mode", *names, times=many.t) for run in (few, many))
    np.testing.assert_array_equal(one["mode"] > 0, other["mode"] > 0)
    largest = np.max(one["normal_force"])
    for which in names:
        np.testing.assert_allclose(one[which], other[which], rtol=0, atol=1e-5 * largest)
    np.testing.assert_allclose(
        few.history("unexplained_energy", times=many.t)["unexplained_energy"], 0.0, atol=1e-8 * few.energy.scale
    )


def test_laws_with_a_memory_go_on_from_it() -> None:
    """Rates at which contacts closed, bristles, and which way a directed law faces are those of the run."""
    plate = Plate(Harmonic(amplitude=2e-4, frequency=40.0))
    soft, hard = Ball(0.01), Ball(0.01)
    system = ns.System([plate, soft, hard])
    system.contact(
        soft, plate, normal=HuntCrossley(stiffness=1e6, dissipation=0.5), friction=Bristle(0.3, 0.4, stiffness=1e3)
    )
    directed = Directional(forward=0.05, backward=0.4, across=0.2)
    system.contact(hard, plate, normal=Unilateral(), friction=directed, impact=EnergeticImpact(0.3))
    system.place(soft, position=(0.0, 0.0, 0.0101), velocity=(0.2, 0.1, 0.0))
    system.place(hard, position=(0.0, 0.1, 0.0101), velocity=(0.2, 0.1, 0.0), angular_velocity=(5.0, -30.0, 0.0))
    few, many, drawn = _differences(system, 0.12)
    assert few.events.count(Cause.TOUCH) >= 2
    states, there = few.at(many.t[drawn]), many.at(many.t[drawn])
    assert np.max(np.abs(there["law_state"])) > 1e-5
    np.testing.assert_allclose(states["law_state"], there["law_state"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(states["u"], there["u"], rtol=0, atol=1e-6)
    one, other = (run.history("normal_force", times=many.t)["normal_force"] for run in (few, many))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-5 * np.max(one))
    np.testing.assert_allclose(
        few.history("unexplained_energy")["unexplained_energy"], 0.0, atol=1e-8 * few.energy.scale
    )


def test_a_run_that_went_on_knows_its_part() -> None:
    """As the whole run does; also after the solution was pickled."""
    model = ns.assemble(registry.load("scenarios", "dumbbell")().build())
    whole, first = model.run(0.3), model.run(0.147)
    second = pickle.loads(pickle.dumps(model.run(0.3, start=first.state)))
    times = np.random.default_rng(7).uniform(0.147, 0.3, 20)
    np.testing.assert_allclose(second.at(times)["u"], whole.at(times)["u"], rtol=0, atol=1e-8)
    for name in ("kinetic_energy", "driven_work", "friction_loss", "restitution_loss", "closing_loss", "load_work"):
        here, there = (one.history(name, times=times)[name] for one in (second, whole))
        np.testing.assert_allclose(here, there, rtol=0, atol=1e-8 * whole.energy.scale)
