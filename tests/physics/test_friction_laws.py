"""Friction by direction, history, bristles and turning, against closed forms and independent integrations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, ConstantVelocity, FunctionLoad, Plate, Rest, RigidBody, Sphere
from laws import (
    Anisotropic,
    Bristle,
    CoulombContensou,
    Directional,
    EnergeticImpact,
    HuntCrossley,
    LinearCompliant,
    NewtonImpact,
    RateAndState,
    Unilateral,
)
from nonsmooth.engine.memory.modes import Cause, Mode
from nonsmooth.parameters import UnusualValue
from tests.physics.moved_systems import quaternion

G = 9.81
RADIUS = 0.01
MASS = Ball(RADIUS).total_mass
FOOT, HALF, HEIGHT = 0.005, 0.08, 0.02
FEET = ((1.0, 1.0), (-1.0, 0.0), (1.0, -1.0))
TIGHT = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)
STIFFNESS = 1e9


def _rigid(friction: Any) -> dict[str, Any]:
    return {"normal": Unilateral(), "friction": friction, "impact": EnergeticImpact(0.0)}


def _soft(friction: Any) -> dict[str, Any]:
    return {"normal": HuntCrossley(STIFFNESS, 1.0), "friction": friction}


def _ball(laws: Any, t_end: float, velocity: Any, spin: Any = (0.0, 0.0, 0.0), turn: float = 0.0) -> ns.Solution:
    """Run a ball that lies on a plate, indented by its weight if that is compliant."""
    plate, ball = Plate(), Ball(RADIUS)
    system = ns.System([plate, ball], G)
    system.contact(plate, ball, **laws)
    depth = 0.0 if "impact" in laws else (MASS * G / STIFFNESS) ** (2.0 / 3.0)
    start = {"position": (0.0, 0.0, RADIUS - depth), "orientation": quaternion((0.0, 0.0, 1.0), turn)}
    system.place(ball, velocity=velocity, angular_velocity=spin, **start)
    return ns.simulate(system, t_end, sample_interval=t_end, engine=TIGHT)


def _block(
    laws: Any, t_end: float, *, slope: float = 0.0, heading: float = 0.0, load: Any = None, motion: Any = None
) -> ns.Solution:
    """Run a block of 1 kg on three feet on a slope or a moving plate, heading off the fall line, with a load."""
    block = RigidBody(1.0, (2e-3, 3e-3, 4e-3), tuple(Sphere(FOOT, HALF * x, HALF * y, FOOT - HEIGHT) for x, y in FEET))
    plate = Plate(motion or Rest(slope=slope))
    system = ns.System([plate, block], G)
    system.contact(plate, block, **laws)
    if load is not None:
        system.load(load, plate, block)
    (s, c), (z, w) = ((math.sin(0.5 * angle), math.cos(0.5 * angle)) for angle in (slope, heading))
    depth = 0.0 if "impact" in laws else (G / 3.0 / STIFFNESS) ** (2.0 / 3.0)
    normal = np.array([math.sin(slope), 0.0, math.cos(slope)])
    system.place(block, position=tuple((HEIGHT - depth) * normal), orientation=(c * w, s * z, s * w, c * z))
    return ns.simulate(system, t_end, sample_interval=t_end, engine=TIGHT)


def _along(law: Anisotropic | Directional, slip: np.ndarray, angle: float) -> np.ndarray:
    """Return the friction per normal force, the axis being at an angle to the first component."""
    e = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    v = e @ slip
    forward, backward, across = law.ratios
    ratios = np.array([forward if v[0] > 0.0 else backward, across])
    counted = ratios * v
    strongest = max(law.numbers()[name] for name in law.numbers())
    return np.asarray(-strongest * e.T @ (ratios * counted) / np.linalg.norm(counted))


def _slip(solution: ns.Solution) -> np.ndarray:
    """Return slip velocity and spin of a ball on a plate; its angular velocity is in its own axes."""
    q, u = solution.q_end, solution.u_end
    spin = Rotation.from_quat(q[3:7], scalar_first=True).apply(u[3:])
    return np.array([u[0] - RADIUS * spin[1], u[1] + RADIUS * spin[0], spin[2]])


@settings(max_examples=15, deadline=None)
@given(
    forward=st.floats(0.05, 0.6),
    backward=st.floats(0.05, 0.6),
    across=st.floats(0.05, 0.6),
    angle=st.floats(-3.1, 3.1),
    heading=st.floats(-3.1, 3.1),
)
def test_a_sliding_ball_turns_off(forward: float, backward: float, across: float, angle: float, heading: float) -> None:
    """Its slip obeys v' = 7/2 T(v) / m; the axis stands still with the plate."""
    axis = (math.cos(angle), math.sin(angle), 0.0)
    law = Directional(forward, backward, across, axis=axis, body="first")
    start, t_end = np.array([math.cos(heading), math.sin(heading)]), 0.01
    expected = solve_ivp(
        lambda t, v: 3.5 * G * _along(law, v, angle), (0.0, t_end), start, "DOP853", rtol=1e-12, atol=1e-12
    ).y[:, -1]
    solution = _ball(_rigid(law), t_end, (*start, 0.0))
    np.testing.assert_allclose(_slip(solution)[:2], expected, rtol=0, atol=1e-9)
    assert solution.energy.residual < 1e-8


