"""Friction and normal laws: values, certificates with both sides, bad parameters."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nonsmooth as ns
from laws import (
    Anisotropic,
    Bristle,
    Coulomb,
    EnergeticImpact,
    Frictionless,
    NewtonImpact,
    RateAndState,
    Unilateral,
)
from nonsmooth import InvalidInput
from nonsmooth.parameters import UnusualValue


def test_coulomb_coefficient() -> None:
    """Mu for any slip, mu_s at rest; one number serves for both."""
    law = Coulomb(0.2, 0.3)
    assert law.coefficient(0.0, 0.2, 0.3) == 0.3
    assert law.coefficient(1e-300, 0.2, 0.3) == 0.2
    assert Coulomb(0.2).parameters() == {"friction": 0.2, "static_friction": 0.2}
    assert Frictionless().coefficient(1.0) == 0.0


@given(angle=st.floats(-3.1, 3.1), share=st.floats(0.0, 0.999))
def test_coulomb_certificate(angle: float, share: float) -> None:
    """Inside the static disc at rest, on the kinetic edge against the slip, nowhere else."""
    law, c, s = Coulomb(0.2, 0.3), math.cos(angle), math.sin(angle)
    assert law.is_fulfilled((0.0, 0.0), 2.0, (0.6 * share * c, 0.6 * share * s), 1e-9)
    assert not law.is_fulfilled((0.0, 0.0), 2.0, (0.61 * c, 0.61 * s), 1e-9)
    assert law.is_fulfilled((c, s), 2.0, (-0.4 * c, -0.4 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (0.4 * c, 0.4 * s), 1e-9)
    assert not law.is_fulfilled((c, s), 2.0, (-0.4 * share * c, -0.4 * share * s), 1e-9 * share)


def test_frictionless_certificate() -> None:
    """Zero and nothing else."""
    assert Frictionless().is_fulfilled((1.0, 0.0), 1.0, (0.0, 0.0), 1e-12)
    assert not Frictionless().is_fulfilled((1.0, 0.0), 1.0, (0.0, 1e-6), 1e-12)


@pytest.mark.parametrize(
    ("acceleration", "force", "fulfilled"),
    [(0.0, 1.0, True), (1.0, 0.0, True), (0.0, 0.0, True), (1.0, 1.0, False), (-1.0, 0.0, False), (0.0, -1.0, False)],
)
def test_unilateral_certificate(acceleration: float, force: float, fulfilled: bool) -> None:
    """Complementarity of Eq. (16)."""
    assert Unilateral().is_fulfilled(acceleration, force, 1e-9) is fulfilled


BAD: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (Coulomb, {"friction": -0.1}, ("Coulomb.friction", ">= 0", "-0.1", "kinetic friction coefficient")),
    (Coulomb, {"friction": math.nan}, ("Coulomb.friction", "finite", "nan")),
    (Coulomb, {"friction": "0.2"}, ("Coulomb.friction", "finite number", "'0.2'")),
    (Coulomb, {"friction": True}, ("Coulomb.friction", "finite number", "True")),
    (Coulomb, {"friction": 0.3, "static_friction": 0.2}, ("Coulomb.static_friction", "at least", "0.2", "Raise it")),
    (EnergeticImpact, {"restitution": 1.1}, ("EnergeticImpact.restitution", "<= 1", "1.1")),
    (EnergeticImpact, {"restitution": -0.1}, ("EnergeticImpact.restitution", ">= 0", "-0.1")),
    (EnergeticImpact, {"restitution": math.inf}, ("EnergeticImpact.restitution", "finite", "inf")),
    (EnergeticImpact, {"restitution": 0.5, "stiffness": 0.0}, ("EnergeticImpact.stiffness", "> 0", "0.0", "stiffness")),
    (EnergeticImpact, {"restitution": 0.5, "exponent": 0.5}, ("EnergeticImpact.exponent", ">= 1", "0.5")),
    (EnergeticImpact, {"restitution": 0.5, "duration": -1.0}, ("EnergeticImpact.duration", ">= 0", "-1.0", "(33)")),
    (NewtonImpact, {"restitution": 2.0}, ("NewtonImpact.restitution", "<= 1", "2.0")),
]


@pytest.mark.parametrize(("law", "arguments", "words"), BAD)
def test_bad_parameters(law: Any, arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the thing, the rule, the value and what it is."""
    with pytest.raises(InvalidInput) as caught:
        law(**arguments)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("law", "arguments"), [(Coulomb, {"friction": 50.0}), (EnergeticImpact, {"restitution": 0.5, "duration": 1.0})]
)
def test_unusual_parameters_warn(law: Any, arguments: dict[str, Any]) -> None:
    """An odd order of magnitude is a warning, not an error."""
    with pytest.warns(UnusualValue, match="usual range"):
        law(**arguments)


@pytest.mark.parametrize("law", [Anisotropic(0.2, 0.4), RateAndState(0.3, 0.01, 0.01, 1e-3, 1e-4), Bristle(0.2, 0.3)])
def test_matrices_know_no_axis_and_no_past(law: Any) -> None:
    """The problems on matrices refuse laws that they could not tell from others."""
    mass, normal, tangential = [[1.0]], [[1.0]], [[[0.0, 0.0]]]
    with pytest.raises(InvalidInput, match=type(law).__name__):
        ns.solve_contact(mass, normal, tangential, [-1.0], [law])
    with pytest.raises(InvalidInput, match=type(law).__name__):
        ns.solve_impact(mass, normal, tangential, [-1.0], [EnergeticImpact(0.5)], [law])
