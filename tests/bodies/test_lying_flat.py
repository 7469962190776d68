"""Discs and cylinders that lie flat: on three feet, landing, sliding, spinning, tipping over their rim."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, ConeBody, CylinderBody, Disc, DiscBody, Plane, Plate, Rest
from bodies.shapes.frustum import LEAST_OF_DISC, USUAL
from laws import EnergeticImpact, Frictionless, LinearCompliant, NewtonImpact, Unilateral
from nonsmooth.engine.memory.blocks import GAP
from scenarios.rolling_disc import steady
from tests.bodies.carriers import Rig

Array = NDArray[np.float64]

GRAVITY = 9.81
LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(0.5)}
R = 0.05
DISC, CYLINDER, CONE = DiscBody(R, mass=0.2), CylinderBody(R, 0.02, mass=0.2), ConeBody(R, 0.06, mass=0.2)
LOW_DISC, LOW_CYLINDER = DiscBody(R, mass=0.2, foot_height=0.0), CylinderBody(R, 0.02, mass=0.2, foot_height=0.0)
"""Bodies on feet of the least height."""
STANDS = {DISC: USUAL * R, CYLINDER: 0.02, CONE: 0.015, LOW_DISC: LEAST_OF_DISC * R, LOW_CYLINDER: 0.02}
"""Height of the mass centre over the plane on which they lie flat."""
FLAT = pytest.mark.parametrize("body", [DISC, CYLINDER, CONE], ids=["disc", "cylinder", "cone"])
ALL = pytest.mark.parametrize("body", STANDS, ids=["disc", "cylinder", "cone", "low disc", "low cylinder"])


def _about(axis: tuple[float, float, float], angle: float) -> tuple[float, float, float, float]:
    x, y, z, w = Rotation.from_rotvec(angle * np.array(axis) / np.linalg.norm(axis)).as_quat().tolist()
    return w, x, y, z


def _lean(q: Array) -> Any:
    """Return the sine of the angle between the body's axis and the vertical."""
    a, b, c, d = q[..., 3], q[..., 4], q[..., 5], q[..., 6]
    return np.hypot(2.0 * (b * d + a * c), 2.0 * (c * d - a * b))


def _lies(solution: ns.Solution, body: Any) -> bool:
    """Whether a run ended with the body flat and at rest."""
    return (
        solution.status == "done"
        and abs(solution.q_end[2] - STANDS[body]) < 1e-11
        and float(_lean(solution.q_end)) < 1e-11
        and float(np.max(np.abs(solution.u_end))) < 1e-11
    )


@ALL
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_dropped_flat(build: Any, body: Any, restitution: float) -> None:
    """Three feet strike at once, bounce like a ball (rest after (1 + e) / (1 - e) of the fall), and then hold."""
    system = build.over(body, restitution=restitution, friction=0.3)
    drop = 0.01
    system.place(body, position=(0.0, 0.0, STANDS[body] + drop))
    solution = ns.simulate(system, 0.5)
    assert _lies(solution, body)
    fall = math.sqrt(2.0 * drop / GRAVITY)
    over = (1.0 + restitution) / (1.0 - restitution) * fall
    assert solution.events.time[-1] == pytest.approx(over, abs=1e-4)
    assert solution.energy.change == pytest.approx(-body.total_mass * GRAVITY * drop, rel=1e-9)
    assert solution.energy.residual < 1e-8


@FLAT
@pytest.mark.parametrize("tilt", [1e-3, 0.05, 0.3])
@pytest.mark.parametrize("restitution", [0.0, 0.6])
def test_landing_tilted_it_settles_flat(build: Any, body: Any, tilt: float, restitution: float) -> None:
    """Without a spin the rim strikes, then side strikes side, until nothing is left."""
    system = build.over(body, restitution=restitution, friction=0.3)
    system.place(body, position=(0.0, 0.0, 0.06), orientation=_about((1.0, 0.3, 0.0), tilt))
    solution = ns.simulate(system, 1.5)
    assert _lies(solution, body)
    assert solution.energy.residual < 1e-8
    fallen = body.total_mass * GRAVITY * (0.06 - STANDS[body])
    assert solution.energy.loss == pytest.approx(fallen, rel=1e-8)


