"""Friction that falls with the slip speed: values, certificate, bad parameters, and how far a block slides."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import PlanarBody, Plate, Point
from laws import Coulomb, EnergeticImpact, Stribeck, Unilateral

SPEEDS = st.floats(0.0, 1e3)


@given(static=st.floats(0.0, 2.0), decay=st.floats(0.0, 1e3), share=st.floats(0.0, 1.0), one=SPEEDS, two=SPEEDS)
def test_falls_from_static_to_fast(static: float, decay: float, share: float, one: float, two: float) -> None:
    """The coefficient is the static one at rest, never rises with the speed, and stays above that of fast slip."""
    fast, coefficient = share * static, Stribeck(0.3, 2.0).coefficient
    values = [coefficient(speed, static, decay, fast) for speed in sorted((one, two))]
    assert coefficient(0.0, static, decay, fast) == pytest.approx(static, abs=1e-15)
    assert static + 1e-15 >= values[0] >= values[1] - 1e-15
    assert values[1] >= fast - 1e-15
    assert coefficient(one, static, 0.0, 0.0) == static


@given(angle=st.floats(-3.1, 3.1), share=st.floats(0.0, 0.999))
def test_certificate(angle: float, share: float) -> None:
    """Inside the static disc at rest, at the smaller bound against a slip, nowhere else."""
    law, c, s = Stribeck(0.3, 2.0), math.cos(angle), math.sin(angle)
    assert law.is_fulfilled((0.0, 0.0), 2.0, (0.6 * share * c, 0.6 * share * s), 1e-9)
    assert not law.is_fulfilled((0.0, 0.0), 2.0, (0.61 * c, 0.61 * s), 1e-9)
    assert law.is_fulfilled((c, s), 2.0, (-0.2 * c, -0.2 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (-0.6 * c, -0.6 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (0.2 * c, 0.2 * s), 1e-9)


def test_bad_parameters() -> None:
    """Friction that rises, is negative or not finite is refused by name."""
    with pytest.raises(ns.InvalidInput, match=r"Stribeck\.fast_friction must be at most .* 0\.2.*0\.3"):
        Stribeck(0.2, 1.0, 0.3)
    with pytest.raises(ns.InvalidInput, match=r"Stribeck\.static_friction"):
        Stribeck(-0.1, 1.0)
    with pytest.raises(ns.InvalidInput, match=r"Stribeck\.decay"):
        Stribeck(0.1, math.nan)


@pytest.mark.parametrize(("decay", "fast"), [(0.0, 0.0), (3.0, 0.0), (0.5, 0.1)])
def test_time_to_stop(decay: float, fast: float) -> None:
    """A block stops when the closed form says: g t is the integral of dv / mu(v)."""
    static, speed, gravity = 0.3, 1.5, 9.81
    plate, block = Plate(), PlanarBody(2.0, 1.0, (Point(),))
    system = ns.System([plate, block], gravity)
    law = Stribeck(static, decay, fast)
    system.contact(plate, block, normal=Unilateral(), friction=law, impact=EnergeticImpact(0.0))
    system.place(block, velocity=(speed, 0.0))
    solution = ns.simulate(system, 2.0, engine=ns.EventDriven(tolerance=1e-12))
    if fast == 0.0:
        integral = (speed + 0.5 * decay * speed**2) / static
    else:
        # 1 / mu = (1 + d v) / (s + f d v) = 1/f - (s - f) / (f (s + f d v))
        ratio = 1.0 + fast * decay * speed / static
        integral = speed / fast - (static - fast) / (fast**2 * decay) * math.log(ratio)
    assert solution.events.causes() == ["start", "slip to stick"]
    assert solution.events.time[1] == pytest.approx(integral / gravity, abs=1e-9)
    assert solution.energy.friction_loss == pytest.approx(0.5 * 2.0 * speed**2, rel=1e-10)


def test_without_fall_it_is_coulomb() -> None:
    """With decay 0 it has Coulomb's coefficient at every speed."""
    one, two = Stribeck(0.3, 0.0), Coulomb(0.3)
    for speed in (0.0, 1e-300, 1.0, 1e6):
        assert one.coefficient(speed, **one.numbers()) == two.coefficient(speed, **two.parameters())
