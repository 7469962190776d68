"""Long bodies that collide side against side, nearly parallel: the contact point runs along them once they turn.

The sides cross at a small angle. A hit beside the middle turns the bodies, and the point where they are nearest leaves
them at a speed that grows as the angle gets smaller. The bodies separate everywhere, so there is one impact only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, CapsuleBody, CylinderBody
from laws import Coulomb, EnergeticImpact, Unilateral

E, MASS, RADIUS, HALF, GAP = 0.5, 0.8, 0.05, 0.07, 0.02

BODIES: dict[str, Callable[[], Any]] = {
    "cylinder": lambda: CylinderBody(RADIUS, HALF, mass=MASS),
    "rounded cylinder": lambda: CylinderBody(RADIUS, HALF, mass=MASS, rounding=0.01),
    "capsule": lambda: CapsuleBody(RADIUS, HALF, mass=MASS),
    "box on edge": lambda: BoxBody(RADIUS, RADIUS, HALF, mass=MASS),
}


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("seed", range(8))
def test_a_hit_beside_the_middle_is_one_impact(name: str, seed: int) -> None:
    """Velocities after it follow from the impulse where the sides cross: (1 + e) v / (2 / m + sum of s^2 / I)."""
    rng = np.random.default_rng(seed)
    angle, beside = 10.0 ** rng.uniform(-5.0, -1.5), rng.uniform(0.002, 0.008) * rng.choice([-1.0, 1.0])
    speed, world = 10.0 ** rng.uniform(-1.0, 1.0), Rotation.random(rng=rng)
    one, two = BODIES[name](), BODIES[name]()
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(E))
    # the edges of a box face each other
    roll = Rotation.from_euler("z", math.pi / 4.0 if isinstance(one, BoxBody) else 0.0)
    width = 2.0 * RADIUS * (math.sqrt(2.0) if isinstance(one, BoxBody) else 1.0)
    orientations = world * roll, world * Rotation.from_euler("x", angle) * roll
    # the sides cross at these distances from the middles
    levers = beside, beside / math.cos(angle)
    place = world.apply((width + GAP, beside * math.tan(angle), 0.0))
    quaternions = [tuple(turn.as_quat(scalar_first=True)) for turn in orientations]
    system.place(one, orientation=quaternions[0], velocity=tuple(world.apply((speed, 0.0, 0.0))))
    system.place(two, orientation=quaternions[1], position=tuple(place))
    solution = ns.simulate(system, 2.0 * GAP / speed)
    assert solution.status == "done"
    assert list(solution.events.cause) == [ns.Cause.START, ns.Cause.IMPACT]
    inertia = one.inertia[0]
    impulse = (1.0 + E) * speed / (2.0 / MASS + (levers[0] ** 2 + levers[1] ** 2) / inertia)
    expected = speed - impulse / MASS, impulse / MASS
    for body, velocity, lever in zip((one, two), expected, levers, strict=True):
        u = solution.of(body)[1][-1]
        np.testing.assert_allclose(world.inv().apply(u[:3]), (velocity, 0.0, 0.0), atol=1e-7 * speed)
        # round-off of the places shifts the crossing by more, the smaller the angle is
        allowed = 1e-7 * abs(lever) + 1e-12 / angle
        assert np.linalg.norm(u[3:]) == pytest.approx(impulse * abs(lever) / inertia, abs=impulse * allowed / inertia)
