"""Long bodies that collide side against side, nearly parallel: the contact point runs along them once they turn.

The sides cross at a small angle. A hit beside the middle turns the bodies, and the point where they are nearest leaves
them at a speed that grows as the angle gets smaller. If the bodies separate everywhere, there is one impact only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, CapsuleBody, CylinderBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral

E, MASS, RADIUS, HALF, GAP = 0.5, 0.8, 0.05, 0.07, 0.02

UPRIGHT = Rotation.identity()

BODIES: dict[str, Callable[[], Any]] = {
    "cylinder": lambda: CylinderBody(RADIUS, HALF, mass=MASS),
    "rounded cylinder": lambda: CylinderBody(RADIUS, HALF, mass=MASS, rounding=0.01),
    "capsule": lambda: CapsuleBody(RADIUS, HALF, mass=MASS),
    "box on edge": lambda: BoxBody(RADIUS, RADIUS, HALF, mass=MASS),
}


def _crossed(
    name: str, restitution: float, angle: float, beside: float, speed: float, world: Rotation
) -> tuple[ns.System, Any, Any]:
    """Return two bodies along z, the second one turned by an angle [rad] about x, at which the first one flies.

    Their sides cross at the distance ``beside`` from the middle of the first body [m].  ``world`` turns both.
    """
    one, two = BODIES[name](), BODIES[name]()
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(restitution))
    # the edges of a box face each other
    roll = Rotation.from_euler("z", math.pi / 4.0 if isinstance(one, BoxBody) else 0.0)
    width = 2.0 * RADIUS * (math.sqrt(2.0) if isinstance(one, BoxBody) else 1.0)
    place = world.apply((width + GAP, beside * math.tan(angle), 0.0))
    turns = [
        tuple((world * turn * roll).as_quat(scalar_first=True)) for turn in (UPRIGHT, Rotation.from_euler("x", angle))
    ]
    system.place(one, orientation=turns[0], velocity=tuple(world.apply((speed, 0.0, 0.0))))
    system.place(two, orientation=turns[1], position=tuple(place))
    return system, one, two


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("seed", range(8))
def test_a_hit_beside_the_middle_is_one_impact(name: str, seed: int) -> None:
    """Velocities after it follow from the impulse where the sides cross: (1 + e) v / (2 / m + sum of s^2 / I)."""
    rng = np.random.default_rng(seed)
    angle, beside = 10.0 ** rng.uniform(-5.0, -1.5), rng.uniform(0.002, 0.008) * rng.choice([-1.0, 1.0])
    speed, world = 10.0 ** rng.uniform(-1.0, 1.0), Rotation.random(rng=rng)
    system, one, two = _crossed(name, E, angle, beside, speed, world)
    solution = ns.simulate(system, 2.0 * GAP / speed)
    assert solution.status == "done"
    assert list(solution.events.cause) == [ns.Cause.START, ns.Cause.IMPACT]
    # distances of the crossing from the middles
    levers, inertia = (beside, beside / math.cos(angle)), one.inertia[0]
    impulse = (1.0 + E) * speed / (2.0 / MASS + (levers[0] ** 2 + levers[1] ** 2) / inertia)
    expected = speed - impulse / MASS, impulse / MASS
    for body, velocity, lever in zip((one, two), expected, levers, strict=True):
        u = solution.of(body)[1][-1]
        np.testing.assert_allclose(world.inv().apply(u[:3]), (velocity, 0.0, 0.0), atol=1e-7 * speed)
        # round-off of the places shifts the crossing by more, the smaller the angle is
        allowed = 1e-7 * abs(lever) + 1e-12 / angle
        assert np.linalg.norm(u[3:]) == pytest.approx(impulse * abs(lever) / inertia, abs=impulse * allowed / inertia)


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("seed", range(10))
def test_every_hit_along_the_bodies_has_its_restitution(name: str, e: float, seed: int) -> None:
    """The first hit is anywhere along them.  The other ends then come near, and further hits follow at once.

    None of them is the end of an accumulation, which would take the restitution away: with e = 1 no energy is lost.
    """
    rng = np.random.default_rng(seed)
    angle, beside = 10.0 ** rng.uniform(-5.0, -1.5), rng.uniform(-0.9, 0.9) * HALF
    speed, world = 10.0 ** rng.uniform(-1.0, 1.0), Rotation.random(rng=rng)
    system, one, _ = _crossed(name, e, angle, beside, speed, world)
    solution = ns.simulate(system, 2.0 * GAP / speed)
    assert solution.status == "done"
    assert ns.Cause.CLOSING not in solution.events.cause
    assert np.all(np.asarray(solution.events.closing_loss) == 0.0)
    assert solution.energy.residual < 1e-8
    energies, before = np.asarray(_kinetic(solution.events.u_after, one)), 0.5 * MASS * speed**2
    assert np.all(np.diff(energies) <= 1e-8 * before)
    if e == 1.0:
        assert energies[-1] == pytest.approx(before, rel=1e-8)


def _kinetic(velocities: Any, body: Any) -> Any:
    """Return the kinetic energy of two equal bodies [J], shape [n], from their velocities."""
    u = np.asarray(velocities).reshape(-1, 2, 2, 3)
    return np.sum(0.5 * MASS * u[:, :, 0] ** 2 + 0.5 * np.array(body.inertia) * u[:, :, 1] ** 2, axis=(1, 2))


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("seed", range(8))
def test_a_rim_whose_lowest_point_runs_round_comes_to_rest(seed: int) -> None:
    """A cylinder falls on an equal one, tilted by some 1e-9 rad.  Its rim rolls on the cap, and the bounces accumulate.

    The point runs round the rim faster than the bodies move, and never leaves it.
    """
    rng = np.random.default_rng(seed)
    radius, half = 0.012, 0.012
    floor, low, high = Plate(), CylinderBody(radius, half), CylinderBody(radius, half)
    system = ns.System([floor, low, high])
    laws = ns.ContactLaws(normal=Unilateral(), friction=Coulomb(0.8), impact=EnergeticImpact(0.5))
    system.contact_all(laws)
    system.place(low, position=(0.0, 0.0, half))
    tilt = tuple(Rotation.from_rotvec(4e-9 * rng.normal(size=3)).as_quat(scalar_first=True))
    system.place(high, position=(0.003, 0.0, 3.0 * half + 7e-6), orientation=tilt, velocity=(0.0, 0.0, -0.23))
    solution = ns.simulate(system, 0.04)
    assert solution.status == "done"
    assert ns.Cause.CLOSING in solution.events.cause


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("e", [0.3, 0.6])
@pytest.mark.parametrize("angle", [1e-6, 1e-4, 1e-2])
def test_bounces_of_a_log_that_rolls_off_another_come_to_an_end(angle: float, e: float) -> None:
    """The contact point of the logs runs, too.  In time its bounces are so short that they accumulate at one place."""
    floor, low, high = Plate(), CylinderBody(0.02, 0.06), CylinderBody(0.02, 0.06)
    system = ns.System([floor, low, high])
    system.contact_all(ns.ContactLaws(normal=Unilateral(), friction=Coulomb(0.4), impact=EnergeticImpact(e)))
    lying = Rotation.from_euler("x", 0.5 * math.pi)
    turned = Rotation.from_euler("z", angle) * lying
    system.place(low, position=(0.0, 0.0, 0.02), orientation=tuple(lying.as_quat(scalar_first=True)))
    system.place(high, position=(0.03, 0.003, 0.0505), orientation=tuple(turned.as_quat(scalar_first=True)))
    solution = ns.simulate(system, 0.15)
    assert solution.status == "done"
    times = np.asarray(solution.events.time)[solution.events.cause == ns.Cause.IMPACT]
    # no hundred impacts within the contact time of 20 us
    assert np.all(times[100:] - times[:-100] > 2e-5)