@pytest.mark.fast_cases(1)
@FLAT
def test_newtons_law_settles_it_too(build: Any, body: Any) -> None:
    """An impact map meets three feet and a rim as well."""
    system = ns.System([Plate(), body])
    system.contact(*system.bodies, **(build.laws(friction=0.3) | {"impact": NewtonImpact(0.5)}))
    system.place(body, position=(0.0, 0.0, 0.06), orientation=_about((1.0, 0.3, 0.0), 0.1))
    solution = ns.simulate(system, 1.0)
    assert _lies(solution, body)


@ALL
def test_a_flat_spin_ends_as_under_an_even_pressure(build: Any, body: Any) -> None:
    """Friction takes mu m g 2 R / 3 of moment: the spin w of J = m R^2 / 2 ends after 3 R w / (4 mu g)."""
    friction, spin = 0.3, 20.0
    system = build.over(body, friction=friction)
    system.place(body, position=(0.0, 0.0, STANDS[body]), angular_velocity=(0.0, 0.0, spin))
    solution = ns.simulate(system, 0.5)
    assert _lies(solution, body)
    assert solution.events.causes() == ["start", "slip to stick"]
    moment = friction * body.total_mass * GRAVITY * 2.0 * R / 3.0
    assert solution.events.time[1] == pytest.approx(body.inertia[2] * spin / moment, abs=1e-8)
    if body is not CONE:
        assert solution.events.time[1] == pytest.approx(0.75 * R * spin / (friction * GRAVITY), abs=1e-8)


@pytest.mark.parametrize("excess", [-1e-3, -1e-9, 1e-3])
def test_on_a_slope_it_slides_past_the_angle_of_friction(build: Any, excess: float) -> None:
    """A flat disc stays or slides with g (sin - mu cos), on either side of tan = mu."""
    friction, body, seconds = 0.3, DISC, 0.5
    slope = math.atan(friction) + excess
    system = build.over(body, Rest(slope), friction=friction)
    up = np.array([math.sin(slope), 0.0, math.cos(slope)])
    system.place(body, position=STANDS[body] * up, orientation=_about((0.0, 1.0, 0.0), slope))
    solution = ns.simulate(system, seconds)
    acceleration = max(0.0, GRAVITY * (math.sin(slope) - friction * math.cos(slope)))
    speed = float(np.linalg.norm(solution.u_end[:3]))
    assert speed == pytest.approx(acceleration * seconds, rel=1e-6, abs=1e-10)
    assert np.max(np.abs(solution.u_end[3:])) < 1e-9


LONG, THIN = 0.03, 0.01
"""Half-length and radius of a cylinder that tips before it slides."""


@pytest.mark.parametrize("excess", [-1e-3, -1e-6, 1e-6, 1e-3])
def test_it_tips_over_its_rim(build: Any, excess: float) -> None:
    """It rests on its rim and two feet as long as the mass centre is not beyond the lowest point of the rim.

    The tangent of slope and lean together is radius over distance of the rim; rim and feet lean by atan(3 b / 2 R).
    """
    feet = 1e-4 * THIN
    lean = math.atan(1.5 * feet / THIN)
    slope = math.atan(THIN / (LONG - feet)) - lean + excess
    body = CylinderBody(THIN, LONG, foot_height=feet)
    system = build.over(body, Rest(orientation=_about((0.0, 1.0, 0.0), -slope)), friction=0.8)
    height = (LONG - feet) * math.cos(lean) + THIN * math.sin(lean)
    system.place(
        body,
        position=(-height * math.sin(slope), 0.0, height * math.cos(slope)),
        orientation=_about((0.0, 1.0, 0.0), -slope - lean),
    )
    solution = ns.simulate(system, 0.5)
    turned = abs(float(_lean(solution.q_end)) - math.sin(slope + lean))
    assert turned > 1e-5 if excess > 0.0 else turned < 1e-11
    assert np.max(np.abs(solution.u_end)) > 1e-5 if excess > 0.0 else np.max(np.abs(solution.u_end)) < 1e-11