def test_equal_coefficients_are_coulombs(build: Any) -> None:
    """With one coefficient for all directions the path is that of the isotropic law."""
    one = _ball(_rigid(Anisotropic(0.2, 0.2, body="first")), 0.1, (0.3, 0.4, 0.0), (1.0, 2.0, 3.0))
    other = _ball(build.laws(0.0, 0.2), 0.1, (0.3, 0.4, 0.0), (1.0, 2.0, 3.0))
    np.testing.assert_allclose(one.u_end, other.u_end, rtol=0, atol=1e-10)


@pytest.mark.parametrize("side", ["first", "second"])
def test_the_axis_turns_with_its_body(side: Any) -> None:
    """Turned by a right angle a block slips with the other coefficient if the axis is its own."""
    law, t_end, slope = Anisotropic(0.1, 0.3, body=side), 0.05, 0.5
    for heading, mu in ((0.0, 0.1), (0.5 * math.pi, 0.1 if side == "first" else 0.3)):
        solution = _block(_rigid(law), t_end, slope=slope, heading=heading)
        speed = float(np.linalg.norm(solution.u_end[:3]))
        assert speed == pytest.approx(G * (math.sin(slope) - mu * math.cos(slope)) * t_end, rel=1e-9)


@pytest.mark.parametrize(("tilt", "as_axis"), [(0.0, 0), (0.9e-7, 0), (1.1e-7, 1)])
@pytest.mark.parametrize("side", ["first", "second"])
def test_an_axis_along_the_normal_gives_way_to_the_bodys_next(side: Any, tilt: float, as_axis: int) -> None:
    """An upright axis is x to a block; one that leans to y, by more than round-off, is y."""
    slopes = {"slope": 0.5, "heading": 0.3}
    upright = _block(_rigid(Directional(0.1, 0.2, 0.3, axis=(0.0, 5.0 * tilt, 5.0), body=side)), 0.05, **slopes)
    axis = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))[as_axis]
    lying = _block(_rigid(Directional(0.1, 0.2, 0.3, axis=axis, body=side)), 0.05, **slopes)
    np.testing.assert_allclose(upright.u_end, lying.u_end, rtol=0, atol=1e-12)


