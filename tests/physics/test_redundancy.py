"""Blocks on more feet than they need: forces are not unique, the motion is, for any number and order of feet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import brentq

import nonsmooth as ns
from bodies import ConstantVelocity, Harmonic, Plate, Rest, RigidBody, Sphere
from laws import Coulomb
from nonsmooth import ContactResult
from nonsmooth.engine.memory.modes import Cause
from tests.physics.moved_systems import quaternion

G = 9.81
TIGHT = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)
HALF_X, HALF_Y, HEIGHT, FOOT = 0.08, 0.05, 0.02, 0.005
CORNERS = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
FEET: dict[int, Any] = {
    3: ((1.0, 1.0), (-1.0, 0.0), (1.0, -1.0)),
    4: CORNERS,
    5: (*CORNERS, (0.0, 0.0)),
    8: (*CORNERS, (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)),
}


def _block(feet: Sequence[tuple[float, float]]) -> RigidBody:
    """Return a block of 1 kg, its mass centre HEIGHT over the lowest points of its feet."""
    carried = tuple(Sphere(FOOT, HALF_X * x, HALF_Y * y, FOOT - HEIGHT) for x, y in feet)
    return RigidBody(1.0, (2e-3, 3e-3, 4e-3), carried)


def _run(
    build: Any, feet: Any, t_end: float, *, angle: float = 0.0, over: float = 0.0, start: Any = None, **laws: Any
) -> ns.Solution:
    """Run a block on a slope; velocities of the start are along the fall line, across it and off the plate."""
    block, plate = _block(feet), Plate(Rest(slope=angle))
    system = ns.System([plate, block], G)
    system.contact(plate, block, **build.laws(**laws))
    words = {"orientation": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0, 0.0, 0.0)} | (start or {})
    axes = np.array([[math.cos(angle), 0.0, -math.sin(angle)], [0, 1, 0], [math.sin(angle), 0.0, math.cos(angle)]])
    s, x, y, z = words["orientation"]
    c, d = math.cos(0.5 * angle), math.sin(0.5 * angle)
    words["orientation"] = (c * s - d * y, c * x + d * z, c * y + d * s, c * z - d * x)
    words["velocity"] = np.asarray(words["velocity"]) @ axes
    system.place(block, position=(HEIGHT + over) * axes[2], **words)
    return ns.simulate(system, t_end, sample_interval=t_end, engine=TIGHT)


def _end(solution: ns.Solution) -> NDArray[np.float64]:
    return np.concatenate([solution.q_end, solution.u_end])


def _instant(feet: Sequence[tuple[float, float]], angle: float, slip: tuple[float, float], mu: float) -> ContactResult:
    """Solve for the forces on a block of 1 kg on a slope, in its axes: down the slope, across, off the plate."""
    n = len(feet)
    normal, tangential = np.zeros((6, n)), np.zeros((6, n, 2))
    for i, (x, y) in enumerate(feet):
        arm = np.array([HALF_X * x, HALF_Y * y, -HEIGHT])
        for column, direction in ((normal[:, i], 2), (tangential[:, i, 0], 0), (tangential[:, i, 1], 1)):
            column[direction], column[3:] = 1.0, np.cross(arm, np.eye(3)[direction])
    weight = G * np.array([math.sin(angle), 0.0, -math.cos(angle), 0.0, 0.0, 0.0])
    mass = np.diag([1.0, 1.0, 1.0, 2e-3, 3e-3, 4e-3])
    return ns.solve_contact(mass, normal, tangential, weight, [Coulomb(mu)] * n, slip=np.tile(slip, (n, 1)))


@pytest.mark.parametrize("count", FEET)
@pytest.mark.parametrize("slip", [(0.0, 0.0), (0.3, 0.4)])
@pytest.mark.parametrize("angle", [0.2, 0.5])
def test_the_motion_is_unique_and_the_forces_are_not(count: int, slip: tuple[float, float], angle: float) -> None:
    """One acceleration and one sum of forces for every number of feet; what the forces may change is counted."""
    mu = 0.3
    result = _instant(FEET[count], angle, slip, mu)
    pull, push = G * math.sin(angle), G * math.cos(angle)
    along = np.array([pull, 0.0, 0.0])
    if slip == (0.0, 0.0):
        along[0] = max(0.0, pull - mu * push)
    else:
        along[:2] -= mu * push * np.array(slip) / math.hypot(*slip)
    np.testing.assert_allclose(result.acceleration, [*along, 0.0, 0.0, 0.0], rtol=0, atol=1e-11)
    assert result.normal_force.sum() == pytest.approx(push, rel=1e-12)
    np.testing.assert_allclose(result.tangential_force.sum(axis=0), along[:2] - [pull, 0.0], rtol=0, atol=1e-11)
    sticks = slip == (0.0, 0.0) and along[0] == 0.0
    # three feet that slide share their load in one way; that stick, their friction in many
    assert result.forces_are_unique == (count == 3 and not sticks)
    assert len(result.null_space) == (3 * count - 6 if sticks else count - 3)
    order = np.random.default_rng(count).permutation(count)
    other = _instant([FEET[count][i] for i in order], angle, slip, mu)
    np.testing.assert_allclose(other.acceleration, result.acceleration, rtol=0, atol=1e-11)


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("count", FEET)
@pytest.mark.parametrize(("static", "heading"), [(0.3, 0.0), (0.3, 1.1), (0.7, -2.0)])
def test_breakaway_at_the_static_coefficient(build: Any, count: int, static: float, heading: float) -> None:
    """Bisection of the angle between rest, exact, and slip ends at tan(angle) = mu_s, to 1e-6."""
    start = {"orientation": quaternion((0.0, 0.0, 1.0), heading)}
    low, high = math.atan(static) - 0.1, math.atan(static) + 0.1
    while high - low > 1e-7:
        angle = 0.5 * (low + high)
        solution = _run(build, FEET[count], 0.01, angle=angle, start=start, friction=0.8 * static, static=static)
        speed = np.linalg.norm(solution.u_end[:3])
        pull = G * (math.sin(angle) - 0.8 * static * math.cos(angle))
        assert speed < 1e-14 or speed == pytest.approx(0.01 * pull, rel=1e-9)
        low, high = (low, angle) if speed > 1e-6 else (angle, high)
    assert abs(0.5 * (low + high) - math.atan(static)) < 1e-6


def _tilted(build: Any, count: int, rate: float, place: float, engine: ns.EventDriven) -> tuple[ns.Solution, float]:
    """Run a block on a plate that tilts at ``rate`` [rad/s] till 0.05 s after the expected breakaway, returned too."""
    static, side = 0.5, math.copysign(1.0, rate)

    def reserve(angle: float) -> float:
        return static * (G * math.cos(angle) - rate**2 * HEIGHT) - side * (G * math.sin(angle) + rate**2 * place)

    expected = brentq(reserve, 0.0, side * 1.2, xtol=1e-15) / rate
    plate, block = Plate(ConstantVelocity(rate=rate, axis=(0.0, 1.0, 0.0))), _block(FEET[count])
    system = ns.System([plate, block], G)
    system.contact(plate, block, **build.laws(friction=0.4, static=static))
    position, spin = np.array([place, 0.0, HEIGHT]), np.array([0.0, rate, 0.0])
    system.place(block, position=position, velocity=np.cross(spin, position), angular_velocity=spin)
    return ns.simulate(system, expected + 0.05, engine=engine), expected


TILTED = [(n, rate, x) for n in FEET for rate, x in ((0.5, 0.0), (0.5, 0.3), (-1.0, 0.3), (-1.0, -0.2))]


@pytest.mark.parametrize(("count", "rate", "place"), TILTED)
def test_breakaway_on_a_slope_that_tilts(build: Any, count: int, rate: float, place: float) -> None:
    """Where g sin + omega^2 x = mu_s (g cos - omega^2 h): the event is at that angle, and not before."""
    solution, expected = _tilted(build, count, rate, place, ns.EventDriven())
    # a foot that carries nothing may open and close again behind it: the motion does not know
    assert solution.events.cause[1] == Cause.STICK_TO_SLIP
    assert solution.events.time[1] == pytest.approx(expected, rel=0, abs=1e-10)
    end = _end(solution)
    assert np.linalg.norm(end[7:10] - np.cross((0.0, rate, 0.0), end[:3])) > 1e-3
    np.testing.assert_allclose(end, _end(_tilted(build, 3, rate, place, ns.EventDriven())[0]), rtol=0, atol=1e-10)


def test_breakaway_of_five_feet_within_rounding(build: Any) -> None:
    """Located to the last digit, it is not decided by rounding which foot slips: all do."""
    solution, expected = _tilted(build, 5, 0.5, 0.0, TIGHT)
    assert solution.events.time[1] == pytest.approx(expected, rel=0, abs=1e-10)


@pytest.mark.parametrize("count", [4, 5, 8])
def test_slide_to_rest_is_that_of_three_feet(build: Any, count: int) -> None:
    """Shot across a slope that holds it, it turns, stops and stays: 1e-10, and the forces differ."""
    shot = {"velocity": (0.1, 0.15, 0.0), "orientation": quaternion((0.0, 0.0, 1.0), 0.4)}
    runs = [_run(build, FEET[n], 0.3, angle=0.1, start=shot, friction=0.25, static=0.3) for n in (3, count)]
    assert [run.events.causes() for run in runs] == [["start", "slip to stick"]] * 2
    np.testing.assert_allclose(_end(runs[1]), _end(runs[0]), rtol=0, atol=1e-10)
    np.testing.assert_allclose(runs[1].events.time, runs[0].events.time, rtol=0, atol=1e-10)


@pytest.mark.parametrize("count", [4, 5, 8])
@pytest.mark.parametrize(("friction", "bounces"), [(0.0, 3), (0.3, 1)])
def test_flat_drop_is_shared_by_all_feet(build: Any, count: int, friction: float, bounces: int) -> None:
    """Every foot takes m v (1 + e) / n of each impact; the bounces are those of a single contact."""
    over, restitution = 0.01, 0.6
    speed = math.sqrt(2.0 * G * over)
    heights = restitution ** np.arange(bounces)
    times = speed / G * (1.0 + 2.0 * (np.cumsum(heights) - 1.0))
    solution = _run(build, FEET[count], times[-1] + 1e-3, over=over, restitution=restitution, friction=friction)
    impulses = solution.events.impulse[solution.events.cause == Cause.IMPACT]
    assert len(impulses) == bounces
    np.testing.assert_allclose(solution.events.time[1:], times, rtol=1e-10)
    for impulse, height in zip(impulses, heights, strict=True):
        share = speed * height * (1.0 + restitution) / count
        np.testing.assert_allclose(impulse[:, 0], share, rtol=1e-10)
        np.testing.assert_allclose(impulse[:, 1:], 0.0, atol=1e-10 * share)


@pytest.mark.parametrize("count", [4, 5, 8])
@pytest.mark.parametrize(
    ("angle", "over", "start"),
    [
        pytest.param(0.0, 0.0, {"velocity": (0.1, 0.1, 0.0), "angular_velocity": (0.0, 0.0, 5.0)}, id="spins to rest"),
        pytest.param(0.3, 0.0, {"velocity": (0.0, 0.1, 0.0), "angular_velocity": (0.0, 0.0, 5.0)}, id="slides on"),
        pytest.param(
            0.2,
            0.06,
            {
                "velocity": (0.1, 0.2, 0.0),
                "angular_velocity": (1.0, 2.0, 3.0),
                "orientation": quaternion((3, 4, 0), 0.4),
            },
            id="falls tilted",
        ),
    ],
)
@settings(max_examples=3)
@given(seed=st.integers(0, 10**6))
def test_order_of_the_feet_changes_nothing(
    build: Any, count: int, angle: float, over: float, start: Any, seed: int
) -> None:
    """To 1e-10, where the distribution of the forces decides how fast a spin ends, too."""
    shuffled = [FEET[count][i] for i in np.random.default_rng(seed).permutation(count)]
    runs = [
        _run(build, feet, 0.15, angle=angle, over=over, start=start, friction=0.25, static=0.3)
        for feet in (FEET[count], shuffled)
    ]
    assert len(runs[0].events) == len(runs[1].events)
    np.testing.assert_allclose(_end(runs[1]), _end(runs[0]), rtol=0, atol=1e-10)


@pytest.mark.parametrize("count", FEET)
@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_next_to_the_angle_of_friction_it_slides_as_in_closed_form(build: Any, count: int, heading: float) -> None:
    """Slip so slow that its direction is stiff, of forces that are not unique: g (sin - mu cos), or rest."""
    friction, seconds, start = 0.5, 0.2, {"orientation": quaternion((0.0, 0.0, 1.0), heading)}
    for excess in (1e-3, 1e-4, 1e-5, 1e-7, -1e-7):
        slope = math.atan(friction) + excess
        solution = _run(build, FEET[count], seconds, angle=slope, start=start, friction=friction)
        speed = seconds * max(0.0, G * (math.sin(slope) - friction * math.cos(slope)))
        along = np.array([math.cos(slope), 0.0, -math.sin(slope)])
        np.testing.assert_allclose(solution.u_end[:3], speed * along, rtol=0, atol=1e-6 * speed + 1e-12)
        assert solution.counters.steps < 100


@pytest.mark.parametrize("count", [4, 8])
def test_order_and_place_of_the_feet_change_no_force(build: Any, count: int) -> None:
    """Next to the bound, where the forces of least norm would leave their cones: to 1e-10 of the weight."""
    slope, start = math.atan(0.79), {"orientation": quaternion((0.0, 0.0, 1.0), 0.7)}
    found = []
    for order in (range(count), np.random.default_rng(count).permutation(count)):
        solution = _run(build, [FEET[count][i] for i in order], 0.01, angle=slope, start=start, friction=0.8)
        forces = solution.history("normal_force", "friction_force", times=0.005)
        lines = np.column_stack([forces["normal_force"], forces["friction_force"]])
        found.append(lines[np.argsort(order)])
        assert np.all(np.linalg.norm(lines[:, 1:], axis=1) < 0.8 * lines[:, 0])
    np.testing.assert_allclose(found[1], found[0], rtol=0, atol=1e-10 * G)


@pytest.mark.parametrize("count", [4, 5, 8])
def test_bounds_of_forces_that_are_chosen_end_few_steps(build: Any, count: int) -> None:
    """Shaken sideways up to 1 % below what friction holds, where one choice of forces is good for a short time only."""
    mu, omega, angle = 0.4, 20.0 * math.pi, 0.6
    amplitude = 0.99 * mu * G / omega**2
    along = np.array([math.cos(angle), math.sin(angle), 0.0])
    plate, block = Plate(Harmonic(amplitude, 10.0, axis_x=along[0], axis_y=along[1], axis_z=0.0)), _block(FEET[count])
    system = ns.System([plate, block], G)
    system.contact(plate, block, **build.laws(friction=mu))
    system.place(block, position=(0.0, 0.0, HEIGHT), velocity=amplitude * omega * along)
    solution = ns.simulate(system, 0.1)
    assert len(solution.events) == 1
    assert solution.counters.limits.get("event", 0) <= 2
