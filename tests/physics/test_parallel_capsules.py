"""Parallel capsules touch along a line, with a contact at either end of it: they carry each other without a tilt."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import CapsuleBody, DrivenBody, Rest
from bodies.shapes.capsule import Capsule
from laws import Coulomb, EnergeticImpact, Frictionless, LinearCompliant, Unilateral

RADIUS, HALF = 0.012, 0.02
ANGLES = (0.0, 1e-9, 1e-7, 1e-5, 1e-3)
"""Of the upper or second capsule against the other [rad]."""
APART = 0.015
"""Half of the distance of the axes of two capsules that make a groove [m]."""
HEIGHT = math.sqrt(4.0 * RADIUS**2 - APART**2)
"""Of the axis of a capsule in the groove [m]."""
AXES = {"level": (0.0, 0.0, 1.0), "tilted": (0.0, 1.0, 0.0), "rolled": (1.0, 0.0, 0.0)}
LYING = ns.turned_about((0.0, 1.0, 0.0), 0.5 * math.pi)


def _turned(axis: str, angle: float) -> tuple[float, ...]:
    """Return the orientation of a capsule along x, then turned about an axis."""
    w, x, y, z = ns.turned_about(AXES[axis], angle)
    a, b, c, d = LYING
    v, u = np.array([x, y, z]), np.array([b, c, d])
    return (w * a - float(v @ u), *(w * u + a * v + np.cross(v, u)).tolist())


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("shift", [0.0, 1e-9, 1e-3])
@pytest.mark.parametrize("fall", [0.0, 1e-3])
def test_a_capsule_lies_in_a_groove_of_two(fall: float, shift: float, angle: float, axis: str) -> None:
    """It comes to rest at the height of two lines, whatever small angle it has when it falls."""
    along = {"axis_x": 1.0, "axis_z": 0.0}
    groove = DrivenBody(Rest(), tuple(Capsule(RADIUS, HALF, y=y, **along) for y in (-APART, APART)))
    log = CapsuleBody(RADIUS, HALF)
    system = ns.System([groove, log])
    system.contact(groove, log, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.0))
    # above the height at which the lower end of a tilted one touches
    above = fall + HALF * math.sin(angle)
    system.place(log, position=(shift, 0.0, HEIGHT + above), orientation=_turned(axis, angle))
    solution = ns.simulate(system, 0.3)
    assert solution.q_end[2] == pytest.approx(HEIGHT, abs=1e-7)
    assert np.max(np.abs(solution.u_end)) < 1e-6


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("shift", [0.0, 1e-12, 1e-9, 1e-3])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_capsules_collide_side_by_side(restitution: float, shift: float, angle: float, axis: str) -> None:
    """Momentum is kept, no energy comes, and they separate by the impact's ratio if both ends meet at once."""
    one, two = CapsuleBody(RADIUS, HALF), CapsuleBody(RADIUS, HALF)
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(restitution))
    system.place(one, velocity=(0.0, 0.0, 1.0), orientation=LYING)
    system.place(two, position=(shift, 0.0, 2.0 * RADIUS + 1e-3), orientation=_turned(axis, angle))
    solution = ns.simulate(system, 0.02)
    assert solution.status == "done"
    first, second = (solution.of(body)[1][-1] for body in (one, two))
    np.testing.assert_allclose(first[:3] + second[:3], [0.0, 0.0, 1.0], rtol=0, atol=1e-12)
    energy = solution.energy
    assert energy.kinetic_end <= energy.kinetic_start * (1.0 + 1e-12)
    if angle == 0.0 and shift < 1e-3:
        assert second[2] - first[2] == pytest.approx(restitution, abs=1e-7)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("shift", [1e-4, 1e-3])
def test_a_capsule_rests_on_springs_in_a_groove_of_two(shift: float, angle: float) -> None:
    """The energy account of the run is closed, and the depth is that of four springs, at either end of two lines."""
    along = {"axis_x": 1.0, "axis_z": 0.0}
    groove = DrivenBody(Rest(), tuple(Capsule(RADIUS, HALF, y=y, **along) for y in (-APART, APART)))
    log = CapsuleBody(RADIUS, HALF)
    system = ns.System([groove, log])
    system.contact(groove, log, normal=LinearCompliant(1e5, 20.0), friction=Frictionless())
    system.place(log, position=(shift, 0.0, HEIGHT + HALF * angle), orientation=_turned("level", angle))
    solution = ns.simulate(system, 0.3)
    assert solution.status == "done"
    assert abs(solution.energy.residual) < 1e-6
    depth = log.total_mass * 9.81 / (4.0 * 1e5 * (HEIGHT / (2.0 * RADIUS)) ** 2)
    assert HEIGHT - solution.q_end[2] == pytest.approx(depth, rel=0.01)


@pytest.mark.parametrize("angle", [1e-3, 2e-3])
@pytest.mark.parametrize("tilt", [4.65e-6, 1e-5, 1e-4])
def test_a_capsule_tips_from_one_end_onto_its_crossing(tilt: float, angle: float) -> None:
    """It turns about the lower end of its axis. The axes cross between their ends before the other end comes down.

    The crossing runs along the axes within microseconds, and its gap is lower than those of the ends by up to
    (angle HALF)^2 / (4 RADIUS): some nanometres. Past the ends the crossing is metres away.
    """
    base = DrivenBody(Rest(), (Capsule(RADIUS, HALF, axis_x=1.0, axis_z=0.0),))
    log = CapsuleBody(RADIUS, HALF)
    system = ns.System([base, log], gravity=0.0)
    system.contact(base, log, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.0))
    c, s, down = math.cos(angle), math.sin(angle), math.sin(tilt)
    lower = -HALF * np.array([math.cos(tilt) * c, math.cos(tilt) * s, down])
    spin = 0.1 * np.array([-s, c, 0.0])
    w, x, y, z = ns.turned_about((0.0, 1.0, 0.0), 0.5 * math.pi - tilt)
    # turned about the vertical after the tilt
    v, u = math.cos(0.5 * angle), math.sin(0.5 * angle)
    orientation = v * w - u * z, v * x - u * y, v * y + u * x, v * z + u * w
    height = math.sqrt(4.0 * RADIUS**2 - lower[1] ** 2) - lower[2]
    # the angular velocity of `place` is in the axes of the body
    system.place(
        log,
        position=(1e-12, 0.0, height),
        orientation=orientation,
        velocity=tuple(np.cross(spin, -lower)),
        angular_velocity=(0.0, 0.1, 0.0),
    )
    solution = ns.simulate(system, 2.0 * tilt / 0.1)
    assert solution.status == "done"
    # the first contact of two capsules is that of their sides, where the axes cross
    touched = [solution.system.contacts[int(k)].name for k in solution.events.contact if k >= 0]
    assert "(1)" in touched[0]
