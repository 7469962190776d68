"""Friction that rises with the slip speed: values, certificate, bad parameters, and how a block comes to rest."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import PlanarBody, Plate, Point
from laws import Coulomb, EnergeticImpact, Unilateral, Viscous

SPEEDS = st.floats(0.0, 1e3)


@given(friction=st.floats(0.0, 1.0), growth=st.floats(0.0, 1e3), one=SPEEDS, two=SPEEDS)
def test_rises_from_rest_to_the_bound(friction: float, growth: float, one: float, two: float) -> None:
    """Mu at rest, never falling, never above the bound, mu + c v below it."""
    coefficient = Viscous(0.1, 1.0).coefficient
    slow, fast = (coefficient(speed, friction, growth, 1.0) for speed in sorted((one, two)))
    assert coefficient(0.0, friction, growth, 1.0) == friction
    assert friction <= slow <= fast <= 1.0
    assert slow == min(1.0, friction + growth * min(one, two))


@given(angle=st.floats(-3.1, 3.1), share=st.floats(0.0, 0.999))
def test_certificate(angle: float, share: float) -> None:
    """Inside the disc at rest, at the larger bound against a slip, nowhere else."""
    law, c, s = Viscous(0.3, 0.2), math.cos(angle), math.sin(angle)
    assert law.is_fulfilled((0.0, 0.0), 2.0, (0.6 * share * c, 0.6 * share * s), 1e-9)
    assert not law.is_fulfilled((0.0, 0.0), 2.0, (0.61 * c, 0.61 * s), 1e-9)
    assert law.is_fulfilled((c, s), 2.0, (-1.0 * c, -1.0 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (-0.6 * c, -0.6 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (1.0 * c, 1.0 * s), 1e-9)


def test_bad_parameters() -> None:
    """Friction that falls, is negative or not finite is refused by name."""
    with pytest.raises(ns.InvalidInput, match=r"Viscous\.largest must be at least .* 0\.5.*0\.3"):
        Viscous(0.5, 1.0, 0.3)
    with pytest.raises(ns.InvalidInput, match=r"Viscous\.growth"):
        Viscous(0.1, -1.0)
    with pytest.raises(ns.InvalidInput, match=r"Viscous\.friction"):
        Viscous(math.nan, 1.0)


@pytest.mark.parametrize(("growth", "largest"), [(0.4, 10.0), (0.4, 0.6), (0.0, 1.0)])
def test_time_to_stop(growth: float, largest: float) -> None:
    """A block stops after ln(1 + c v / mu) / (c g); above the bound it loses speed evenly; c = 0 is Coulomb's law."""
    mu, speed, gravity = 0.3, 1.5, 9.81
    plate, block = Plate(), PlanarBody(2.0, 1.0, (Point(),))
    system = ns.System([plate, block], gravity)
    system.contact(
        plate, block, normal=Unilateral(), friction=Viscous(mu, growth, largest), impact=EnergeticImpact(0.0)
    )
    system.place(block, velocity=(speed, 0.0))
    solution = ns.simulate(system, 2.0, engine=ns.EventDriven(tolerance=1e-12))
    if growth == 0.0:
        time = speed / (mu * gravity)
    else:
        bent = min(speed, (largest - mu) / growth)
        time = (speed - bent) / (largest * gravity) + math.log1p(growth * bent / mu) / (growth * gravity)
    assert solution.events.causes() == ["start", "slip to stick"]
    assert solution.events.time[1] == pytest.approx(time, abs=1e-9)
    assert solution.energy.friction_loss == pytest.approx(0.5 * 2.0 * speed**2, rel=1e-9)


def test_without_growth_it_is_coulomb() -> None:
    """With c = 0 it has Coulomb's coefficient at every speed."""
    one, two = Viscous(0.3, 0.0), Coulomb(0.3)
    for speed in (0.0, 1e-300, 1.0, 1e6):
        assert one.coefficient(speed, **one.numbers()) == two.coefficient(speed, **two.parameters())
