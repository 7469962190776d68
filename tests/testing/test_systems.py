"""Every fault of what a system is made of is caught by the property made for it, and by few others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from bodies import Plane
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    Body,
    DistanceBackend,
    Engine,
    FeaturePair,
    Guard,
    Joint,
    Load,
    Motion,
    Scenario,
    Shape,
)
from nonsmooth.testing import (
    Departs,
    NotChecked,
    check_body,
    check_contact_kinematics,
    check_distance_backend,
    check_engine,
    check_guard,
    check_joint,
    check_load,
    check_motion,
    check_shape,
)
from tests.testing import (
    body_dummies,
    distance_dummies,
    engine_dummies,
    friction_dummies,
    joint_dummies,
    load_dummies,
    motion_dummies,
    pair_dummies,
    scenario_dummies,
)
from tests.testing.caught import assert_caught, failures
from tests.testing.pair_dummies import FIRST, SECOND, Pair


def _cases(dummies: Sequence[tuple[str, Any]]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("name", "thing"), dummies, ids=[f"{n} {i}" for i, (n, _) in enumerate(dummies)])


@pytest.mark.fast_cases(2)
@_cases(body_dummies.DUMMIES)
def test_body(name: str, thing: Body) -> None:
    assert_caught(check_body(thing), name)


@pytest.mark.fast_cases(1)
@_cases(pair_dummies.DUMMIES)
def test_kinematics(name: str, thing: int) -> None:
    assert_caught(check_contact_kinematics(Pair, FIRST, SECOND, contacts=[thing]), name)


class Nameless(Pair):
    """Contacts whose features have no names."""

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        return tuple(replace(contact, features=()) for contact in super().between(first, second))


class Empty(Pair):
    """No contacts."""

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        return ()


def test_kinematics_that_give_nothing_to_check_are_refused() -> None:
    """By the rule that is broken."""
    for kinematics, second, words in (
        (Nameless, SECOND, "Nameless: features must be different names"),
        (Empty, SECOND, "Empty.between must return a contact"),
        (Pair, Plane(), "Pair: shape must be a Sphere"),
    ):
        with pytest.raises(InvalidInput, match=words):
            check_contact_kinematics(kinematics, FIRST, second)


@_cases(distance_dummies.DUMMIES)
def test_distances(name: str, thing: DistanceBackend) -> None:
    assert_caught(check_distance_backend(thing), name)


def test_a_library_is_looked_at_if_it_is_there() -> None:
    """Right answers hold; of a library that is not installed nothing is looked at."""
    assert not failures(check_distance_backend(distance_dummies.Balls()))
    for prop in check_distance_backend(distance_dummies.Balls("not installed")):
        if prop.name in ("points", "order", "planes"):
            with pytest.raises(NotChecked, match="not installed"):
                prop()


@pytest.mark.slow
@_cases(joint_dummies.DUMMIES)
def test_joint(name: str, thing: Joint) -> None:
    assert_caught(check_joint(thing), name)


@pytest.mark.fast_cases(1)
@_cases(load_dummies.DUMMIES)
def test_load(name: str, thing: Load) -> None:
    assert_caught(check_load(thing), name)


@pytest.mark.fast_cases(1)
@_cases(motion_dummies.MOTIONS)
def test_motion(name: str, thing: Motion) -> None:
    assert_caught(check_motion(thing), name)


@pytest.mark.fast_cases(12)
@_cases(motion_dummies.SHAPES)
def test_shape(name: str, thing: Shape) -> None:
    assert_caught(check_shape(thing), name)


@pytest.mark.fast_cases(4)
@pytest.mark.skipif(PLAIN, reason="runs take long in plain mode")
@_cases(engine_dummies.DUMMIES)
def test_engine(name: str, thing: Engine) -> None:
    assert_caught(check_engine(thing), name)


@_cases(motion_dummies.GUARDS)
def test_guard(name: str, thing: Guard) -> None:
    assert_caught(check_guard(thing), name)


@pytest.mark.slow
def test_a_load_that_is_tied_to_space() -> None:
    """A weight turns with nobody; where that is said, of one or of its class, nothing fails."""
    weight = load_dummies.FAULTS["frame invariance"]
    assert set(failures(check_load(load_dummies.Pull(weight)))) == {"frame invariance"}
    assert failures(check_load(load_dummies.Pull(weight), tied_to_space=True)) == {}
    departed = []
    for prop in check_load(load_dummies.Weight()):
        try:
            prop()
        except Departs:
            departed.append(prop.name)
        except NotChecked:
            continue
    assert departed == ["frame invariance"]


@pytest.mark.fast_cases(2)
@pytest.mark.skipif(PLAIN, reason="runs take minutes in plain mode")
@_cases(scenario_dummies.DUMMIES)
def test_scenario(name: str, thing: Scenario) -> None:
    assert_caught(scenario_dummies.checked(thing), name)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("properties", "dummies"),
    [
        (check_body(body_dummies.Flying()), body_dummies.DUMMIES),
        (check_body(body_dummies.Swing()), body_dummies.DUMMIES),
        (check_contact_kinematics(Pair, FIRST, SECOND), pair_dummies.DUMMIES),
        (scenario_dummies.checked(scenario_dummies.Bounce()), scenario_dummies.DUMMIES),
        (check_joint(joint_dummies.Point()), joint_dummies.DUMMIES),
        (check_load(load_dummies.Pull()), load_dummies.DUMMIES),
        (check_motion(motion_dummies.Swing()), motion_dummies.MOTIONS),
        (check_shape(motion_dummies.Blob()), motion_dummies.SHAPES),
        (check_guard(motion_dummies.Threshold()), motion_dummies.GUARDS),
        (check_engine(engine_dummies.Dummy()), engine_dummies.DUMMIES),
    ],
    ids=["free body", "driven body", "kinematics", "scenario", "joint", "load", "motion", "shape", "guard", "engine"],
)
def test_sound_ones(properties: Any, dummies: Any) -> None:
    """Without a fault nothing is caught, and no property is there that no fault breaks."""
    broken = {name for name, _ in dummies} | {name for name, _ in friction_dummies.DUMMIES}
    assert {prop.name for prop in properties} <= broken
    assert failures(properties) == {}


@pytest.mark.slow
def test_the_failing_state_is_small() -> None:
    """A velocity that is too high in one direction is shown by that direction alone."""
    failure = failures(check_body(body_dummies.Ball(body_dummies.FAULTS["velocity"])))["velocity"]
    assert {name for name, value in failure.case.items() if value != 0.0} == {"u1"}
    assert "frame 0" in str(failure)
