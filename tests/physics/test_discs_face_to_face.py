"""Sharp discs that meet face to face: they have no thickness, so only their past tells the sides apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import DiscBody, Plate
from bodies.shapes.frustum import LEAST_OF_DISC
from laws import Coulomb, EnergeticImpact, Unilateral

LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.0), "impact": EnergeticImpact(0.5)}
WORLDS = (1.0, 0.0, 0.0, 0.0), (0.8, 0.0, 0.36, 0.48), (0.1, -0.7, 0.5, 0.5)
"""Orientations of both discs."""


def _normal(orientation: tuple[float, ...]) -> np.ndarray:
    w, x, y, z = np.array(orientation) / np.linalg.norm(orientation)
    return np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])


def _meet(scale: float, side: float, world: tuple[float, ...], shift: float, swaps: bool) -> tuple[float, float]:
    """Let one disc fly at another one; return the speeds of the first one and of the second one, relative to before."""
    one, two = DiscBody(0.05 * scale, foot_height=0.0), DiscBody(0.05 * scale, foot_height=0.0)
    system = ns.System([two, one] if swaps else [one, two], gravity=0.0)
    system.contact(*system.bodies, **LAWS)
    speed, way = np.sqrt(scale), side * _normal(world)
    across = np.cross(way, [0.3, 0.5, 0.8])
    place = 0.02 * scale * way + shift * scale * across / np.linalg.norm(across)
    turn = tuple(float(x) for x in np.array(world) / np.linalg.norm(world))
    system.place(one, orientation=turn, velocity=tuple(speed * way))
    system.place(two, orientation=turn, position=tuple(place))
    solution = ns.simulate(system, 0.03 * scale / speed)
    assert solution.status == "done"
    u_one, u_two = (solution.of(body)[1][-1] for body in (one, two))
    return float(u_one[:3] @ way) / speed, float(u_two[:3] @ way) / speed


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("swaps", [False, True])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("scale", [1e-2, 1.0, 30.0])
@pytest.mark.parametrize("world", WORLDS)
def test_discs_rebound_from_the_side_from_which_they_came(
    scale: float, side: float, world: tuple[float, ...], swaps: bool
) -> None:
    """Of equal discs that meet centrally the first keeps (1 - e) / 2 of its speed; the second gets (1 + e) / 2."""
    for shift in (0.0, 1e-12, 1e-9, 1e-6):
        first, second = _meet(scale, side, world, shift, swaps)
        assert first == pytest.approx(0.25, abs=1e-3)
        assert second == pytest.approx(0.75, abs=1e-3)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("shift", [0.01, 0.04, 0.09])
def test_discs_that_overlap_in_part_push_each_other(shift: float, side: float) -> None:
    """Momentum is kept.  The impulse is largest in the middle of the common area: m / 2 and m R^2 / 4 resist.

    The feet that are over the other disc carry it, at 0.04 m not evenly.
    """
    arm = 0.5 * shift / 0.05
    impulse = 1.5 / (2.0 + 8.0 * arm * arm)
    first, second = _meet(1.0, side, WORLDS[1], shift, swaps=False)
    assert first + second == pytest.approx(1.0, abs=1e-9)
    assert (0.95 if shift == 0.04 else 1.0 - 1e-6) * impulse < second < impulse * (1.0 + 1e-6)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("seed", range(12))
def test_a_disc_that_falls_on_a_disc_stays_above_it(seed: int) -> None:
    """The lower disc lies on a plate; both planes are next to each other at the impacts, but the order remains."""
    rng = np.random.default_rng(seed)
    plate, low, high = Plate(), DiscBody(0.012, foot_height=0.0), DiscBody(0.012, foot_height=0.0)
    system = ns.System([plate, *((low, high) if seed % 2 else (high, low))], gravity=9.81)
    for one, two in ((plate, low), (plate, high), (low, high)):
        system.contact(one, two, **LAWS)
    height = rng.uniform(1e-4, 3e-3)
    system.place(low, position=(0.0, 0.0, LEAST_OF_DISC * 0.012))
    system.place(high, position=(0.0, 0.0, height), orientation=ns.turned_about((0.0, 0.0, 1.0), rng.uniform(0.0, 3.0)))
    solution = ns.simulate(system, 1.3 * np.sqrt(2.0 * height / 9.81))
    assert solution.status == "done"
    assert np.min(solution.of(high)[0][:, 2] - solution.of(low)[0][:, 2]) >= -1e-9


@pytest.mark.parametrize("radius", [0.1, 0.01])
def test_a_disc_leans_on_the_middle_of_another(radius: float) -> None:
    """Its rim touches the upper face of the lower disc in the middle, whose rim is then below its own middle."""
    plate, low, high = Plate(), DiscBody(radius), DiscBody(radius)
    system = ns.System([plate, low, high], gravity=9.81)
    for one, two in ((plate, low), (plate, high), (low, high)):
        system.contact(one, two, **{**LAWS, "friction": Coulomb(0.3)})
    system.place(low, position=(0.0, 0.0, 0.01 * radius))
    system.place(high, position=(radius, 0.0, 0.2 * radius))
    solution = ns.simulate(system, 0.25)
    assert solution.status == "done"
    assert solution.of(high)[0][-1, 2] > solution.of(low)[0][-1, 2]


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("feet", [0.0, 1e-8, 1e-6, 1e-4])
@pytest.mark.parametrize("part", range(4))
def test_discs_that_rock_on_each_other_part_again(part: int, feet: float) -> None:
    """A turning disc strikes another one with one side of its rim, then with the other or with raised feet."""
    for seed in range(15 * part, 15 * part + 15):
        rng = np.random.default_rng(seed)
        radius, speed, tilt = 0.006, 0.05, 10.0 ** rng.uniform(-8.0, -3.0)
        one, two = DiscBody(radius, foot_height=feet * radius), DiscBody(radius, foot_height=feet * radius)
        system = ns.System([two, one] if seed % 2 else [one, two], gravity=0.0)
        law = EnergeticImpact(rng.uniform(0.2, 0.8))
        system.contact(*system.bodies, normal=Unilateral(), friction=Coulomb(0.0), impact=law)
        azimuth, aside = rng.uniform(0.0, 2.0 * np.pi, 2)
        axis = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        shift = radius * 10.0 ** rng.uniform(-12.0, -1.0)
        height = radius * (tilt + 2.0 * feet) + 10.0 ** rng.uniform(-8.0, -5.0)
        system.place(one)
        system.place(
            two,
            position=(shift * np.cos(aside), shift * np.sin(aside), height),
            orientation=ns.turned_about(tuple(axis), tilt),
            velocity=(0.0, 0.0, -speed),
            angular_velocity=rng.uniform(-2.0, 2.0) * speed / radius * axis,
        )
        solution = ns.simulate(system, 0.002)
        assert solution.status == "done"
        (q_one, u_one), (q_two, u_two) = (solution.of(body) for body in (one, two))
        assert np.min(q_two[:, 2] - q_one[:, 2]) >= -1e-9
        # the momentum stays
        assert u_one[-1, 2] + u_two[-1, 2] == pytest.approx(-speed, rel=1e-9)
