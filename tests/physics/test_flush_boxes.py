"""Equal bodies that meet face to face or side by side: corners, rims and sides lie in each other's planes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BoxBody, ConeBody, CylinderBody, DiscBody, FreeBody, HullBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Body
from tests.benchmarks.head_on.meeting import Meeting
from tests.physics.head_on import wrong
from tests.physics.touching import axes_of

E = 0.5
SIZES = ((0.05, 0.05, 0.05), (0.05, 0.03, 0.02))
SHIFTS = ((0.0, 0.0), (1e-12, 0.0), (1e-9, 0.0), (1e-6, 0.0), (1e-6, 1e-6), (1e-3, 0.0), (5e-3, 3e-3))
ANGLES = (0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 9.9e-3, 1.1e-2, 0.1, 0.25 * math.pi, 0.5 * math.pi)
"""About the line of centres [rad]."""


def _bodies(kind: str, size: tuple[float, float, float]) -> tuple[Body, Body]:
    if kind == "box":
        return BoxBody(*size), BoxBody(*size)
    corners = [tuple(np.multiply(signs, size)) for signs in itertools.product((-1.0, 1.0), repeat=3)]
    return HullBody(corners, 1000.0), HullBody(corners, 1000.0)


@pytest.mark.fast_cases(24)
@pytest.mark.parametrize("kind", ["box", "hull"])
@pytest.mark.parametrize("size", SIZES, ids=["cube", "brick"])
@pytest.mark.parametrize("shift", SHIFTS, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_they_collide_head_on(
    angle: float, shift: tuple[float, float], size: tuple[float, float, float], kind: str
) -> None:
    """The second one leaves with (1 + e) / 2 of the speed where the line of centres is central; never inside."""
    one, two = _bodies(kind, size)
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(E))
    system.place(one, velocity=(1.0, 0.0, 0.0))
    system.place(two, position=(2.0 * size[0] + 0.03, *shift), orientation=ns.turned_about((1.0, 0.0, 0.0), angle))
    solution = ns.simulate(system, 0.06)
    speed = float(solution.of(two)[1][-1, 0])
    if max(shift) < 1e-5:
        # turned by less than the borders are closed, some corners hold and others do not
        assert speed == pytest.approx(0.5 * (1.0 + E), abs=2e-4 if max(shift) > 0.0 else 1e-5)
    assert speed > 0.1
    apart = float(solution.of(two)[0][-1, 0] - solution.of(one)[0][-1, 0]) - 2.0 * size[0]
    assert apart > -1e-9


@pytest.mark.parametrize(
    "make",
    [
        lambda: CylinderBody(0.05, 0.07),
        lambda: CylinderBody(0.05, 0.07, rounding=0.005),
        lambda: DiscBody(0.05, rounding=0.003),
    ],
    ids=["cylinder", "rounded cylinder", "rounded disc"],
)
@pytest.mark.parametrize("turn", [0.0, 0.3, math.pi / 3.0])
def test_bodies_on_feet_collide_end_to_end(turn: float, make: Callable[[], Body]) -> None:
    """It is the feet that meet, whatever rims there are: the impact is central."""
    one, two = make(), make()
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(E))
    turned = ns.turned_about((0.0, 0.0, 1.0), turn)
    ns.at_height(system, two, 0.02, direction=(0.0, 0.0, -1.0), position=(0.0, 0.0, 0.3), orientation=turned)
    system.place(one, velocity=(0.0, 0.0, 1.0))
    first, second = (ns.simulate(system, 0.06).of(body)[1][-1] for body in (one, two))
    assert first[2] == pytest.approx(0.5 * (1.0 - E), abs=1e-5)
    assert second[2] == pytest.approx(0.5 * (1.0 + E), abs=1e-5)
    assert max(np.abs(first[3:]).max(), np.abs(second[3:]).max()) < 1e-5


ROUND: dict[str, tuple[FreeBody, FreeBody, float]] = {
    "cylinders": (CylinderBody(0.05, 0.07), CylinderBody(0.05, 0.07), 0.1),
    "rounded cylinders": (CylinderBody(0.05, 0.07, rounding=0.005), CylinderBody(0.05, 0.07, rounding=0.005), 0.1),
    "cylinder and wider one": (CylinderBody(0.05, 0.07), CylinderBody(0.06, 0.07), 0.11),
    "coins": (CylinderBody(0.012, 0.001), CylinderBody(0.012, 0.001), 0.024),
    "cones": (ConeBody(0.05, 0.05), ConeBody(0.05, 0.05), 0.1),
    "sharp discs": (DiscBody(0.05, foot_height=0.0), DiscBody(0.05, foot_height=0.0), 0.1),
}
"""Round bodies with parallel axes, and the distance of their axes at which they touch [m]."""
ALONG = (0.0, 1e-12, 1e-9, 1e-6, 1e-3)
"""Shifts along the axes [m]."""
ROLLS = (0.0, 1e-9, 1e-6, 1e-5, 1e-3, 1e-2, 0.3)
"""About the line of centres [rad]."""


@pytest.mark.fast_cases(24)
@pytest.mark.parametrize("name", ROUND)
@pytest.mark.parametrize("shift", ALONG)
@pytest.mark.parametrize("angle", ROLLS)
def test_round_bodies_collide_side_by_side(name: str, shift: float, angle: float) -> None:
    """Sides, rims or edges meet, at whatever angle they cross.

    The impact is central without a shift. That of cones is at their bases, so they turn.
    """
    one, two, distance = ROUND[name]
    if name == "sharp discs" and shift > 0.0:
        pytest.skip("the discs pass over each other, or almost do")
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(E))
    system.place(one, velocity=(1.0, 0.0, 0.0))
    turned = ns.turned_about((1.0, 0.0, 0.0), angle)
    system.place(two, position=(distance + 0.03, 0.0, shift), orientation=turned)
    solution = ns.simulate(system, 0.04)
    first, second = (float(solution.of(body)[1][-1, 0]) for body in (one, two))
    assert "impact" in solution.events.causes()
    mass = one.total_mass + two.total_mass
    assert one.total_mass * first + two.total_mass * second == pytest.approx(one.total_mass, abs=1e-9 * mass)
    if name == "cones":
        assert second > 0.05
    else:
        assert second > first + 1e-3
        if shift == 0.0:
            assert second - first == pytest.approx(E, abs=1e-7)


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("shift", [(0.0, 0.0), (1e-9, 1e-9), (1e-6, 0.0)], ids=str)
@pytest.mark.parametrize("name", ["rounded brick", "brick", "cube"])
def test_they_collide_face_to_face_in_any_orientation(name: str, shift: tuple[float, float]) -> None:
    """Round-off tilts the faces of bodies whose axes are slanted, by less than the gap tolerance."""
    worlds = np.random.default_rng(5).normal(size=(6, 4))
    rows = [
        Meeting(name, axis, shift=shift, speed=speed, world=tuple((world / np.linalg.norm(world)).tolist()))
        for axis in axes_of(name)
        for speed in (1.0, 10.0)
        for world in worlds
    ]
    assert wrong(rows) == []


def test_rates_within_the_tolerance_are_in_the_account_of_an_impact() -> None:
    """Rounded boxes come to rest flush: rates that an impact takes for zero are as large as some that it does not."""
    plate, lower, upper = Plate(), *(BoxBody(0.006, 0.0048, 0.0036, rounding=0.0006) for _ in range(2))
    system = ns.System((plate, lower, upper))
    for pair in itertools.combinations((plate, lower, upper), 2):
        system.contact(*pair, normal=Unilateral(), friction=Coulomb(0.1544), impact=EnergeticImpact(0.9))
    system.place(lower, position=(0.0, 0.0, 0.0036))
    system.place(upper, position=(5.7e-9, 2e-11, 0.01082), orientation=(1.0, 0.0, 0.0, -7.9e-10))
    solution = ns.simulate(system, 0.03)
    assert solution.status == "done", solution.message
