"""Discs at depth: where the contact of one pair of features ends, the next one begins as deep."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Capsule, ConstantVelocity, Cylinder, Disc, DiscBody, DrivenBody
from laws import Frictionless, LinearCompliant
from tests.bodies.carriers import Rig

RADIUS, ROUNDING, CAPSULE = 0.01, 5e-4, 0.004
TILT = 0.3
"""Angle between the plane of the disc and the normal of its contact with the capsule [rad]."""


def _turning(angle: float, rate: float) -> tuple[DrivenBody, np.ndarray]:
    """Return a capsule that turns about the normal of its contact with a rim, at an angle from the rim's tangent.

    The rim is that of a disc round the z-axis.  Also return the normal, from the disc to the capsule.
    """
    normal, tangent = np.array([math.cos(TILT), 0.0, math.sin(TILT)]), np.array([0.0, 1.0, 0.0])
    along = math.cos(angle) * tangent + math.sin(angle) * np.cross(normal, tangent)
    middle = np.array([RADIUS - ROUNDING, 0.0, 0.0]) + (ROUNDING + CAPSULE) * normal
    motion = ConstantVelocity(rate=rate, axis=tuple(normal), position=tuple(middle))
    carried = Capsule(CAPSULE, 0.02, axis_x=along[0], axis_y=along[1], axis_z=along[2])
    return DrivenBody(motion, (carried,)), normal


STEEP = math.asin(0.5 / math.cos(TILT))
"""Angle from the rim's tangent at which a capsule is at 60 degrees to the axis of the disc [rad]."""
DIVISION = math.asin(0.5 / (math.cos(TILT) - math.sin(TILT)))
"""Angle from the rim's tangent at which the contact of one half of the rim replaces that of the other half [rad]."""


@pytest.mark.parametrize("rate", [-300.0, 300.0])
@pytest.mark.parametrize("angle", [STEEP, -STEEP, DIVISION, 0.0])
def test_energy_of_a_rim_over_which_a_capsule_turns(rate: float, angle: float) -> None:
    """Contacts of both halves of a rim share the directions of an edge: the spring keeps its depth and its energy."""
    capsule, normal = _turning(angle - rate * 5e-4, rate)
    disc = DiscBody(RADIUS, surface_density=10.0, rounding=ROUNDING)
    system = ns.System([capsule, disc], gravity=0.0)
    system.contact(capsule, disc, normal=LinearCompliant(5e3, damping=0.0), friction=Frictionless())
    system.place(disc, velocity=tuple(0.2 * normal), position=tuple(-1e-9 * normal))
    solution = ns.simulate(system, 3e-3)
    assert solution.status == "done"
    assert list(solution.events.cause)[-1] == ns.Cause.LIFT_OFF
    # after the contact no energy is stored, so the disc has what it had and the work of the drive
    energy = solution.energy
    assert energy.kinetic_end - energy.kinetic_start == pytest.approx(energy.driven_work, abs=1e-6 * energy.scale)


def test_a_rim_below_that_of_a_disc_has_a_contact_at_any_depth(build: Any) -> None:
    """A leaning cylinder beside a disc dips below its edge: the face holds it until both rims cross."""
    lean, radius, half = 0.036, 0.018, 0.01
    rig = Rig((Disc(RADIUS), Cylinder(radius, half)), build.laws())
    turn = np.array([math.cos(0.5 * lean), 0.0, math.sin(0.5 * lean), 0.0])
    # lowest point of the cylinder, from its middle
    lowest = np.array([radius * math.cos(lean) - half * math.sin(lean), 0.0, 0.0])
    lowest[2] = -half * math.cos(lean) - radius * math.sin(lean)
    for depth in (1e-8, 1e-6, 1e-5, 1e-4):
        for angle in (0.0, 0.7, 1.5, 2.5):
            for inside in (1e-9, 1e-7, 1e-6, 1e-5, 1e-4):
                place = (RADIUS - inside) * np.array([-math.cos(angle), math.sin(angle), 0.0])
                place[2] = -depth
                rig.put([(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])), (place - lowest, turn)], np.zeros(12))
                facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
                # the crossing of both rims may be less deep than the lowest point, or there is none
                assert np.any((facing < 0.0) & (facing >= -depth - 1e-14)), (depth, angle, inside)
