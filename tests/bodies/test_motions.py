"""Motions: derivatives of one another, placed frames, tables and functions, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    ConstantVelocity,
    DrivenBody,
    FunctionMotion,
    Harmonic,
    Plane,
    Plate,
    Rest,
    Sphere,
    Table,
)
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Motion
from nonsmooth.model.assembly import lay_out

OMEGA = 2.0 * math.pi * 25.0
TURNED = (math.cos(0.4), 0.6 * math.sin(0.4), 0.0, 0.8 * math.sin(0.4))
WALL = (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)


def _position(t: float) -> tuple[float, float, float]:
    return 0.1 * t, 0.02, 1e-3 * math.sin(OMEGA * t)


def _velocity(t: float) -> tuple[float, float, float]:
    return 0.1, 0.0, 1e-3 * OMEGA * math.cos(OMEGA * t)


def _acceleration(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, -1e-3 * OMEGA * OMEGA * math.sin(OMEGA * t)


def _orientation(t: float) -> tuple[float, float, float, float]:
    half = 0.1 * math.sin(OMEGA * t)
    return math.cos(half), 0.0, 0.6 * math.sin(half), 0.8 * math.sin(half)


def _spin(t: float) -> tuple[float, float, float]:
    rate = 0.2 * OMEGA * math.cos(OMEGA * t)
    return 0.0, 0.6 * rate, 0.8 * rate


def _spin_rate(t: float) -> tuple[float, float, float]:
    rate = -0.2 * OMEGA * OMEGA * math.sin(OMEGA * t)
    return 0.0, 0.6 * rate, 0.8 * rate


def _zero(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0


def _function(**changed: Any) -> FunctionMotion:
    given: dict[str, Any] = {
        "position": _position,
        "velocity": _velocity,
        "acceleration": _acceleration,
        "duration": 0.2,
        "shortest_change": 0.04,
    }
    return FunctionMotion(**{**given, **changed})


def _turning(**changed: Any) -> FunctionMotion:
    turn = {"orientation": _orientation, "angular_velocity": _spin, "angular_acceleration": _spin_rate}
    return _function(**{**turn, **changed})


def _rows(n: int) -> tuple[Any, Any]:
    """Return one period of a vibration, n intervals of unequal length."""
    even = np.arange(n + 1) / n
    times = 0.04 * (even + 0.05 * np.sin(2.0 * math.pi * even) / (2.0 * math.pi))
    rows = np.stack([0.0 * times, 5e-4 * np.cos(OMEGA * times), 1e-3 * np.sin(OMEGA * times)], axis=1)
    rows[-1] = rows[0]
    return times.tolist(), rows.tolist()


MOTIONS: dict[str, Motion] = {
    "rest": Rest(0.3, (1.0, 2.0, 3.0), TURNED),
    "harmonic": Harmonic(amplitude=1e-3, frequency=25.0, phase=0.4, axis_x=0.6, axis_z=0.8),
    "belt": ConstantVelocity((0.3, 0.0, -0.1), position=(0.1, 0.2, 0.3), orientation=TURNED),
    "turntable": ConstantVelocity(rate=3.0, position=(0.1, 0.2, 0.3)),
    "arm": ConstantVelocity((0.1, 0.2, 0.3), 7.0, (0.6, 0.0, -0.8), (0.4, 0.1, 0.2), TURNED, (-0.3, 0.2, 0.5)),
    "table": Table([0.0, 0.05, 0.09, 0.2, 0.3], np.cos(np.arange(15.0)).reshape(5, 3).tolist(), orientation=WALL),
    "periodic": Table(*_rows(24), periodic=True),
    "function": _function(),
    "turning": _turning(),
}


class _Frame:
    """The frame of a motion as the engine sees it."""

    def __init__(self, motion: Motion) -> None:
        self.model = lay_out(ns.System([DrivenBody(motion, (Sphere(1.0),))]), EventDriven())
        self.out = int(self.model.memory[owners.BodyRecord.out][:1][0])

    def __call__(self, t: float) -> Any:
        self.model.memory[owners.Island.time] = t
        call_entry("evaluate_at", self.model.memory)
        return self.model.memory.floats[self.out : self.out + 24].copy()


_frames: dict[str, _Frame] = {}


def _frame(name: str) -> _Frame:
    if name not in _frames:
        _frames[name] = _Frame(MOTIONS[name])
    return _frames[name]


def _slope(f: Any, t: float, h: float) -> Any:
    return (f(t - 2 * h) - 8.0 * f(t - h) + 8.0 * f(t + h) - f(t + 2 * h)) / (12.0 * h)


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("name", MOTIONS)
@settings(max_examples=15)
@given(t=st.floats(0.0, 0.5))
def test_velocity_and_acceleration_are_derivatives(name: str, t: float) -> None:
    """Of position and rotation, by differences; and the rotation is one."""
    frame = _frame(name)
    now, slope = frame(t), _slope(frame, t, 2e-5)
    size = 1.0 + np.max(np.abs(now))
    # a spline of third order has a difference of second at its knots only
    close = {"rtol": 0, "atol": (5e-4 if isinstance(MOTIONS[name], Table) else 1e-6) * size}
    np.testing.assert_allclose(now[12:15], slope[:3], **close)
    np.testing.assert_allclose(now[18:21], slope[12:15], **{**close, "atol": 20.0 * close["atol"]})
    np.testing.assert_allclose(now[21:24], slope[15:18], **close)
    axes = now[3:12].reshape(3, 3)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), rtol=0, atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    turning = slope[3:12].reshape(3, 3) @ axes.T
    np.testing.assert_allclose([turning[2, 1], turning[0, 2], turning[1, 0]], now[15:18], **close)


def _matrix(quaternion: Any) -> Any:
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def test_a_frame_stands_where_it_is_put() -> None:
    """Position and orientation of the motions at rest and at constant velocity; the wall's normal is horizontal."""
    slope = Rotation.from_rotvec([0.0, 0.3, 0.0]).as_matrix()
    rest = _frame("rest")(0.7)
    np.testing.assert_allclose(rest[:3], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(rest[3:12].reshape(3, 3), _matrix(TURNED) @ slope, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(rest[12:], 0.0)
    wall = _Frame(Rest(orientation=WALL))(0.0)
    np.testing.assert_allclose(wall[3:12].reshape(3, 3)[:, 2], [1.0, 0.0, 0.0], rtol=0, atol=1e-15)
    for name in ("belt", "arm"):
        motion: Any = MOTIONS[name]
        start = _frame(name)(0.0)
        np.testing.assert_allclose(start[:3], motion.position, rtol=0, atol=1e-15)
        np.testing.assert_allclose(start[3:12].reshape(3, 3), _matrix(TURNED), rtol=0, atol=1e-15)


def test_constant_velocity_turns_about_its_centre() -> None:
    """The distance from the moving axis stays, the belt only travels, and a turn comes round."""
    motion: Any = MOTIONS["arm"]
    frame, t = _frame("arm"), 0.37
    now = frame(t)
    turn = Rotation.from_rotvec(7.0 * t * np.array(motion.axis)).as_matrix()
    centre = np.array(motion.centre)
    place = centre + np.array(motion.velocity) * t + turn @ (np.array(motion.position) - centre)
    np.testing.assert_allclose(now[:3], place, rtol=0, atol=1e-14)
    np.testing.assert_allclose(now[3:12].reshape(3, 3), turn @ _matrix(TURNED), rtol=0, atol=1e-14)
    np.testing.assert_allclose(_frame("belt")(2.0)[:3], [0.7, 0.2, 0.1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(_frame("turntable")(2.0)[12:15], 0.0, rtol=0, atol=1e-15)
    assert motion.time_scale == pytest.approx(2.0 * math.pi / 7.0)
    assert MOTIONS["belt"].time_scale == math.inf


@pytest.mark.slow
@pytest.mark.parametrize("name", ["table", "periodic"])
def test_a_table_passes_through_its_rows(name: str) -> None:
    """At the rows the positions given, and no step in position, velocity or acceleration, ends and repeats included."""
    table: Any = MOTIONS[name]
    frame = _frame(name)
    times, rows = np.array(table.times), np.array(table.positions)
    for shift in (0.0, 3.0 * 0.04) if table.periodic else (0.0,):
        for t, row in zip(times + shift, rows, strict=True):
            np.testing.assert_allclose(frame(t)[:3], row, rtol=0, atol=1e-12)
            before, after = frame(t - 1e-9), frame(t + 1e-9)
            for part, speed in ((slice(0, 3), 1e2), (slice(12, 15), 1e4), (slice(18, 21), 1e7)):
                np.testing.assert_allclose(after[part], before[part], rtol=0, atol=2e-9 * speed)
    if not table.periodic:
        end, later = frame(times[-1]), frame(times[-1] + 2.0)
        np.testing.assert_allclose(later[:3], end[:3] + 2.0 * end[12:15], rtol=1e-12)
        np.testing.assert_allclose(end[18:21], 0.0, rtol=0, atol=1e-9)


def test_a_table_converges_to_the_motion_it_samples() -> None:
    """Fourth order in the distance of the rows; its time scale is the period."""
    errors = []
    for n in (16, 32, 64):
        table = Table(*_rows(n), periodic=True)
        frame = _Frame(table)
        errors.append(max(abs(frame(t)[2] - 1e-3 * math.sin(OMEGA * t)) for t in np.linspace(0.0, 0.1, 300)))
        assert table.time_scale == pytest.approx(0.04, rel=0.15)
    assert errors[0] / errors[1] > 12.0
    assert errors[1] / errors[2] > 12.0
    assert Table([0.0, 1.0, 3.0], [[0, 0, 0], [1, 0, 0], [3, 0, 0]]).time_scale == math.inf


def _bounce(build: Any, motion: Motion) -> Any:
    ball = Ball(5e-3)
    system = build.over(ball, motion, friction=0.2, restitution=0.6)
    ns.touching(system, ball)
    return ns.simulate(system, 0.3, engine=ns.EventDriven(tolerance=1e-10))


def test_the_same_motion_said_in_three_ways(build: Any) -> None:
    """A ball tossed by a vibrating plate: as Harmonic, as functions, and nearly so as a table."""

    def position(t: float) -> tuple[float, float, float]:
        return 0.0, 0.0, 1e-3 * math.sin(OMEGA * t)

    def velocity(t: float) -> tuple[float, float, float]:
        return 0.0, 0.0, 1e-3 * OMEGA * math.cos(OMEGA * t)

    harmonic = _bounce(build, Harmonic(amplitude=1e-3, frequency=25.0))
    functions = _bounce(build, FunctionMotion(position, velocity, _acceleration, 0.3, 0.04))
    times = np.linspace(0.0, 0.04, 161)
    rows = [[0.0, 0.0, 1e-3 * math.sin(OMEGA * t)] for t in times]
    table = _bounce(build, Table(times.tolist(), [*rows[:-1], rows[0]], periodic=True))
    assert len(harmonic.events.time) > 4
    np.testing.assert_allclose(functions.q_end, harmonic.q_end, rtol=0, atol=1e-9)
    np.testing.assert_allclose(table.q_end, harmonic.q_end, rtol=0, atol=1e-5)
    for solution in (harmonic, functions, table):
        assert solution.energy.residual <= 1e-6


def test_a_belt_takes_a_ball_along(build: Any) -> None:
    """Set down at rest on a belt at v, a ball slips until it rolls at 2/7 of the belt's speed."""
    ball, friction, speed = Ball(0.01), 0.2, 0.5
    system = build.over(ball, ConstantVelocity((speed, 0.0, 0.0)), friction=friction)
    ns.touching(system, ball)
    solution = ns.simulate(system, 0.2)
    assert solution.u_end[0] == pytest.approx(2.0 / 7.0 * speed, abs=1e-9)
    assert solution.events.time[-1] == pytest.approx(2.0 / 7.0 * speed / (friction * 9.81), abs=1e-9)


def test_a_driven_body_carries_any_shapes(build: Any) -> None:
    """A ball balanced on a vibrating sphere follows it, and one thrown against a wall that comes leaves it faster."""
    ball, post = Ball(0.01), DrivenBody(Harmonic(amplitude=1e-3, frequency=5.0), (Sphere(0.05), Sphere(0.01, x=1.0)))
    system = ns.System([post, ball])
    assert len(system.contact(post, ball, **build.laws())) == 2
    ns.resting(system, ball, position=(0.0, 0.0, 1.0))
    solution = ns.simulate(system, 0.15)
    assert solution.q_end[2] == pytest.approx(0.06 + 1e-3 * math.sin(2.0 * math.pi * 5.0 * 0.15), abs=1e-9)
    wall = DrivenBody(ConstantVelocity((0.2, 0.0, 0.0), orientation=WALL), (Plane(),))
    system = ns.System([wall, ball], gravity=0.0)
    system.contact(wall, ball, **build.laws(restitution=0.5, friction=0.0))
    system.place(ball, position=(0.11, 0.0, 0.0), velocity=(-0.3, 0.0, 0.0))
    solution = ns.simulate(system, 0.4)
    impacts = solution.events.time[solution.events.cause == Cause.IMPACT]
    assert impacts == pytest.approx([0.2], abs=1e-12)
    assert solution.u_end[0] == pytest.approx(0.2 + 0.5 * 0.5, abs=1e-9)


def _jumping(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0 if t < 0.0711 else 1e-3


def _kinked_velocity(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, max(t - 0.0711, 0.0)


def _kinked(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.5 * max(t - 0.0711, 0.0) ** 2


def _step(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 1.0 if t > 0.0711 else 0.0


def _two(t: float) -> Any:
    return 0.0, 0.0


def _list(t: float) -> Any:
    return [0.0, 0.0, 0.0]


def _hole(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, math.nan if t > 0.15 else 0.0


def _raises(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, math.sqrt(0.1 - t)


def _long(t: float) -> tuple[float, float, float, float]:
    return 1.0, t, 0.0, 0.0


ROWS = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0]]
BAD: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (Rest, {"position": (0.0, 0.0)}, ("Rest.position", "3 finite numbers", "[m]")),
    (Rest, {"orientation": (1.0, 1.0, 0.0, 0.0)}, ("Rest.orientation", "unit quaternion", "1.41421")),
    (ConstantVelocity, {"velocity": 1.0}, ("ConstantVelocity.velocity", "3 finite numbers", "[m/s]")),
    (ConstantVelocity, {"rate": math.inf}, ("ConstantVelocity.rate", "finite", "rad/s")),
    (ConstantVelocity, {"axis": (0.0, 0.0, 0.0)}, ("ConstantVelocity.axis", "have a direction", "not zero")),
    (ConstantVelocity, {"centre": ("a", "b", "c")}, ("ConstantVelocity.centre", "3 finite numbers")),
    (DrivenBody, {"carried": (Rest(),)}, ("DrivenBody.carried", "shapes only")),
    (DrivenBody, {"motion": 3.0, "carried": (Plane(),)}, ("DrivenBody.motion", "must be a Motion", "3.0")),
    (Table, {"times": [0, 1, 1, 2], "positions": ROWS}, ("Table.times[2]", "above 1", "1.0")),
    (Table, {"times": [0, 2, 1, 3], "positions": ROWS}, ("Table.times[2]", "above 2", "Sort")),
    (Table, {"times": [0, 1, 2], "positions": ROWS}, ("Table", "as many times as positions", "(3, 4)")),
    (Table, {"times": [0], "positions": ROWS[:1]}, ("Table", "at least 2", "(1, 1)")),
    (Table, {"times": [0, 1], "positions": ROWS[:1] * 2, "periodic": True}, ("Table", "at least 3", "(2, 2)")),
    (Table, {"times": 3.0, "positions": ROWS}, ("Table.times", "shape (n)", "()")),
    (Table, {"times": [0, 1, 2, 3], "positions": [0, 1, 2, 3]}, ("Table.positions", "shape (n, 3)", "(4,)")),
    (Table, {"times": [0, 1, 2, 3], "positions": [[0, 0]] * 4}, ("Table.positions", "shape (n, 3)", "(4, 2)")),
    (Table, {"times": [0, 1, math.nan, 3], "positions": ROWS}, ("Table.times[2]", "finite", "nan")),
    (Table, {"times": [0, 1, 2, 3], "positions": [*ROWS[:3], [0, math.inf, 0]]}, ("Table.positions[3]", "finite")),
    (Table, {"times": [0, 1, 1 + 1e-9, 2], "positions": ROWS}, ("Table.positions[2]", "jump", "1e-09")),
    (Table, {"times": [0, 1, 2], "positions": ROWS[:3], "periodic": True}, ("Table.positions[-1]", "first", "0.5")),
    (Table, {"times": [0, 1, 2, 3], "positions": ROWS, "orientation": (2, 0, 0, 0)}, ("Table.orientation", "unit")),
    (_function, {"duration": 0.0}, ("FunctionMotion.duration", "> 0")),
    (_function, {"shortest_change": -1.0}, ("FunctionMotion.shortest_change", "> 0")),
    (_function, {"position": 3.0}, ("FunctionMotion.position", "plain function of time", "3.0")),
    (_function, {"position": _two}, ("FunctionMotion.position (_two)", "tuple of 3 numbers", "(0.0, 0.0)", "return")),
    (_function, {"velocity": _list}, ("FunctionMotion.velocity (_list)", "tuple of 3 numbers", "[0.0, 0.0, 0.0]")),
    (_function, {"acceleration": _hole}, ("FunctionMotion.acceleration (_hole)", "finite", "nan", "t = 0.15")),
    (_function, {"position": _raises}, ("FunctionMotion.position (_raises)", "must return at t = 0.1", "domain")),
    (_function, {"velocity": _zero}, ("FunctionMotion.velocity (_zero)", "derivative of", "(_position)")),
    (_function, {"acceleration": _velocity}, ("FunctionMotion.acceleration (_velocity)", "derivative of")),
    (
        _function,
        {"position": _jumping, "velocity": _zero, "acceleration": _zero},
        ("FunctionMotion.position (_jumping)", "must not jump at t = 0.0711", "0.001"),
    ),
    (
        _function,
        {"position": _kinked, "velocity": _kinked_velocity, "acceleration": _step},
        ("FunctionMotion.acceleration (_step)", "must not jump at t = 0.0711"),
    ),
    (_function, {"orientation": _orientation}, ("FunctionMotion.angular_velocity", "with the other two", "None")),
    (_turning, {"orientation": _long}, ("FunctionMotion.orientation (_long)", "unit quaternion", "t = ")),
    (_turning, {"orientation": _position}, ("FunctionMotion.orientation (_position)", "tuple of 4")),
    (_turning, {"angular_velocity": _zero}, ("FunctionMotion.angular_velocity (_zero)", "derivative of")),
    (_turning, {"angular_acceleration": _zero}, ("FunctionMotion.angular_acceleration (_zero)", "derivative of")),
]


@pytest.mark.parametrize(("kind", "arguments", "words"), BAD)
def test_bad_motions(kind: Any, arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the thing, the rule and the value, before anything runs."""
    with pytest.raises(ns.InvalidInput) as caught:
        kind(**arguments)
    for word in words:
        assert word in str(caught.value)


def test_what_starts_gently_is_no_jump() -> None:
    """A power of time whose acceleration vanishes at one instant has no corner there."""

    def position(t: float) -> tuple[float, float, float]:
        return 0.0, 0.0, (t - 0.1) ** 4

    def velocity(t: float) -> tuple[float, float, float]:
        return 0.0, 0.0, 4.0 * (t - 0.1) ** 3

    def acceleration(t: float) -> tuple[float, float, float]:
        return 0.0, 0.0, 12.0 * (t - 0.1) ** 2

    FunctionMotion(position, velocity, acceleration, 0.2, 0.2)


def test_a_driven_body_cannot_be_placed() -> None:
    """The message says which."""
    with pytest.raises(ns.InvalidInput, match="start of a DrivenBody"):
        DrivenBody(Rest(), (Plane(),)).state(position=(0, 0, 1))
    with pytest.raises(ns.InvalidInput, match="start of a Plate"):
        Plate().state(position=(0, 0, 1))
