"""Every fault of a body, a pair or a scenario is caught by the property made for it, and by few others."""

from __future__ import annotations

from typing import Any

import pytest

from nonsmooth.interfaces import Body, ContactKinematics, Scenario
from nonsmooth.testing import check_body, check_contact_kinematics
from tests.testing import body_dummies, friction_dummies, pair_dummies, scenario_dummies
from tests.testing.caught import assert_caught, failures
from tests.testing.pair_dummies import FIRST, SECOND, Pair


def _cases(dummies: list[tuple[str, Any]]) -> Any:
    return pytest.mark.parametrize(("name", "thing"), dummies, ids=[f"{n} {i}" for i, (n, _) in enumerate(dummies)])


@_cases(body_dummies.DUMMIES)
def test_body(name: str, thing: Body) -> None:
    assert_caught(check_body(thing), name)


@_cases(pair_dummies.DUMMIES)
def test_kinematics(name: str, thing: ContactKinematics) -> None:
    assert_caught(check_contact_kinematics(thing, FIRST, SECOND), name)


@_cases(scenario_dummies.DUMMIES)
def test_scenario(name: str, thing: Scenario) -> None:
    assert_caught(scenario_dummies.checked(thing), name)


@pytest.mark.parametrize(
    ("properties", "dummies"),
    [
        (check_body(body_dummies.Ball()), body_dummies.DUMMIES),
        (check_body(body_dummies.Swing()), body_dummies.DUMMIES),
        (check_contact_kinematics(Pair(), FIRST, SECOND), pair_dummies.DUMMIES),
        (scenario_dummies.checked(scenario_dummies.Bounce()), scenario_dummies.DUMMIES),
    ],
    ids=["free body", "driven body", "kinematics", "scenario"],
)
def test_sound_ones(properties: Any, dummies: Any) -> None:
    """Without a fault nothing is caught, and no property is there that no fault breaks."""
    broken = {name for name, _ in dummies} | {name for name, _ in friction_dummies.DUMMIES}
    assert {prop.name for prop in properties} <= broken
    assert failures(properties) == {}


def test_the_failing_state_is_small() -> None:
    """A velocity that is too high in one direction is shown by that direction alone."""
    failure = assert_caught(check_body(body_dummies.Ball(body_dummies.FAULTS["velocity"])), "velocity")
    assert {name for name, value in failure.case.items() if value != 0.0} == {"u1"}
    assert "frame 0" in str(failure)
