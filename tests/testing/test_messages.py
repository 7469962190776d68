"""What an author is told of a wrong value: where it is, and an input of a size that says something."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, FreeBody, Plate, Sphere
from bodies.values import read_start
from laws import Unilateral
from nonsmooth.errors import MissingPackagesError, PluginError
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import NamesAndUnits, Vector
from nonsmooth.parameters import parameter
from nonsmooth.testing import check_body, check_friction_law, check_normal_law, check_scenario, inputs
from nonsmooth.testing.claims import claim
from nonsmooth.testing.component import make
from nonsmooth.testing.inputs import number, simplified
from nonsmooth.testing.outcome import Broken as Fault
from nonsmooth.testing.registered import check_class
from tests.testing import compliant_dummies, friction_dummies, scenario_dummies, stateful_dummies
from tests.testing.caught import failures

_HERE = Path(__file__)
_count = itertools.count()


def _line(words: str, file: Path = _HERE) -> str:
    """Return where the first line with some words stands, as messages say it."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return f"{file}, line {next(i for i, line in enumerate(lines, start=1) if words in line)}"


@pytest.mark.parametrize(
    ("function", "told"),
    [
        (friction_dummies.array, "Friction.coefficient(0) returns array([0.3]), in array in "),
        (friction_dummies.power, "(a power of a negative number), in power in "),
    ],
)
def test_a_value_that_is_no_number(function: Callable[..., Any], told: str) -> None:
    """It is found by the first property of all, and those that follow from it are not looked at."""
    found = failures(check_friction_law(friction_dummies.Friction(function=function)))
    assert list(found) == ["finite numbers"]
    message = str(found["finite numbers"])
    assert told in message
    assert _line(f"def {function.__name__}(", Path(friction_dummies.__file__)) in message
    assert "not one number" in message


def test_a_power_without_a_guard() -> None:
    """Steps end past the reach, where the power of a negative number is complex."""
    law = compliant_dummies.Compliant(function=compliant_dummies.unguarded)
    message = str(failures(check_normal_law(law))["finite numbers"])
    assert "Compliant.force(-1e-06, 0, 0) returns (" in message
    assert "power of a negative number" in message
    assert _line("def unguarded", Path(compliant_dummies.__file__)) in message


def test_a_wrong_sign_is_called_one() -> None:
    law = compliant_dummies.Compliant(function=compliant_dummies.turned_round)
    found = failures(check_normal_law(law))
    assert list(found) == ["pulls within its reach"]
    assert "a negative force pulls: it has the wrong sign" in str(found["pulls within its reach"])


@pytest.mark.slow
def test_a_wrong_value_comes_with_the_place_of_the_class() -> None:
    law = friction_dummies.Friction(function=friction_dummies.negative)
    message = str(failures(check_friction_law(law))["not negative"])
    # some versions of Python count from the decorator
    place = Path(friction_dummies.__file__)
    lines = place.read_text(encoding="utf-8").splitlines()
    number = lines.index("class Friction(FrictionLaw):") + 1
    assert any(message.endswith(f" See Friction in {place}, line {n}.") for n in (number - 1, number))


@dataclass(frozen=True)
class Restless(FreeBody):
    """A body that starts elsewhere each time."""

    @property
    def total_mass(self) -> float:
        return 1.0

    @property
    def inertia(self) -> tuple[float, float, float]:
        return 1.0, 1.0, 1.0

    @property
    def shapes(self) -> tuple[Shape, ...]:
        return (Sphere(0.1),)

    def state(self, **start: Any) -> tuple[Vector, Vector]:  # the line of a message
        q, u = super().state(**start)
        return q, u + 1e-3 * next(_count)


def test_a_start_that_is_random() -> None:
    message = str(failures(check_body(Restless()))["start"])
    assert "`state` gives another start each time: Restless.state in " in message
    assert _line("# the line of a message") in message


@dataclass(frozen=True)
class Shapely(Restless):
    """A body whose shapes are no tuple."""

    @property
    def shapes(self) -> Any:
        return Sphere(0.1)


@dataclass(frozen=True)
class Flat(Restless):
    """A body with two moments of inertia."""

    @property
    def inertia(self) -> Any:
        return 1.0, 1.0


@dataclass(frozen=True)
class Broken(Restless):
    """A body that raises when it is made."""

    @property
    def total_mass(self) -> float:
        return 1.0 / len([])  # raised here


def test_shapes_that_are_no_tuple() -> None:
    told = r"Shapely.shapes must be a tuple of shapes, but it is Sphere\(.*Give shapes, for example"
    with pytest.raises(ns.InvalidInput, match=told):
        ns.simulate(ns.System([Shapely()]), 0.1)
    with pytest.raises(ns.InvalidInput, match=rf"{told}.* See Shapely in {_HERE}, line "):
        check_class(Shapely, "shapely", {})


def test_moments_that_are_not_three() -> None:
    with pytest.raises(ns.InvalidInput, match=r"Flat.inertia must be three numbers, but it is \(1.0, 1.0\)"):
        Flat()


