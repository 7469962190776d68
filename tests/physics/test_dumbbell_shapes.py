"""The dumbbell out of general shapes runs as that of the closed form does, over ten plate periods."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Dumbbell, Ellipsoid, Harmonic, Plate, RigidBody, Sphere, Superellipsoid
from nonsmooth.interfaces import Body

BODY = Dumbbell()
FREQUENCY = 25.0
TIGHT = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)


def _ball(kind: str, x: float) -> Any:
    r = BODY.radius
    if kind == "sphere":
        return Sphere(r, x)
    if kind == "ellipsoid":
        return Ellipsoid(r, r, r, x)
    if kind == "superellipsoid":
        return Superellipsoid(r, r, r, x=x)
    return Superellipsoid(0.3 * r, 0.3 * r, 0.3 * r, rounding=0.7 * r, x=x)


def _general(kind: str) -> RigidBody:
    half = 0.5 * BODY.centre_distance
    return RigidBody(BODY.total_mass, BODY.inertia, (_ball(kind, -half), _ball(kind, half)))


def _run(build: Any, body: Body) -> ns.Solution:
    """Run from the start of the drift mode."""
    half, tilt = 0.5 * BODY.centre_distance, math.radians(10.0)
    plate = Plate(Harmonic(amplitude=0.9 * 9.81 / (2.0 * math.pi * FREQUENCY) ** 2, frequency=FREQUENCY))
    system = ns.System([plate, body])
    system.contact(plate, body, **build.laws(0.65, 0.2))
    system.place(
        body,
        position=(half * math.cos(tilt), 0.0, BODY.radius + half * math.sin(tilt)),
        orientation=(math.cos(tilt / 2.0), 0.0, -math.sin(tilt / 2.0), 0.0),
    )
    return ns.simulate(system, 10.0 / FREQUENCY, engine=TIGHT)


@pytest.mark.parametrize("kind", ["sphere", "ellipsoid", "superellipsoid", "rounded"])
def test_drift(build: Any, kind: str) -> None:
    """The same events, to 1e-9 s."""
    one, other = (_run(build, body) for body in (BODY, _general(kind)))
    assert one.events.causes() == other.events.causes()
    assert len(one.events) > 30
    np.testing.assert_allclose(other.events.time, one.events.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.q_end[:3], one.q_end[:3], rtol=0, atol=1e-9)
