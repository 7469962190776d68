"""Restitution at velocity level: what every impact law says of a contact by itself."""

from __future__ import annotations

import pytest

import nonsmooth as ns
from laws import (
    EnergeticImpact,
    JohnsonImpact,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    StrongeImpact,
    ViscoelasticImpact,
)
from laws.impact.johnson import johnson_restitution
from laws.impact.viscoelastic import viscoelastic_restitution
from nonsmooth.interfaces import ImpactLaw
from nonsmooth.plugins import registry

OF_ONE = (EnergeticImpact, MonoStiffnessImpact, MoreauImpact, NewtonImpact, PoissonImpact, StrongeImpact)
SPEEDS = (1e-3, 0.05, 3.0)


def test_laws_of_one_coefficient() -> None:
    """A contact by itself tells none of them from the others."""
    for law in OF_ONE:
        for e in (0.0, 0.3, 1.0):
            for speed in SPEEDS:
                assert ns.restitution(law(restitution=e), speed) == pytest.approx(e, abs=1e-8), law


def test_laws_of_speed() -> None:
    """Their closed forms; of the plastic law nothing."""
    for speed in SPEEDS:
        assert ns.restitution(PlasticImpact(), speed) == 0.0
        johnson = JohnsonImpact(elastic_speed=0.02)
        assert ns.restitution(johnson, speed) == pytest.approx(johnson_restitution(speed, 0.02), abs=1e-8)
        viscous = ViscoelasticImpact(reference_speed=40.0)
        assert ns.restitution(viscous, speed) == pytest.approx(viscoelastic_restitution(speed, 40.0), abs=1e-7)


def test_no_installed_law_is_left_out() -> None:
    """Whatever is installed has one or is looked at here."""
    known = {*OF_ONE, PlasticImpact, JohnsonImpact, ViscoelasticImpact}
    own = {law for law in registry.load_all("laws").values() if law.__module__.startswith("nonsmooth.laws.")}
    assert {law for law in own if issubclass(law, ImpactLaw)} == known


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan")])
def test_speeds_that_are_none(speed: float) -> None:
    """Named, with the rule."""
    with pytest.raises(ns.InvalidInput, match="restitution: speed must be positive and finite"):
        ns.restitution(NewtonImpact(0.5), speed)