def test_a_class_that_raises_when_it_is_made() -> None:
    with pytest.raises(PluginError) as caught:
        make(Broken, "broken", {})
    assert "broken cannot be made with {}: it raises ZeroDivisionError: " in str(caught.value)
    assert str(caught.value).endswith(f"in {_line('# raised here')}.")


@dataclass(frozen=True)
class Nothing(scenario_dummies.Bounce):
    """A scenario whose `build` returns nothing."""

    def build(self) -> Any:  # builds none
        return None


@dataclass(frozen=True)
class Chance(scenario_dummies.Bounce):
    """A scenario with a random start."""

    def build(self) -> ns.System:  # builds another
        system = ns.System([Plate(), Ball(0.01)])
        system.exclude(*system.bodies)
        system.place(system.bodies[1], position=(0.0, 0.0, 1.0 + 0.001 * next(_count)))
        return system


def test_a_scenario_that_builds_nothing() -> None:
    message = str(failures(check_scenario(Nothing(), t_end=0.1))["builds twice"])
    assert "`build` returns no System: Nothing.build in " in message
    assert _line("# builds none") in message


def test_a_scenario_with_a_random_start() -> None:
    found = failures(check_scenario(Chance(), t_end=0.1))
    assert _line("# builds another") in str(found["builds twice"])
    assert "two runs differ. With q = 1." in str(found["repeatable"])


@dataclass(frozen=True)
class Upwards(Body):
    """A body on a vertical line that falls upwards, as one with a wrong sign."""

    mass: float = parameter(0.01, doc="mass", unit="kg", above=0.0)

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        return ((Sphere(0.005),),)

    @property
    def q_labels(self) -> NamesAndUnits:
        return (("height", "m"),)

    @property
    def u_labels(self) -> NamesAndUnits:
        return (("speed", "m/s"),)

    @property
    def quaternion(self) -> int:
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        return upwards

    @property
    def scales(self) -> tuple[Vector, Vector]:
        return np.array([0.005]), np.array([0.2])

    @property
    def time_scale(self) -> float:
        return math.inf

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        values = read_start("Upwards", {}, start)
        return np.full(1, len(values)), np.zeros(1)


def upwards(t: Any, q: Any, u: Any, out: Any, mass: Any, gravity_z: Any) -> None:
    out[2], out[14] = q[0], u[0]
    out[3] = out[7] = out[11] = out[26] = 1.0
    out[30], out[31], out[32] = u[0], -mass * gravity_z, 1.0 / mass
    out[33], out[34] = 0.5 * mass * u[0] ** 2, -mass * gravity_z * q[0]


@pytest.mark.slow
def test_the_smallest_input_has_a_size_that_means_something() -> None:
    """A fault that is there at any speed is not told at 1e-46 m/s."""
    failure = failures(check_body(Upwards()))["energy in free flight"]
    assert 1e-4 < abs(failure.case["u1"]) < 1e-2
    drawn = [number("x", -1.0, 1.0)]
    assert simplified(drawn, {"x": 0.7}, lambda case: case["x"] != 0.0, 20)["x"] == pytest.approx(1e-3, rel=1e-9)
    assert simplified(drawn, {"x": 0.7}, lambda case: True, 20) == {"x": 0.0}


def test_a_compiled_function_that_does_not_come_back_is_named() -> None:
    """Integers of compiled code wrap round, so that a loop ends in plain Python and not compiled."""
    law = stateful_dummies.Warm(change=stateful_dummies.wrapping)
    found = failures(check_friction_law(law))
    assert list(found) == ["compiled equals plain"]
    message = str(found["compiled equals plain"])
    assert "compiled, Warm.rates(0, [0.0]) takes longer than 1 s in wrapping in " in message
    assert _line("def wrapping(", Path(stateful_dummies.__file__)) in message


def test_a_process_that_crashes_is_named() -> None:
    """The property that ended it, and how; the others are not checked, and the next component is."""
    law = friction_dummies.Friction(function=friction_dummies.crashing)
    found = failures(check_friction_law(law))
    assert list(found) == ["time budget"]
    assert "the process that checks it ends with status" in str(found["time budget"])
    assert failures(check_normal_law(Unilateral())) == {}


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inputs, "_PACKAGES", ("hypothesis", "no_such_package"))
    with pytest.raises(MissingPackagesError, match=r'no_such_package: pip install "nonsmooth\[testing\]"'):
        check_normal_law(Unilateral())


def test_a_fault_that_comes_and_goes_is_said_to_be_random() -> None:
    """One that was there once is told as it was."""
    told = iter(["it is 3 N"])

    @claim(number("x", 0.0, 1.0))
    def _force(component: Ball, x: float) -> str:
        """It is no force."""
        return next(told, "")

    with pytest.raises(Fault, match="it is 3 N; tried again, it holds: something is random"):
        _force.examine([Ball(0.1)], 1)
