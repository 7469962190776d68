"""Sustained contact against closed forms and scipy, thresholds from both sides."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Dumbbell, Harmonic, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.modes import mode_shares

G = 9.81
TIGHT = ns.EventDriven(tolerance=1e-12)
SIDES = pytest.mark.parametrize("side", [-1e-6, 1e-6])


def _on_slope(
    build: Any, body: Any, radius: float, angle: float, friction: float, static: float | None = None
) -> ns.System:
    """Place a body with its first axis down the fall line, touching."""
    system: ns.System = build.over(body, Rest(angle), friction=friction, static=static)
    normal = np.array([math.sin(angle), 0.0, math.cos(angle)])
    turn = (math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0)
    system.place(body, position=radius * normal, orientation=turn)
    return system


def _times(solution: ns.Solution, cause: int) -> Any:
    return solution.events.time[solution.events.cause == cause]


@pytest.mark.parametrize("heading", [0.0, 2.3])
def test_sliding_ball_starts_to_roll(build: Any, heading: float) -> None:
    """It slides for 2 v0 / (7 mu g), then rolls at 5 v0 / 7."""
    ball, v0, mu = Ball(0.01), 0.5, 0.2
    system = build.over(ball, friction=mu)
    along = np.array([math.cos(heading), math.sin(heading), 0.0])
    system.place(ball, position=(0, 0, 0.01), velocity=v0 * along)
    solution = ns.simulate(system, 0.2, engine=TIGHT)
    stick = 2.0 * v0 / (7.0 * mu * G)
    np.testing.assert_allclose(_times(solution, Cause.SLIP_TO_STICK), [stick], rtol=0, atol=1e-9)
    np.testing.assert_allclose(solution.u_end[:3], 5.0 * v0 / 7.0 * along, rtol=0, atol=1e-10)
    spin = np.array([-along[1], along[0], 0.0]) * 5.0 * v0 / 7.0 / 0.01
    axes = _rotation(solution.q_end[3:])
    np.testing.assert_allclose(axes @ solution.u_end[3:], spin, rtol=0, atol=1e-7)
    distance = v0 * stick - 0.5 * mu * G * stick**2 + 5.0 * v0 / 7.0 * (0.2 - stick)
    np.testing.assert_allclose(solution.q_end[:3], distance * along + (0, 0, 0.01), rtol=0, atol=1e-10)
    assert build.lived(solution) == ["{1,0,0}", "{1,0,1}"]
    assert mode_shares(solution)["{1,0,1}"] == pytest.approx(stick / 0.2, abs=1e-8)
    assert solution.energy.residual <= 1e-9
    assert solution.energy.friction_loss == pytest.approx(ball.total_mass * v0**2 / 7.0, rel=1e-9)


@SIDES
def test_ball_rolls_down_a_slope_without_slip(build: Any, side: float) -> None:
    """It rolls iff tan(angle) <= 3.5 mu_s; sliding it is slower to turn and quicker to fall."""
    static, mu = 0.2, 0.15
    angle = math.atan(3.5 * static) * (1.0 + side)
    ball = Ball(0.01)
    solution = ns.simulate(_on_slope(build, ball, 0.01, angle, mu, static), 0.1, engine=TIGHT)
    down = np.array([math.cos(angle), 0.0, -math.sin(angle)])
    expected = 5.0 / 7.0 * G * math.sin(angle) if side < 0.0 else G * (math.sin(angle) - mu * math.cos(angle))
    np.testing.assert_allclose(solution.u_end[:3], 0.1 * expected * down, rtol=0, atol=1e-9)
    moved = solution.q_end[:3] - solution.q[0, :3]
    np.testing.assert_allclose(moved, 0.005 * expected * down, rtol=0, atol=1e-10)
    assert build.lived(solution) == ["{1,0,0}" if side < 0.0 else "{1,0,1}"]
    assert solution.energy.residual <= 1e-9


@SIDES
@pytest.mark.parametrize("static", [0.1, 0.7])
@pytest.mark.parametrize("kinetic", [1.0, 0.6])
def test_dumbbell_along_the_fall_line(build: Any, side: float, static: float, kinetic: float) -> None:
    """It cannot roll: it sticks iff mu_s >= tan(angle), by the group rule (38), and slides with mu."""
    angle = math.atan(static) * (1.0 + side)
    mu = kinetic * static
    body = Dumbbell()
    solution = ns.simulate(_on_slope(build, body, body.radius, angle, mu, static), 0.05, engine=TIGHT)
    moved = solution.q_end - solution.q[0]
    if side < 0.0:
        assert build.lived(solution) == ["{11,00,00}"]
        np.testing.assert_allclose(moved, 0.0, rtol=0, atol=1e-15)
    else:
        assert build.lived(solution) == ["{11,00,11}"]
        acceleration = G * (math.sin(angle) - mu * math.cos(angle))
        down = np.array([math.cos(angle), 0.0, -math.sin(angle)])
        np.testing.assert_allclose(moved[:3], 0.5 * acceleration * 0.05**2 * down, rtol=0, atol=1e-11)
        np.testing.assert_allclose(moved[3:], 0.0, rtol=0, atol=1e-12)


def test_dumbbell_across_the_fall_line_rolls(build: Any) -> None:
    """Its axis level, it rolls down like a cylinder of its moment of inertia: Eq. (37)."""
    angle, body = 0.2, Dumbbell()
    system = build.over(body, Rest(angle), friction=0.5)
    normal = np.array([math.sin(angle), 0.0, math.cos(angle)])
    # first axis along world y, the rest in the slope's plane
    axes = np.column_stack([[0, 1, 0], -np.array([math.cos(angle), 0.0, -math.sin(angle)]), normal])
    system.place(body, position=body.radius * normal, orientation=_quaternion(axes))
    solution = ns.simulate(system, 0.05, engine=TIGHT)
    along = body.inertia[0]
    acceleration = G * math.sin(angle) / (1.0 + along / (body.total_mass * body.radius**2))
    down = np.array([math.cos(angle), 0.0, -math.sin(angle)])
    np.testing.assert_allclose(solution.u_end[:3], acceleration * 0.05 * down, rtol=0, atol=1e-10)
    assert build.lived(solution) == ["{11,00,00}"]
    np.testing.assert_allclose(solution.u_end[3:], (acceleration * 0.05 / body.radius, 0, 0), rtol=0, atol=1e-7)


def test_flat_dumbbell_rests_exactly(build: Any) -> None:
    """{11,00,00} on a still plate: forces are not unique, the rest is exact."""
    body = Dumbbell()
    system = build.over(body)
    system.place(body, position=(0.1, -0.2, body.radius), orientation=build.quaternion(0.3, 0.0, 0.7))
    solution = ns.simulate(system, 1.0)
    np.testing.assert_allclose(solution.q, np.tile(solution.q[0], (len(solution.q), 1)), rtol=0, atol=1e-12)
    assert build.lived(solution) == ["{11,00,00}"]
    assert len(solution.events) == 1
    assert solution.energy.exchanged <= 1e-15


def test_flat_dumbbell_keeps_rolling(build: Any) -> None:
    """Pure rolling of Eq. (37): straight, at constant speed, with {11,00,00}."""
    body, spin, theta = Dumbbell(), 12.0, 0.4
    system = build.over(body)
    rate = (0.0, 0.0, 0.0, 0.0, 0.0, spin)
    start = build.paper_start(body, (0, 0, body.radius, theta, 0.0, 0.2), rate)
    # x' cos + y' sin = r gamma' in the paper's axes
    velocity = body.radius * spin * np.array([math.cos(theta), math.sin(theta), 0.0])
    system.place(body, **(start | {"velocity": velocity}))
    solution = ns.simulate(system, 0.5, engine=TIGHT)
    np.testing.assert_allclose(solution.q_end[:3] - solution.q[0, :3], 0.5 * velocity, rtol=0, atol=1e-10)
    np.testing.assert_allclose(solution.u_end, solution.u[0], rtol=0, atol=1e-9)
    assert build.lived(solution) == ["{11,00,00}"]


@pytest.mark.parametrize("gamma", [0.5, 0.999999, 1.000001, 1.4])
def test_vibrating_plate_throws_the_dumbbell(build: Any, gamma: float) -> None:
    """Below Gamma = 1 it rests on the plate; above, both contacts open at once, at asin(1/Gamma)."""
    body, frequency = Dumbbell(), 25.0
    omega = 2.0 * math.pi * frequency
    motion = Harmonic(amplitude=gamma * G / omega**2, frequency=frequency)
    system = build.over(body, motion)
    system.place(body, position=(0, 0, body.radius), velocity=(0, 0, motion.amplitude * omega))
    solution = ns.simulate(system, 0.5 / frequency if gamma > 1.0 else 0.2, engine=TIGHT)
    lifted = _times(solution, Cause.LIFT_OFF)
    if gamma < 1.0:
        assert len(solution.events) == 1
        assert build.lived(solution) == ["{11,00,00}"]
        height = motion.amplitude * math.sin(omega * solution.t_end)
        assert solution.q_end[2] - body.radius == pytest.approx(height, abs=1e-14)
    else:
        assert lifted[0] == pytest.approx(math.asin(1.0 / gamma) / omega, abs=1e-9)
        first = int(np.flatnonzero(solution.events.cause == Cause.LIFT_OFF)[0])
        assert solution.events.words("before")[first] == "{11,00,00}"
        assert solution.events.words("after")[first] == "{00,00,00}"
    assert solution.energy.residual <= 1e-8


@pytest.mark.parametrize("ratio", [1.0 - 1e-6, 1.0 + 1e-6, 2.0])
def test_shaken_sideways_the_dumbbell_breaks_away(build: Any, ratio: float) -> None:
    """Static friction above kinetic: slip starts when A omega^2 |sin| reaches mu_s g, and not before."""
    body, static, mu = Dumbbell(), 0.4, 0.25
    omega = 2.0 * math.pi * 10.0
    motion = Harmonic(amplitude=ratio * static * G / omega**2, frequency=10.0, axis_x=1.0, axis_z=0.0)
    system = build.over(body, motion, friction=mu, static=static)
    system.place(body, position=(0, 0, body.radius), velocity=(motion.amplitude * omega, 0, 0))
    solution = ns.simulate(system, 0.049, engine=TIGHT)
    broke = _times(solution, Cause.STICK_TO_SLIP)
    if ratio < 1.0:
        assert build.lived(solution) == ["{11,00,00}"]
    else:
        assert broke[0] == pytest.approx(math.asin(1.0 / ratio) / omega, abs=1e-9)
        first = int(np.flatnonzero(solution.events.cause == Cause.STICK_TO_SLIP)[0])
        assert solution.events.words("after")[first] == "{11,00,11}"
    if ratio == 2.0:
        assert solution.u_end[0] == pytest.approx(
            motion.amplitude * omega * math.cos(omega * broke[0]) - mu * G * (0.049 - broke[0]), abs=1e-9
        )
    assert solution.energy.residual <= 1e-8


@pytest.mark.parametrize("ratio", [1.0 - 1e-6, 1.0 + 1e-6])
def test_shaken_sideways_the_ball_breaks_away(build: Any, ratio: float) -> None:
    """A ball on a plate that accelerates at a needs the friction 2/7 m a: it slips above 3.5 mu_s g."""
    ball, static = Ball(0.01), 0.1
    omega = 2.0 * math.pi * 10.0
    motion = Harmonic(amplitude=ratio * 3.5 * static * G / omega**2, frequency=10.0, axis_y=1.0, axis_z=0.0)
    system = build.over(ball, motion, friction=0.05, static=static)
    system.place(ball, position=(0, 0, 0.01), velocity=(0, motion.amplitude * omega, 0))
    solution = ns.simulate(system, 0.049, engine=TIGHT)
    broke = _times(solution, Cause.STICK_TO_SLIP)
    if ratio < 1.0:
        assert build.lived(solution) == ["{1,0,0}"]
    else:
        assert broke[0] == pytest.approx(math.asin(1.0 / ratio) / omega, abs=1e-9)


def test_slip_that_turns_on_a_slope(build: Any) -> None:
    """A ball shot across a slope: the slip direction turns; path and velocity equal scipy's to 1e-8."""
    from scipy.integrate import solve_ivp

    angle, mu, radius, t_end = 0.5, 0.12, 0.01, 0.3
    ball = Ball(radius)
    system = _on_slope(build, ball, radius, angle, mu)
    system.place(ball, position=system.start(ball)[0][:3], velocity=(0.0, 0.4, 0.0), angular_velocity=(20.0, 30.0, 5.0))
    solution = ns.simulate(system, t_end, engine=TIGHT)
    down, across = np.array([math.cos(angle), 0.0, -math.sin(angle)]), np.array([0.0, 1.0, 0.0])
    normal = np.cross(down, across)
    u0 = system.start(ball)[1]
    slip = u0[:3] + np.cross(u0[3:], -radius * normal)

    def slope(t: float, y: Any) -> Any:
        friction = -mu * G * math.cos(angle) * y[4:] / np.hypot(*y[4:])
        fall = np.array([G * math.sin(angle), 0.0])
        return np.concatenate([y[2:4], friction + fall, 3.5 * friction + fall])

    y0 = [0, 0, u0[:3] @ down, u0[:3] @ across, slip @ down, slip @ across]
    found = solve_ivp(slope, (0.0, t_end), y0, "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    moved = solution.q_end[:3] - solution.q[0, :3]
    np.testing.assert_allclose((moved @ down, moved @ across), found[:2], rtol=0, atol=1e-8)
    np.testing.assert_allclose((solution.u_end[:3] @ down, solution.u_end[:3] @ across), found[2:4], rtol=0, atol=1e-8)
    assert abs(moved @ normal) <= 1e-14
    assert build.lived(solution) == ["{1,0,1}"]
    assert solution.energy.residual <= 1e-9


def test_flat_dumbbell_slides_and_turns(build: Any) -> None:
    """Two sliding contacts, yaw and roll with their gyroscopic moment: as derived with vectors to 1e-8."""
    from scipy.integrate import solve_ivp

    body, mu, t_end = Dumbbell(), 0.2, 0.03
    along_j, across_j, _ = body.inertia
    m, half, r = body.total_mass, body.centre_distance / 2, body.radius
    v0, yaw0, roll0 = np.array([0.3, 0.2]), 15.0, 60.0
    up = np.array([0.0, 0.0, 1.0])

    def slope(t: float, y: Any) -> Any:
        yaw, v, yaw_rate, roll = y[2], np.append(y[3:5], 0.0), y[5], y[6]
        e = np.array([math.cos(yaw), math.sin(yaw), 0.0])
        side = np.cross(up, e)
        omega = yaw_rate * up + roll * e
        arms = [sign * half * e - r * up for sign in (-1.0, 1.0)]
        slips = [v + np.cross(omega, arm) for arm in arms]
        # force per unit normal force, and the pitch balance that shares the weight
        pulls = [up - mu * s / np.linalg.norm(s) for s in slips]
        pitch = [np.cross(arm, pull) @ side for arm, pull in zip(arms, pulls, strict=True)]
        balance = np.array([[1.0, 1.0], pitch], dtype=float)
        weights = np.linalg.solve(balance, [m * G, along_j * roll * yaw_rate])
        force = sum(w * p for w, p in zip(weights, pulls, strict=True))
        torque = sum(w * np.cross(arm, p) for w, arm, p in zip(weights, arms, pulls, strict=True))
        assert min(weights) > 0.0
        return np.concatenate([y[3:5], [yaw_rate], force[:2] / m, [torque @ up / across_j, torque @ e / along_j]])

    y0 = [0, 0, 0, *v0, yaw0, roll0]
    found = solve_ivp(slope, (0.0, t_end), y0, "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    system = build.over(body, friction=mu)
    system.place(body, position=(0, 0, r), velocity=(*v0, 0.0), angular_velocity=(roll0, 0.0, yaw0))
    solution = ns.simulate(system, t_end, engine=TIGHT)
    np.testing.assert_allclose(solution.q_end[:2], found[:2], rtol=0, atol=1e-8)
    np.testing.assert_allclose(solution.u_end[:2], found[3:5], rtol=0, atol=1e-8)
    axes = _rotation(solution.q_end[3:])
    assert math.atan2(axes[1, 0], axes[0, 0]) == pytest.approx(found[2], abs=1e-8)
    omega = axes @ solution.u_end[3:]
    assert omega[2] == pytest.approx(found[5], abs=1e-6)
    assert omega @ axes[:, 0] == pytest.approx(found[6], abs=1e-6)
    assert build.lived(solution) == ["{11,00,11}"]
    assert solution.energy.residual <= 1e-9


def _rotation(q: Any) -> Any:
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(np.roll(q, -1)).as_matrix()


def _quaternion(axes: Any) -> Any:
    from scipy.spatial.transform import Rotation

    return np.roll(Rotation.from_matrix(axes).as_quat(), 1)
