"""Every fault of a law is caught by the property made for it, and by few others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import FrictionLaw, ImpactLaw, NormalLaw, TractionLaw
from nonsmooth.testing import (
    PropertyFailed,
    check_friction_law,
    check_impact_law,
    check_normal_law,
    check_traction_law,
)
from nonsmooth.testing.child import stop_child
from tests.testing import (
    anisotropic_dummies,
    compliant_dummies,
    friction_dummies,
    impact_dummies,
    normal_dummies,
    stateful_dummies,
    traction_dummies,
)
from tests.testing.caught import assert_caught, failures

_compiled = pytest.mark.skipif(PLAIN, reason="impacts take minutes in plain mode")


def _cases(dummies: Sequence[tuple[str, Any]]) -> pytest.MarkDecorator:
    titles = [f"{name}, {type(law).__name__} {i}" for i, (name, law) in enumerate(dummies)]
    return pytest.mark.parametrize(("name", "law"), dummies, ids=titles)


@pytest.mark.fast_cases(1)
@_cases(friction_dummies.DUMMIES)
def test_friction(name: str, law: FrictionLaw) -> None:
    if PLAIN and name in ("compiled equals plain", "static limit"):
        pytest.skip("nothing is compiled in plain mode, and a search without an answer takes minutes")
    assert_caught(check_friction_law(law), name)


@pytest.mark.slow
@_compiled
@_cases(impact_dummies.DUMMIES)
def test_impact(name: str, law: ImpactLaw) -> None:
    assert_caught(check_impact_law(law), name)


@_cases(normal_dummies.DUMMIES)
def test_normal(name: str, law: NormalLaw) -> None:
    assert_caught(check_normal_law(law), name)


@pytest.mark.fast_cases(1)
@_compiled
@_cases(compliant_dummies.DUMMIES)
def test_compliant(name: str, law: NormalLaw) -> None:
    assert_caught(check_normal_law(law), name)


@pytest.mark.fast_cases(2)
@_compiled
@_cases(anisotropic_dummies.DUMMIES)
def test_anisotropic(name: str, law: FrictionLaw) -> None:
    assert_caught(check_friction_law(law), name)


@pytest.mark.fast_cases(2)
@_compiled
@_cases(stateful_dummies.DUMMIES)
def test_stateful(name: str, law: FrictionLaw) -> None:
    assert_caught(check_friction_law(law), name)


@pytest.mark.slow
@_compiled
@_cases(traction_dummies.DUMMIES)
def test_traction(name: str, law: TractionLaw) -> None:
    assert_caught(check_traction_law(law), name)


def test_every_property_has_a_dummy() -> None:
    """No property of a law is there that no fault breaks; those of functions are shared by all kinds."""
    shared = {name for name, _ in friction_dummies.DUMMIES}
    kinds: list[tuple[Any, Any, Any]] = [
        (friction_dummies, check_friction_law, friction_dummies.Friction()),
        (impact_dummies, check_impact_law, impact_dummies.Process()),
        (impact_dummies, check_impact_law, impact_dummies.Map()),
        (normal_dummies, check_normal_law, normal_dummies.Normal()),
        (compliant_dummies, check_normal_law, compliant_dummies.Compliant()),
        (anisotropic_dummies, check_friction_law, anisotropic_dummies.Skewed()),
        (stateful_dummies, check_friction_law, stateful_dummies.Warm()),
        (traction_dummies, check_traction_law, traction_dummies.Brush()),
    ]
    for module, check, example in kinds:
        broken = {name for name, _ in module.DUMMIES} | shared
        assert {prop.name for prop in check(example)} <= broken


@pytest.mark.slow
@pytest.mark.parametrize(
    "properties",
    [
        check_friction_law(friction_dummies.Friction()),
        check_friction_law(friction_dummies.Friction(function=friction_dummies.growing)),
        check_impact_law(impact_dummies.Process()),
        check_impact_law(impact_dummies.Map()),
        check_normal_law(normal_dummies.Normal()),
        check_normal_law(compliant_dummies.Compliant()),
        check_normal_law(compliant_dummies.Compliant(function=compliant_dummies.pulling, gap=1e-3)),
        check_friction_law(anisotropic_dummies.Skewed()),
        check_friction_law(anisotropic_dummies.Skewed(function=friction_dummies.growing)),
        check_friction_law(stateful_dummies.Warm()),
        check_traction_law(traction_dummies.Brush()),
    ],
    ids=[
        "friction",
        "growing friction",
        "process",
        "map",
        "normal",
        "compliant",
        "cohesive",
        "anisotropic",
        "growing anisotropic",
        "stateful",
        "traction",
    ],
)
def test_without_a_fault_nothing_is_caught(properties: Any) -> None:
    """The dummies are sound but for their faults."""
    assert failures(properties) == {}


@pytest.mark.slow
def test_message_names_all() -> None:
    """Law, property, parameter, value and the smallest failing input."""
    failure = failures(check_friction_law(friction_dummies.Friction(function=friction_dummies.negative)))[
        "not negative"
    ]
    assert (failure.thing, failure.prop, failure.parameter, failure.value) == ("Friction", "not negative", "level", 0.3)
    assert 5.0 <= failure.case["slip_speed"] < 10.0
    for word in ("Friction", "'not negative'", "level = 0.3", "Smallest failing input: slip_speed = "):
        assert word in str(failure)
    assert isinstance(failure, AssertionError)


@_compiled
def test_a_property_alone_has_its_own_time() -> None:
    """A property that is called first compiles and loads the engine before its first trial, for more than a second."""
    (prop,) = (p for p in check_friction_law(friction_dummies.Friction()) if p.name == "sustained contact")
    stop_child()
    prop()


@pytest.mark.slow
@_compiled
def test_smallest_input() -> None:
    """A fault above a threshold is shrunk to a round number next to it, other numbers to their simplest."""
    law = impact_dummies.Map(function=impact_dummies.fast)
    case = failures(check_impact_law(law))["scaling of velocities"].case
    moved = {name for name, value in case.items() if value not in (0.0, -1.0, 0.2, 2.0)}
    assert moved <= {"factor"}


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(
    ("function", "name", "words"),
    [
        (friction_dummies.endless, "time budget", ("coefficient(", "takes longer than 1 s", "endless in", "at line")),
        (friction_dummies.nan, "finite numbers", ("is nan", "nan in", "friction_dummies.py, line")),
        (friction_dummies.raising, "finite numbers", ("raises ValueError: too fast", "friction_dummies.py", "at line")),
        (
            friction_dummies.absent,
            "known parameters",
            ("stifness", "Known: level", "declared as one: stifness: float = parameter(", "friction_dummies.py, line"),
        ),
    ],
)
def test_source_lines(function: Any, name: str, words: tuple[str, ...]) -> None:
    """What a function does wrong is said with its name, file and line, and nothing else of it is run."""
    found = failures(check_friction_law(friction_dummies.Friction(function=function)))
    assert list(found) == [name]
    for word in words:
        assert word in str(found[name])


@pytest.mark.slow
@_compiled
def test_a_departure_must_be_one() -> None:
    """A class that says it departs from a property that it has is told so."""
    prop = next(p for p in check_impact_law(impact_dummies.Modest()) if p.name == "cone")
    with pytest.raises(PropertyFailed, match="it holds, although"):
        prop()
    assert "dissipaton" in str(failures(check_impact_law(impact_dummies.Misspelt()))["departures"])