@pytest.mark.parametrize("turned", [0.0, 0.3, math.pi / 6.0, 0.8, math.pi / 3.0, math.pi / 2.0])
@pytest.mark.parametrize(("feet", "early"), [(1e-4, 0.03), (1e-5, 0.01)])
def test_let_go_upright_it_tips_a_little_early(build: Any, turned: float, feet: float, early: float) -> None:
    """It drops from feet to rim and swings: that much below the slope R / h it stays, however the feet are turned."""
    for excess in (-early, 1e-3):
        slope = math.atan(THIN / LONG) * (1.0 + excess)
        body = CylinderBody(THIN, LONG, foot_height=feet * THIN)
        system = build.over(body, Rest(slope), friction=0.8)
        leaning = Rotation.from_rotvec([0.0, slope, 0.0]) * Rotation.from_rotvec([0.0, 0.0, turned])
        system.place(
            body,
            position=LONG * np.array([math.sin(slope), 0.0, math.cos(slope)]),
            orientation=tuple(np.roll(leaning.as_quat(), 1).tolist()),
        )
        solution = ns.simulate(system, 0.6)
        leaned = float(_lean(solution.q_end)) - math.sin(slope)
        assert leaned > 0.05 if excess > 0.0 else abs(leaned) < 0.02
        # held against the weight: in a drop of a micrometre next to no energy changes hands
        account = solution.energy
        assert abs(account.change + account.loss) < 1e-8 * body.total_mass * GRAVITY * LONG


@pytest.mark.parametrize("turned", [0.0, 0.8, math.pi / 3.0])
@pytest.mark.parametrize("short", [1.5e-3, 4e-3])
def test_on_feet_of_a_millionth_of_its_radius_energy_says_whether_it_goes_over(
    build: Any, short: float, turned: float
) -> None:
    """Let go upright next to tipping, it drops by some ten nanometres from feet to rim, and goes on about the rim.

    What strikes there has no moment about the rim, and next to none of the energy is lost: that with which it starts
    is enough to pass the top or is not.
    """
    slope, feet = math.atan(THIN / LONG) * (1.0 - short), 1e-6 * THIN
    body = CylinderBody(THIN, LONG, foot_height=feet)
    system = build.over(body, Rest(slope), friction=0.8)
    upright = Rotation.from_rotvec([0.0, slope, 0.0]) * Rotation.from_rotvec([0.0, 0.0, turned])
    system.place(
        body,
        position=LONG * np.array([math.sin(slope), 0.0, math.cos(slope)]),
        orientation=tuple(np.roll(upright.as_quat(), 1).tolist()),
    )
    spare = LONG * math.cos(slope) - math.hypot(THIN, LONG - feet) + THIN * math.sin(slope)
    assert abs(spare) > 0.3 * feet
    solution = ns.simulate(system, 0.6)
    fallen = float(_lean(solution.q_end)) - math.sin(slope)
    assert (fallen > 0.3) if spare > 0.0 else (abs(fallen) < 1e-3)
    assert solution.counters.steps < 10000


@pytest.mark.parametrize("tilt", [0.02, 0.3])
def test_feet_do_not_touch_while_it_rolls(build: Any, tilt: float) -> None:
    """On high feet and on low ones, a nodding disc rolls in the same way to the last bit."""
    ends = []
    for feet in (0.0, None):
        body = DiscBody(R, mass=0.2, foot_height=feet)
        system = build.over(body, friction=0.5)
        rate = 0.9 * float(steady.precession(tilt, R)) * math.sin(tilt)
        system.place(
            body,
            position=(0.0, 0.0, R * math.sin(tilt)),
            orientation=_about((0.0, 1.0, 0.0), tilt),
            angular_velocity=(-rate, 0.0, 0.0),
        )
        solution = ns.simulate(system, 0.5)
        assert set(solution.events.causes()) == {"start"}
        ends.append((solution.q_end, solution.u_end))
    np.testing.assert_array_equal(ends[0][0], ends[1][0])
    np.testing.assert_array_equal(ends[0][1], ends[1][1])


