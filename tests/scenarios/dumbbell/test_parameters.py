"""What the scenario refuses, what it asks about, and what it takes for what is left out."""

from __future__ import annotations

import math
import warnings
from typing import Any

import pytest

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.parameters import UnusualValue, from_words, rules
from scenarios.dumbbell import DumbbellScenario

NUMBERS = [name for name, (_, rule) in rules(DumbbellScenario).items() if rule.unit != ""]
POSITIVE = ["t_end", "radius", "density", "frequency", "aspect_ratio"]
NOT_NEGATIVE = ["rod_mass_fraction", "restitution", "friction", "static_friction", "gamma", "height", "contact_time"]
UNUSUAL = {
    "t_end": 1e6,
    "radius": 10.0,
    "aspect_ratio": 3900.0,
    "density": 7.8,
    "friction": 20.0,
    "gamma": 900.0,
    "frequency": 25e3,
    "phase": 30.0,
    "beta0": 1.5,
    "transverse_velocity": 1000.0,
    "vertical_velocity": 196.2,
    "pitch_rate": -9600.0,
    "height": 1000.0,
    "contact_time": 20.0,
}


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "1", True])
def test_no_number(name: str, value: object) -> None:
    given: dict[str, Any] = {name: value}
    with pytest.raises(InvalidInput, match=name):
        DumbbellScenario(**given)


@pytest.mark.parametrize("name", POSITIVE + NOT_NEGATIVE)
def test_wrong_sign(name: str) -> None:
    given: dict[str, Any] = {name: -0.5}
    with pytest.raises(InvalidInput, match=name):
        DumbbellScenario(**given)


@pytest.mark.parametrize("name", POSITIVE)
def test_zero_where_it_must_be_positive(name: str) -> None:
    given: dict[str, Any] = {name: 0.0}
    with pytest.raises(InvalidInput, match=name):
        DumbbellScenario(**given)


@pytest.mark.parametrize("name", UNUSUAL)
def test_wrong_order_of_magnitude_is_a_warning(name: str) -> None:
    given: dict[str, Any] = {name: UNUSUAL[name]}
    with pytest.warns(UnusualValue, match=f"DumbbellScenario.{name}") as caught:
        scenario = DumbbellScenario(**given)
    assert len(caught) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scenario.build()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"mode": "drfit"}, "'drift'"),
        ({"impact": "energetc"}, "'energetic'"),
        ({"impact": "coulomb"}, "energetic, johnson"),
    ],
)
def test_unknown_names_come_with_a_suggestion(given: dict[str, Any], words: str) -> None:
    with pytest.raises(UnknownName, match=words):
        DumbbellScenario(**given)


def test_unknown_parameter_comes_with_a_suggestion() -> None:
    with pytest.raises(UnknownName, match="'restitution'"):
        from_words(DumbbellScenario, {"restitutoin": "0.5"}, "dumbbell")


def test_friction_at_rest_is_not_below_sliding_friction() -> None:
    with pytest.raises(InvalidInput, match="static_friction"):
        DumbbellScenario(friction=0.3, static_friction=0.2)
    assert DumbbellScenario(friction=0.3).resolved()["static_friction"] == 0.3


def test_ball_2_does_not_start_in_the_plate() -> None:
    with pytest.raises(InvalidInput, match="ball 2 into the plate"):
        DumbbellScenario(beta0=-0.1)
    assert DumbbellScenario(beta0=-0.1, height=0.01).build()


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        ("drift", {"aspect_ratio": 3.9, "restitution": 0.65, "beta0": math.radians(10.0), "vertical_velocity": 0.0}),
        ("jump", {"beta0": 0.0, "vertical_velocity": 0.1962, "phase": 0.0}),
        ("flutter", {"aspect_ratio": 5.7, "restitution": 0.8, "phase": math.pi / 6.0, "pitch_rate": -9.6}),
        ("free", {"beta0": math.radians(10.0), "height": 0.0}),
    ],
)
def test_what_is_left_out_follows_the_mode(mode: str, expected: dict[str, float]) -> None:
    used = DumbbellScenario(mode=mode).resolved()
    assert {name: used[name] for name in expected} == pytest.approx(expected)
    assert None not in used.values()


def test_the_start_lies_on_the_moving_plate() -> None:
    scenario = DumbbellScenario(mode="flutter", height=1e-3)
    system = scenario.build()
    q, _ = system.start(system.bodies[1])
    sine = math.sin(math.radians(11.0))
    expected = scenario.radius + 1e-3 + scenario.amplitude / 2.0 + scenario.centre_distance / 2.0 * sine
    assert q[2] == pytest.approx(expected, abs=1e-15)
