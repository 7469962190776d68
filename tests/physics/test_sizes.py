"""Bodies of 1 um to 100 m move alike: runs at other sizes are the same run in other units."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, CapsuleBody, Hinge, Plate
from nonsmooth.errors import InvalidInput
from tests.physics.scaled_systems import SIZE, SYSTEMS, Units, run, similar

pytestmark = pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")

LARGEST = 2.0**-7
"""Unit of length of bodies of a tenth of a millimetre [m]."""
SAME_GRAVITY = pytest.mark.parametrize("same_gravity", [True, False])
TIGHT = ns.EventDriven(
    tolerance=1e-12, impact_tolerance=1e-12, gap_tolerance=1e-14, velocity_tolerance=1e-10, time_tolerance=1e-14
)


@SAME_GRAVITY
@pytest.mark.parametrize("name", SYSTEMS)
def test_small_bodies_move_with_the_same_bits(name: str, same_gravity: bool) -> None:
    """Lengths by powers of four, down to 0.1 um: all numbers are the same but for their exponents.

    Volume and inertia of hulls are sums in another order.
    """
    one = run(name, similar(LARGEST, same_gravity=same_gravity))
    exact = 1e-10 if name == "two_hulls" else 0.0
    for k in (-8, -11):
        other = run(name, similar(LARGEST * 4.0**k, same_gravity=same_gravity))
        assert other.causes == one.causes
        for found, expected in ((other.q, one.q), (other.u, one.u), (other.times, one.times)):
            np.testing.assert_allclose(found, expected, rtol=0.0, atol=exact)


@SAME_GRAVITY
@pytest.mark.parametrize("name", SYSTEMS)
def test_bodies_of_all_sizes_move_alike(name: str, same_gravity: bool) -> None:
    """From 1 um to 100 m: the same events, states to 1e-7 of the sizes, and energies to 3e-8 of their range."""
    exact = run(name, Units(1.0, 1.0, 1.0), TIGHT)
    for size in (1e-6, 1e-4, 1e-2, 1.0, 1e2):
        units = similar(size / SIZE, same_gravity=same_gravity)
        # no system may have a gravity that is that large
        if 9.9 * units.length / units.time**2 > 1e4:
            continue
        found = run(name, units)
        assert found.causes == exact.causes
        assert found.unexplained < 3e-8
        np.testing.assert_allclose(found.times, exact.times, rtol=0.0, atol=1e-6)
        np.testing.assert_allclose(found.q[-1], exact.q[-1], rtol=0.0, atol=1e-7)
        np.testing.assert_allclose(found.u[-1], exact.u[-1], rtol=0.0, atol=1e-6)


def test_a_small_body_beside_a_large_one_moves_as_alone() -> None:
    """A ball of 1 um falls on a plate next to a box of 1 m that falls, too. It moves the same to 1e-8 of its size."""
    found = []
    for is_alone in (True, False):
        units = similar(1e-6 / SIZE, same_gravity=True)
        ball, box, plate = Ball(1e-6, density=1000.0), BoxBody(0.5, 0.5, 0.5, density=1000.0), Plate()
        system = units.system([plate, ball] if is_alone else [box, plate, ball])
        system.contact(ball, plate, **units.rigid(0.5, 0.3))
        units.place(system, ball, (0.0, 0.0, 3.0 * SIZE), (0.25, 0.0, 0.0))
        if not is_alone:
            system.contact(box, plate, **units.rigid(0.5, 0.3))
            system.place(box, position=(2.0, 0.0, 0.5 + 1e-6))
        solution = ns.simulate(system, 0.25 * units.time, sample_interval=0.25 * units.time)
        found.append(solution.of(ball)[0][-1, :3] / units.length)
    np.testing.assert_allclose(found[1], found[0], rtol=0.0, atol=1e-8 * SIZE)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1.0])
def test_an_overlap_at_the_start_is_refused_at_any_size(size: float) -> None:
    """Round-off of a start is allowed; an overlap of 1e-4 of a ball is not."""
    for part, is_allowed in ((1e-9, True), (1e-4, False)):
        ball, plate = Ball(size, density=1000.0), Plate()
        system = ns.System([plate, ball], 9.81)
        system.contact(ball, plate, **similar(1.0, same_gravity=True).rigid(0.5, 0.3))
        system.place(ball, position=(0.0, 0.0, (1.0 - part) * size))
        if is_allowed:
            ns.simulate(system, 1e-3 * math.sqrt(size))
        else:
            with pytest.raises(InvalidInput, match="must not overlap"):
                ns.simulate(system, 1e-3 * math.sqrt(size))


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1.0])
def test_an_open_joint_at_the_start_is_refused_at_any_size(size: float) -> None:
    """The ends of a pendulum may be apart by round-off, but not by 1e-4 of its length."""
    for part, is_allowed in ((1e-9, True), (1e-4, False)):
        rod, plate = CapsuleBody(0.1 * size, size, density=1000.0), Plate()
        system = ns.System([plate, rod], 9.81)
        system.joint(Hinge(second=(0.0, 0.0, size)), plate, rod)
        system.place(rod, position=(part * size, 0.0, -size))
        if is_allowed:
            ns.simulate(system, 1e-3 * math.sqrt(size))
        else:
            with pytest.raises(InvalidInput, match="must have the residual 0"):
                ns.simulate(system, 1e-3 * math.sqrt(size))


def test_a_gap_tolerance_that_is_large_for_a_body_is_refused() -> None:
    """The message names the smallest body."""
    system, _ = SYSTEMS["two_balls"](similar(1e-6 / SIZE, same_gravity=True))
    with pytest.raises(InvalidInput, match=r"gap_tolerance must be at most 1e-07 of the smallest body, 'ball 1'"):
        ns.simulate(system, 1e-5, engine=ns.EventDriven(gap_tolerance=1e-12))