@settings(max_examples=50)
@given(feet=st.floats(1e-5, 0.1), way=st.floats(0.0, 2.0 * math.pi))
def test_feet_reach_the_plane_below_a_small_tilt_only(build: Any, feet: float, way: float) -> None:
    """While the rim touches, they are clear of the plane at tilts above atan(3 b / R), whichever way the disc leans."""
    rig = Rig((Plane(), Disc(1.0, foot_height=feet)), build.laws())
    for factor in (1.0 + 1e-9, 2.0):
        tilt = math.atan(3.0 * feet) * factor
        lean = Rotation.from_rotvec(tilt * np.array([math.cos(way), math.sin(way), 0.0]))
        at = (np.array([0.0, 0.0, math.sin(tilt)]), np.roll(lean.as_quat(), 1))
        rig.put([(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])), at], np.zeros(12))
        assert rig.geometry[0, 0] == pytest.approx(0.0, abs=1e-15)
        assert np.min(rig.geometry[1:, 0]) > 0.0
    # towards a foot that is the least: just below, it has reached the plane
    tilt = math.atan(3.0 * feet) * (1.0 - 1e-9)
    lean = Rotation.from_rotvec([0.0, tilt, 0.0])
    at = (np.array([0.0, 0.0, math.sin(tilt)]), np.roll(lean.as_quat(), 1))
    rig.put([(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])), at], np.zeros(12))
    assert np.min(rig.geometry[1:, 0]) < 0.0


def test_a_ball_beside_a_body_with_feet(build: Any) -> None:
    """Spheres meet the faces as if there were no feet."""
    one, other, ball = CylinderBody(R, 0.02), CylinderBody(R, 0.02, foot_height=0.0), Ball(0.01)
    kinematics = []
    for body in (one, other):
        system = ns.System([body, ball])
        (contact,) = system.contact(body, ball, **build.laws())
        kinematics.append(contact.kinematics)
    assert kinematics[0] == kinematics[1]
    assert len(build.over(one).contacts) == 2 + 6
    assert len(build.over(other).contacts) == 2 + 6
    assert len(build.over(DISC).contacts) == 1 + 6


@pytest.mark.parametrize("tilt", [1e-6, 1e-4, 1e-2])
def test_springs_that_press_the_feet_in_let_it_settle(tilt: float) -> None:
    """Its face touches the plane then, and its force goes from one side of the rim to the other without a jump."""
    plate = Plate()
    system = ns.System([plate, DISC])
    system.contact(plate, DISC, normal=LinearCompliant(1e4, 0.5), friction=Frictionless(), impact=None)
    system.place(DISC, position=(0.0, 0.0, 0.02), orientation=_about((1.0, 0.3, 0.0), tilt))
    solution = ns.simulate(system, 0.3)
    assert solution.status == "done"
    assert solution.energy.unexplained < 1e-7 * solution.energy.scale
    assert solution.counters.steps < 5000


def test_the_crown_within_the_feet_touches_no_plane_that_they_stand_on() -> None:
    """Of a disc over a plane the rim's gap is that of the feet at least up to 1.5 f / R, where it stands on both."""
    rig = Rig((Plane(), Disc(R, foot_height=USUAL * R)), {**LAWS})
    for tilt in np.linspace(0.0, 1.5 * USUAL, 40).tolist():
        rig.put(((np.zeros(3), (1.0, 0.0, 0.0, 0.0)), ((0.0, 0.0, R), _about((1.0, 0.3, 0.0), tilt))), np.zeros(12))
        gaps = rig.geometry[:, GAP]
        assert gaps[0] >= np.min(gaps[1:]) - 1e-12 * R


def test_the_crown_goes_over_into_the_rim() -> None:
    """Gap and lowest point of the face are continuous in the tilt, and the point is where the gap's rate is its own."""
    rig = Rig((Plane(), Disc(R, foot_height=USUAL * R)), {**LAWS})
    spin = np.array([0.0] * 9 + [1.0, 0.0, 0.0])
    tilts = USUAL * np.linspace(0.01, 2.0, 400)
    rows = []
    for tilt in tilts.tolist():
        rig.put(((np.zeros(3), (1.0, 0.0, 0.0, 0.0)), ((0.0, 0.0, R), _about((1.0, 0.0, 0.0), tilt))), spin)
        rows.append([rig.geometry[0, GAP], rig.rate[0, 0]])
    gaps, rates = np.array(rows).T
    step = tilts[1] - tilts[0]
    np.testing.assert_allclose(np.diff(gaps) / step, 0.5 * (rates[1:] + rates[:-1]), rtol=0.0, atol=2e-3 * R)