@pytest.mark.parametrize("law", [Anisotropic(0.1, 0.5), Directional(0.1, 0.2, 0.3)], ids=["anisotropic", "directional"])
@pytest.mark.parametrize("impact", [EnergeticImpact(0.5), NewtonImpact(0.5)], ids=["energetic", "newton"])
def test_a_ball_lands_on_its_axis(law: Any, impact: Any) -> None:
    """It bounces and rolls on; seen by another observer it does the same."""
    ends = []
    upright, turned = quaternion((0.0, 1.0, 0.0), 0.5 * math.pi), 0.7
    for angle in (0.0, turned):
        plate, ball = Plate(), Ball(RADIUS)
        system = ns.System([plate, ball], G)
        system.contact(plate, ball, normal=Unilateral(), friction=law, impact=impact)
        turn = Rotation.from_euler("z", angle)
        orientation = (turn * Rotation.from_quat(upright, scalar_first=True)).as_quat(scalar_first=True)
        velocity = turn.apply((0.1, 0.05, 0.0))
        system.place(ball, position=(0.0, 0.0, 2.0 * RADIUS), orientation=tuple(orientation), velocity=tuple(velocity))
        solution = ns.simulate(system, 0.06, sample_interval=0.06, engine=TIGHT)
        assert solution.energy.residual < 1e-8
        assert np.any(solution.events.impulse[:, 0, 0] > 0.0)
        ends.append(np.concatenate([turn.inv().apply(solution.q_end[:3]), turn.inv().apply(solution.u_end[:3])]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-9)


def _ball_up_a_slope(law: Directional, slope: float, speed: float, t_end: float) -> ns.Solution:
    """Run a ball that slides up a slope without spin; most steps as of a motion without a creep in time."""
    plate, ball = Plate(Rest(slope=slope)), Ball(RADIUS)
    system = ns.System([plate, ball], G)
    system.contact(plate, ball, **_rigid(law))
    normal = np.array([math.sin(slope), 0.0, math.cos(slope)])
    up = np.array([-math.cos(slope), 0.0, math.sin(slope)])
    system.place(ball, position=tuple(RADIUS * normal), velocity=tuple(speed * up))
    return ns.assemble(system).run(t_end, most_steps=4000)


@pytest.mark.parametrize("angle", [0.3, 0.7])
def test_a_slip_stops_where_friction_the_other_way_is_strong(angle: float) -> None:
    """Strong friction stops a slip in finite time, and then holds the contact: the ball rolls from that event on.

    Its slip obeys v' = g_t + 7/2 T(v) / m until it stops, off both axes of the law.
    """
    slope, speed, t_end = 0.3, 0.3, 0.12
    law = Directional(1.0, 0.01, 0.8, axis=(math.cos(angle), math.sin(angle), 0.0), body="first")
    solution = _ball_up_a_slope(law, slope, speed, t_end)
    assert solution.status == "done"
    # x of the plate is down the slope
    pull, load = np.array([G * math.sin(slope), 0.0]), 3.5 * G * math.cos(slope)

    def slow(t: float, v: np.ndarray) -> float:
        return float(np.linalg.norm(v)) - 1e-5

    slow.terminal = True  # type: ignore[attr-defined]
    start = np.array([-speed, 0.0])
    path = solve_ivp(
        lambda t, v: pull + load * _along(law, v, angle),
        (0.0, t_end),
        start,
        "LSODA",
        events=slow,
        rtol=1e-9,
        atol=1e-12,
    )
    stops = solution.events.time[solution.events.cause == Cause.SLIP_TO_STICK]
    assert stops == pytest.approx([path.t_events[0][0]], abs=1e-5)
    assert solution.history("mode")["mode"][-1] == [Mode.STICK]


@pytest.mark.parametrize("excess", [-1e-6, 1e-6])
@pytest.mark.parametrize(("heading", "mu"), [(0.0, 0.2), (math.pi, 0.4), (0.5 * math.pi, 0.3)])
def test_breakaway_by_direction(heading: float, mu: float, excess: float) -> None:
    """A block holds on a slope iff tan(angle) is at most the coefficient of friction against its way down."""
    law = Directional(0.2, 0.4, 0.3)
    solution = _block(_rigid(law), 0.02, slope=math.atan(mu) + excess, heading=heading)
    if excess < 0.0:
        np.testing.assert_allclose(solution.u_end, 0.0, rtol=0, atol=1e-12)
    else:
        assert np.linalg.norm(solution.u_end[:3]) > 1e-7


def test_slip_starts_normal_to_the_bound() -> None:
    """A block pulled off the axes starts to slip where the ellipse has its normal, not where it is pulled."""
    law, slope, heading = Anisotropic(0.1, 0.4), math.atan(0.35), 0.7
    solution = _block(_rigid(law), 1e-3, slope=slope, heading=heading)
    down = np.array([math.cos(slope), 0.0, -math.sin(slope)])
    velocity = np.array([solution.u_end[:3] @ down, solution.u_end[1]])
    pull = G * math.sin(slope) * np.array([1.0, 0.0])

    def unbalanced(angle: float) -> float:
        d = np.array([math.cos(angle), math.sin(angle)])
        a = pull + G * math.cos(slope) * _along(law, d, heading)
        return float(a[0] * d[1] - a[1] * d[0])

    angle = brentq(unbalanced, 0.0, heading)
    assert math.atan2(velocity[1], velocity[0]) == pytest.approx(angle, abs=1e-6)
    assert angle > 0.1


def _pull(t: float, a: Any, b: Any, out: Any, rate: float, stiffness: float, damping: float) -> None:
    """Pull a block at its feet with a growing force, against a spring and a damper."""
    for i in range(9):
        out[i] = 0.0
    out[0] = rate * t - stiffness * b[0] - damping * b[12]
    out[3], out[4], out[5] = b[0], b[1], b[2] - HEIGHT


def _load(rate: float = 0.0, stiffness: float = 0.0, damping: float = 0.0) -> FunctionLoad:
    return FunctionLoad(_pull, {"rate": rate, "stiffness": stiffness, "damping": damping})


@pytest.mark.parametrize("rate", [0.5, 5.0])
def test_friction_grows_with_the_time_of_rest(rate: float) -> None:
    """A block pulled with c t breaks away where c t = m g (mu_0 + b ln(1 + v_0 t / L))."""
    law = RateAndState(0.2, 0.01, 0.02, 1e-3, 1e-4)
    expected = brentq(lambda t: rate * t - G * (0.2 + 0.02 * math.log1p(10.0 * t)), 1e-3, 100.0)
    events = _block(_rigid(law), 1.02 * expected, load=_load(rate)).events
    assert events.time[events.cause == Cause.STICK_TO_SLIP][0] == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("speed", [1e-3, 0.1])
def test_steady_slip_by_rate_and_state(speed: float) -> None:
    """Held by a spring on a moving plate a block comes to m g (mu_0 + a ln(1 + v / v_0) + b ln(1 + v_0 / v))."""
    law = RateAndState(0.2, 0.02, 0.01, 1e-3, 1e-4)
    solution = _block(
        _rigid(law), 6.0, load=_load(stiffness=1e3, damping=60.0), motion=ConstantVelocity((speed, 0.0, 0.0))
    )
    expected = G * (0.2 + 0.02 * math.log1p(speed / 1e-3) + 0.01 * math.log1p(1e-3 / speed))
    assert 1e3 * solution.q_end[0] == pytest.approx(expected, rel=1e-6)
    assert np.linalg.norm(solution.u_end) < 1e-8


def test_bristles_bend_before_they_slip() -> None:
    """A small pull moves a block as if bristles were springs that yield; a large one lets it slip with mu N."""
    law = Bristle(0.3, 0.3, stiffness=1e4, damping=20.0)
    calm = {"normal": LinearCompliant(1e6, 1e3), "friction": law}
    start, end = (_block(calm, t, load=_load(1.0)).q_end[0] for t in (0.2, 0.4))
    # z = F / (N s_0) and dx = dz / (1 - z / z_max)
    bent, most = 1.0 / (G * 1e4), 0.3 / 1e4
    expected = most * math.log((1.0 - 0.2 * bent / most) / (1.0 - 0.4 * bent / most))
    assert end - start == pytest.approx(expected, rel=2e-3)
    solution = _block(_soft(law), 1.5, load=_load(4.0))
    # past the bound the speed grows by (c t - mu g)
    begin = 0.3 * G / 4.0
    assert solution.u_end[0] == pytest.approx(2.0 * (1.5 - begin) ** 2, rel=2e-3)


def test_bristles_in_steady_slip() -> None:
    """The coefficient falls from mu_s to mu by the square of the speed."""
    with pytest.warns(UnusualValue, match="more energy than they stored"):
        law = Bristle(0.2, 0.3, stribeck_speed=0.05, stiffness=1e4, damping=50.0)
    for speed in (0.03, 0.2):
        motion = ConstantVelocity((speed, 0.0, 0.0))
        solution = _block(_soft(law), 3.0, load=_load(stiffness=1e3, damping=60.0), motion=motion)
        expected = G * (0.2 + 0.1 * math.exp(-((speed / 0.05) ** 2)))
        assert 1e3 * solution.q_end[0] == pytest.approx(expected, rel=1e-6)


def test_drilling_ends_after_its_time() -> None:
    """A ball that spins in place stops after I w / (mu N c), its bristles bent by next to nothing."""
    mu, radius, spin = 0.3, 2e-4, 10.0
    law = CoulombContensou(mu, radius, presliding=1e-8)
    rate = mu * MASS * G * radius / (0.4 * MASS * RADIUS**2)
    for part in (0.5, 0.9):
        solution = _ball(_soft(law), part * spin / rate, (0.0, 0.0, 0.0), (0.0, 0.0, spin))
        assert solution.u_end[5] == pytest.approx((1.0 - part) * spin, rel=1e-4)
    assert abs(_ball(_soft(law), 1.1 * spin / rate, (0.0, 0.0, 0.0), (0.0, 0.0, spin)).u_end[5]) < 1e-2


def test_rolling_ends_after_its_way() -> None:
    """A rolling ball slows down with 5 rho g / (7 R) and stops."""
    length, speed = 1e-4, 0.1
    law = CoulombContensou(0.3, rolling_length=length, prerolling=1e-5, relaxation=1e-4)
    slowing = 5.0 * length * G / (7.0 * RADIUS)
    half = _ball(_soft(law), 0.5 * speed / slowing, (speed, 0.0, 0.0), (0.0, speed / RADIUS, 0.0))
    assert half.u_end[0] == pytest.approx(0.5 * speed, rel=1e-3)
    end = _ball(_soft(law), 1.2 * speed / slowing, (speed, 0.0, 0.0), (0.0, speed / RADIUS, 0.0))
    assert end.q_end[0] == pytest.approx(0.5 * speed**2 / slowing, rel=1e-3)
    assert abs(end.u_end[0]) < 1e-4


def test_what_drills_slips_easily() -> None:
    """Slip and drilling of a ball share one bound, with w^2 = v^2 + (c w3)^2."""
    mu, radius = 0.2, 2e-3
    law = CoulombContensou(mu, radius, presliding=1e-8)

    def slope(t: float, y: Any) -> list[float]:
        w = math.hypot(y[0], radius * y[1])
        return [-3.5 * mu * G * y[0] / w, -2.5 * mu * G * (radius / RADIUS) ** 2 * y[1] / w]

    t_end = 0.02
    slip, spin = solve_ivp(slope, (0.0, t_end), (0.2, 100.0), "DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
    solution = _ball(_soft(law), t_end, (0.2, 0.0, 0.0), (0.0, 0.0, 100.0))
    np.testing.assert_allclose(_slip(solution), [slip, 0.0, spin], rtol=1e-4, atol=1e-9)
    # without drilling the slip would have lost more
    assert 3.5 * mu * G * t_end > 0.2 - slip


def test_traction_needs_a_compliant_normal_law() -> None:
    """The message says what to do."""
    plate, ball = Plate(), Ball(RADIUS)
    system = ns.System([plate, ball])
    with pytest.raises(ns.InvalidInput, match="needs a compliant normal law for Bristle"):
        system.contact(plate, ball, **_rigid(Bristle(0.2, 0.3)))
    with pytest.raises(ns.InvalidInput, match="takes no impact law beside the compliant HuntCrossley"):
        system.contact(plate, ball, **_soft(Bristle(0.2, 0.3)), impact=EnergeticImpact(0.5))


def test_three_compliant_feet_do_not_share_static_friction(build: Any) -> None:
    """Refused before anything runs, but for two feet, and for bristles."""
    friction = build.laws()["friction"]
    with pytest.raises(ns.InvalidInput, match="at most 2 compliant contacts"):
        _block(_soft(friction), 1e-3)
    assert _block(_soft(Bristle(0.2, 0.3)), 1e-3).status == "done"
