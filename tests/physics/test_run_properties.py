"""What holds for every run: energy, symmetry, units, no penetration, lawful impulses; inputs by hypothesis."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, Dumbbell, Harmonic, Plate, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.modes import mode_shares

G = 9.81
OMEGA = 2.0 * math.pi * 25.0
PHASES = (Phase.explicit, Phase.generate)
TIGHT = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)

starts = st.fixed_dictionaries(
    {
        "tilt": st.floats(-0.6, 0.6),
        "yaw": st.floats(-3.0, 3.0),
        "roll": st.floats(-3.0, 3.0),
        "height": st.floats(0.0, 2e-3),
        "velocity": st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-0.2, 0.2)),
        "rate": st.tuples(st.floats(-15.0, 15.0), st.floats(-15.0, 15.0), st.floats(-60.0, 60.0)),
    }
)
contacts = st.fixed_dictionaries(
    {
        "restitution": st.floats(0.0, 0.9),
        "friction": st.one_of(st.just(0.0), st.floats(0.02, 1.0)),
        "extra": st.sampled_from([1.0, 1.5]),
    }
)
gammas = st.floats(0.0, 1.6)
SEEDS = st.integers(0, 10**6)


def _generic(seed: int) -> tuple[Any, Any, float]:
    """Return a start, laws and Gamma; generic, because at a branching point rounding decides which way a run goes."""
    random = np.random.default_rng(seed)
    start = {
        "tilt": random.uniform(0.02, 0.6) * random.choice([-1.0, 1.0]),
        "yaw": random.uniform(-3.0, 3.0),
        "roll": random.uniform(-3.0, 3.0),
        "height": random.choice([0.0, 5e-4]),
        "velocity": tuple(random.uniform(-0.5, 0.5, 3) * [1.0, 1.0, 0.4]),
        "rate": tuple(random.uniform(-1.0, 1.0, 3) * [15.0, 15.0, 60.0]),
    }
    laws = {
        "restitution": float(random.choice([0.3, 0.6, 0.9])),
        "friction": float(random.choice([0.0, 0.05, 0.2, 0.5])),
        "extra": float(random.choice([1.0, 1.5])),
    }
    return start, laws, float(random.choice([0.0, 0.5, 0.9, 1.3]))


def _motion(gamma: float) -> Any:
    return Harmonic(amplitude=gamma * G / OMEGA**2, frequency=25.0) if gamma > 0.01 else Rest()


def _place(build: Any, system: ns.System, body: Dumbbell, start: Any) -> None:
    tilt = start["tilt"]
    z1 = body.radius + start["height"] + max(0.0, -body.centre_distance * math.sin(tilt))
    q = (0.0, 0.0, z1, start["yaw"], tilt, start["roll"])
    system.place(body, **build.paper_start(body, q, (*start["velocity"], *start["rate"])))


def _system(build: Any, body: Dumbbell, motion: Any, laws: Any, start: Any) -> ns.System:
    static = laws["friction"] * laws["extra"]
    system: ns.System = build.over(
        body, motion, restitution=laws["restitution"], friction=laws["friction"], static=static
    )
    _place(build, system, body, start)
    return system


def _energy(body: Any, q: Any, u: Any) -> Any:
    inertia = np.array(body.inertia)
    kinetic = 0.5 * (body.total_mass * np.sum(u[:, :3] ** 2, axis=1) + np.sum(inertia * u[:, 3:] ** 2, axis=1))
    return kinetic + body.total_mass * G * q[:, 2]


@example(
    # a graze between two samples at which the gap rates have one sign
    start={
        "tilt": -0.3583089873898657,
        "yaw": 0.0,
        "roll": 0.0,
        "height": 0.0011745742502477178,
        "velocity": (-0.3039711243953313, 0.0, 0.0995182159674608),
        "rate": (-0.3039711243953313, 0.0, 0.0995182159674608),
    },
    laws={"friction": 0.8286721140177845, "restitution": 0.3425033576053884, "extra": 1.0},
    gamma=1.3146822414632888,
)
@example(
    # a slip that is slower than its tolerance and slows down
    start={
        "tilt": 0.21873823525971003,
        "yaw": 2.0,
        "roll": -0.2550095064693547,
        "height": 0.001139979694485057,
        "velocity": (0.23422584444233008, -0.47598220050742635, -0.10036790221988844),
        "rate": (0.0, 10.238505879687313, -15.587629976793664),
    },
    laws={"friction": 0.7556129652873369, "restitution": 0.0, "extra": 1.0},
    gamma=0.00023679474171480247,
)
@example(
    # a compression that comes to nothing
    start={
        "tilt": 0.0,
        "yaw": 0.0,
        "roll": 2e-05,
        "height": 0.0,
        "velocity": (0.08298596672149972, 2e-08, -0.1740955324598789),
        "rate": (0.08298596672149972, 2e-08, -0.1740955324598789),
    },
    laws={"friction": 0.24946045231028768, "restitution": 0.0, "extra": 1.0},
    gamma=1.3710422656367105,
)
@settings(derandomize=True, max_examples=200, phases=PHASES)
@given(start=starts, laws=contacts, gamma=gammas)
def test_energy_gaps_and_impulses(build: Any, start: Any, laws: Any, gamma: float) -> None:
    """Residual <= 1e-8; nothing penetrates; impulses push and lie in the friction disc; losses are losses."""
    body, motion = Dumbbell(), _motion(gamma)
    system = _system(build, body, motion, laws, start)
    solution = ns.simulate(system, 0.1, sample_interval=5e-4)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8
    assert sum(mode_shares(solution).values()) == pytest.approx(1.0, abs=1e-12)
    heights = _heights(body, solution.q) - body.radius
    plate = motion.parameters().get("amplitude", 0.0) * np.sin(OMEGA * solution.t)
    assert np.min(heights - plate[:, None]) >= -1e-9
    events = solution.events
    scale = body.total_mass * 0.1
    normal, tangential = events.impulse[:, :, 0], np.hypot(events.impulse[:, :, 1], events.impulse[:, :, 2])
    hits = events.cause == Cause.IMPACT
    assert np.all(normal[hits] >= -1e-9 * scale)
    # both contacts of a dumbbell may share their friction, Eq. (39)
    static = laws["friction"] * laws["extra"]
    assert np.all(tangential[hits].sum(axis=1) <= 2.0 * static * normal[hits].sum(axis=1) + 1e-9 * scale)
    assert np.all(events.restitution_loss >= -1e-12)
    assert np.all(events.friction_loss >= -1e-12)
    assert np.all(np.diff(events.time) >= 0.0)


def _heights(body: Dumbbell, q: Any) -> Any:
    """Heights of the two ball centres."""
    a, b, c, d = q[:, 3], q[:, 4], q[:, 5], q[:, 6]
    rise = 2.0 * (b * d - a * c) * body.centre_distance / 2.0
    return np.column_stack([q[:, 2] - rise, q[:, 2] + rise])


@settings(derandomize=True, max_examples=25, phases=PHASES)
@given(start=starts, laws=contacts)
def test_energy_never_rises_on_a_still_plate(build: Any, start: Any, laws: Any) -> None:
    """Kinetic plus potential energy decreases from sample to sample and over every event."""
    body = Dumbbell()
    solution = ns.simulate(_system(build, body, Rest(), laws, start), 0.15, sample_interval=1e-3)
    energy = _energy(body, solution.q, solution.u)
    assert np.max(np.diff(energy)) <= 1e-8 * energy[0]
    before = _energy(body, solution.events.q, solution.events.u_before)
    after = _energy(body, solution.events.q, solution.events.u_after)
    assert np.all(after <= before + 1e-10 * energy[0])
    assert abs(solution.energy.driven_work) <= 1e-14


@settings(derandomize=True, max_examples=20, phases=PHASES)
@given(start=starts, restitution=st.floats(0.0, 1.0), gamma=gammas)
def test_without_friction_the_horizontal_momentum_stays(
    build: Any, start: Any, restitution: float, gamma: float
) -> None:
    """Frictionless: horizontal velocity and the vertical angular momentum of the axis stay as they are."""
    body = Dumbbell()
    laws = {"restitution": restitution, "friction": 0.0, "extra": 1.0}
    solution = ns.simulate(_system(build, body, _motion(gamma), laws, start), 0.1)
    np.testing.assert_allclose(solution.u[:, :2], np.tile(solution.u[0, :2], (len(solution.u), 1)), rtol=0, atol=1e-11)
    moment = _vertical_moment(body, solution)
    size = body.inertia[1] * (1.0 + float(np.max(np.abs(solution.u[:, 3:]))))
    np.testing.assert_allclose(moment, moment[0], rtol=0, atol=1e-7 * size)
    assert solution.energy.friction_loss == 0.0


def _vertical_moment(body: Dumbbell, solution: ns.Solution) -> Any:
    from scipy.spatial.transform import Rotation

    axes = Rotation.from_quat(np.roll(solution.q[:, 3:], -1, axis=1)).as_matrix()
    return np.einsum("nj,nj->n", axes[:, 2, :], np.array(body.inertia) * solution.u[:, 3:])


@settings(derandomize=True, max_examples=15, phases=PHASES)
@given(seed=SEEDS, turn=st.floats(-3.0, 3.0))
def test_rotation_about_the_vertical_maps_the_path(build: Any, seed: int, turn: float) -> None:
    """Turning the start about z turns the path: the tangents of the contact are arbitrary."""
    start, laws, gamma = _generic(seed)
    c, s = math.cos(turn), math.sin(turn)
    spin = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    moved = start | {"yaw": start["yaw"] + turn, "velocity": tuple(spin @ start["velocity"])}
    one, other = _pair(build, laws, gamma, start, moved)
    np.testing.assert_allclose(other.events.time, one.events.time, rtol=0, atol=1e-10)
    np.testing.assert_allclose(other.q[:, :3], one.q[:, :3] @ spin.T, rtol=0, atol=1e-10)
    # body components of the angular velocity do not turn
    np.testing.assert_allclose(other.u[-1, 3:], one.u[-1, 3:], rtol=0, atol=1e-7)


@settings(derandomize=True, max_examples=15, phases=PHASES)
@given(seed=SEEDS)
def test_reflection_maps_the_path(build: Any, seed: int) -> None:
    """Reflecting the start at the plane y = 0 reflects the path."""
    start, laws, gamma = _generic(seed)
    mirror = np.array([1.0, -1.0, 1.0])
    # the axis (-sin, cos) of the paper's angles reflects to theta -> pi - theta; a spin about it changes sign
    rate = start["rate"]
    moved = start | {
        "yaw": math.pi - start["yaw"],
        "roll": -start["roll"],
        "velocity": tuple(mirror * start["velocity"]),
        "rate": (-rate[0], rate[1], -rate[2]),
    }
    one, other = _pair(build, laws, gamma, start, moved)
    np.testing.assert_allclose(other.events.time, one.events.time, rtol=0, atol=1e-10)
    np.testing.assert_allclose(other.q[:, :3], one.q[:, :3] * mirror, rtol=0, atol=1e-10)
    np.testing.assert_allclose(other.u[:, :3], one.u[:, :3] * mirror, rtol=0, atol=1e-8)


def _pair(build: Any, laws: Any, gamma: float, start: Any, moved: Any) -> tuple[ns.Solution, ns.Solution]:
    runs = []
    for which in (start, moved):
        body = Dumbbell()
        runs.append(
            ns.simulate(_system(build, body, _motion(gamma), laws, which), 0.04, sample_interval=2e-3, engine=TIGHT)
        )
    return runs[0], runs[1]


def test_a_planar_start_stays_planar(build: Any) -> None:
    """The drift start over twenty periods: nothing leaves the plane of the rod, to 1e-12."""
    body = Dumbbell()
    system = build.over(body, _motion(0.9), restitution=0.65, friction=0.2)
    system.place(body, **build.paper_start(body, (0, 0, body.radius, 0, math.radians(10), 0), np.zeros(6)))
    solution = ns.simulate(system, 0.8)
    assert np.max(np.abs(solution.q[:, 0])) <= 1e-12
    assert np.max(np.abs(solution.u[:, 0])) <= 1e-12
    assert np.max(np.abs(solution.u[:, 3])) <= 1e-9
    assert np.max(np.abs(solution.u[:, 5])) <= 1e-9
    assert solution.energy.residual <= 1e-8


def test_units_do_not_matter(build: Any) -> None:
    """Lengths times 4, times 2, so that g stays: the same run in other units, tolerances scaled along."""
    length, time = 4.0, 2.0
    runs = []
    for a, b in ((1.0, 1.0), (length, time)):
        body = Dumbbell(4.76e-3 * a)
        motion = Harmonic(amplitude=0.9 * G / OMEGA**2 * a, frequency=25.0 / b)
        system = build.over(body, motion, restitution=0.65, friction=0.2, duration=2e-5 * b)
        q = (0.0, 0.0, body.radius, 0.3, 0.17, 0.0)
        rate = (0.2 * a / b, 0.0, 0.0, 0.0, 0.0, 5.0 / b)
        system.place(body, **build.paper_start(body, q, rate))
        engine = ns.EventDriven(
            tolerance=1e-12,
            impact_tolerance=1e-12,
            time_tolerance=1e-12 * b,
            gap_tolerance=1e-12 * a,
            velocity_tolerance=1e-9 * a / b,
            largest_step=0.1 * b,
        )
        runs.append(ns.simulate(system, 0.2 * b, engine=engine))
    one, other = runs
    np.testing.assert_allclose(other.events.time / time, one.events.time, rtol=0, atol=1e-10)
    np.testing.assert_allclose(other.q[:, :3] / length, one.q[:, :3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.u[:, :3] * time / length, one.u[:, :3], rtol=0, atol=1e-8)


def test_density_does_not_matter(build: Any) -> None:
    """Mass cancels from the motion."""
    runs = []
    for density in (1000.0, 8000.0):
        body = Dumbbell(density=density)
        system = build.over(body, _motion(0.9), restitution=0.65, friction=0.2)
        system.place(body, **build.paper_start(body, (0, 0, body.radius, 0, 0.17, 0), np.zeros(6)))
        runs.append(ns.simulate(system, 0.2))
    np.testing.assert_allclose(runs[1].events.time, runs[0].events.time, rtol=0, atol=1e-11)
    np.testing.assert_allclose(runs[1].q, runs[0].q, rtol=0, atol=1e-10)
    assert runs[1].energy.driven_work == pytest.approx(8.0 * runs[0].energy.driven_work, rel=1e-8)


def test_bodies_that_never_meet_do_not_know_of_each_other(build: Any) -> None:
    """Two balls far apart on one plate move as each alone, whatever the order."""
    motion = _motion(1.3)
    heights, alone = (0.004, 0.0071), []
    for height in heights:
        ball = Ball(0.01)
        system = build.over(ball, motion)
        system.place(ball, position=(0, 0, 0.01 + height), velocity=(0.2, 0, 0))
        alone.append(ns.simulate(system, 0.15))
    for order in ((0, 1), (1, 0)):
        plate, balls = Plate(motion), (Ball(0.01), Ball(0.01))
        system = ns.System([plate, *balls], G)
        for number in order:
            system.contact(plate, balls[number], **build.laws())
            system.place(balls[number], position=(0, number, 0.01 + heights[number]), velocity=(0.2, 0, 0))
        both = ns.simulate(system, 0.15)
        for number in range(2):
            q, u = both.of(balls[number])
            np.testing.assert_allclose(q[-1, [0, 2]], alone[number].q[-1, [0, 2]], rtol=0, atol=1e-8)
            np.testing.assert_allclose(u[-1, 2], alone[number].u[-1, 2], rtol=0, atol=1e-6)
        assert both.events.count(Cause.IMPACT) == sum(a.events.count(Cause.IMPACT) for a in alone)
