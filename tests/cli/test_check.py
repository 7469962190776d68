"""``nonsmooth check``."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.plugins import registry

Call = Callable[..., tuple[int, str, str]]


@pytest.mark.slow
def test_a_law_that_conforms(call: Call) -> None:
    """One line per property, with what it says, and a count."""
    status, output, _ = call("check", "stribeck", "--set", "static_friction=0.3", "--set", "decay=2")
    assert status == 0
    lines = output.splitlines()
    assert lines[0].startswith("stribeck: law of nonsmooth")
    assert any(line.split()[:3] == ["holds", "declared", "bounds"] for line in lines)
    assert lines[-1].split()[1:4] == ["hold,", "0", "fail,"]


_LONE = """
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from nonsmooth.certificates import follows_map
from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter


@dataclass(frozen=True)
class Lone(ImpactMap):
    one_contact: ClassVar[bool] = True
    departures: ClassVar[Mapping[str, str]] = {"force and impact level": "it has no friction"}
    restitution: float = parameter(0.5, doc="ratio of the rates", minimum=0.0, maximum=1.0)
    contact_time: float = parameter(2e-5, doc="contact time", unit="s", minimum=0.0)

    @staticmethod
    def impulses(n, delassus, rates, out, friction, restitution):
        if n > 1:
            raise ValueError("one contact only")
        out[0] = -(1.0 + restitution[0]) * min(rates[0], 0.0) / delassus[0]
        out[1] = out[2] = 0.0

    def is_fulfilled(self, delassus, before, impulses, friction, tolerance):
        return follows_map(self, delassus, before, impulses, friction, tolerance)
"""


_ONE_SHAPE = """
from dataclasses import dataclass

from bodies import FreeBody, Sphere


@dataclass(frozen=True)
class OneShape(FreeBody):
    total_mass = 1.0
    inertia = (1.0, 1.0, 1.0)
    shapes = Sphere(0.1)
"""


@pytest.mark.slow
def test_a_class_of_a_file(call: Call, tmp_path: Path) -> None:
    """A map of one contact alone, which raises for more: it is asked for no more."""
    (tmp_path / "lone.py").write_text(_LONE)
    status, output, _ = call("check", f"{tmp_path / 'lone.py'}:Lone", "--set", "restitution=0.4")
    assert status == 0
    lines = output.splitlines()
    assert lines[0] == f"Lone: law of {tmp_path / 'lone.py'}"
    words = lines[-1].split()
    assert words[1:4] == ["hold,", "0", "fail,"]
    assert int(words[0]) > 15


def test_what_is_not_looked_at_for_one_reason_is_told_once(call: Call, tmp_path: Path) -> None:
    """A map that raises for more than one contact, and does not say that it is one of a single contact."""
    file = tmp_path / "lone.py"
    file.write_text(_LONE.replace("    one_contact: ClassVar[bool] = True\n", ""))
    status, output, _ = call("check", f"{file}:Lone")
    assert status == 1
    assert output.count("not checked, as 'finite numbers' does not hold") == 1
    line = 1 + file.read_text().splitlines().index('            raise ValueError("one contact only")')
    assert f"raises ValueError: one contact only, in Lone.impulses in {file}, line " in output
    assert f", at line {line}" in output


def test_shapes_that_are_no_tuple_are_told_with_file_and_line(call: Call, tmp_path: Path) -> None:
    file = tmp_path / "one.py"
    file.write_text(_ONE_SHAPE)
    status, output, errors = call("check", f"{file}:OneShape")
    assert (status, output) == (2, "")
    assert "OneShape.shapes must be a tuple of shapes, but it is Sphere(" in errors
    assert f"See OneShape in {file}, line " in errors
    assert errors.count("\n") == 1


def test_a_file_without_such_a_class(call: Call, tmp_path: Path) -> None:
    """The class that is meant is told."""
    (tmp_path / "lone.py").write_text(_LONE)
    status, _, errors = call("check", f"{tmp_path / 'lone.py'}:Lonely")
    assert status == 2
    assert "Did you mean 'Lone'?" in errors


@pytest.mark.slow
def test_a_known_departure_is_no_failure(call: Call) -> None:
    """It is told, with the reason."""
    status, output, _ = call("check", "newton")
    assert status == 0
    assert "  departs  dissipation with friction" in output
    assert "Kane's example" in output


@pytest.mark.slow
def test_failures_are_told_and_status_is_1(call: Call) -> None:
    """A scenario whose summary fails: which property, and what was raised."""
    status, output, errors = call("check", "tiny", "--set", "mode=bad summary", "--json")
    assert status == 1
    assert "a plug-in that prints" in errors
    found = json.loads(output)
    assert (found["name"], found["status"]) == ("tiny", "fails")
    (part,) = found["components"]
    assert (part["kind"], part["source"]) == ("scenario", "tiny 0.1")
    failed = {row["property"]: row for row in part["properties"] if row["outcome"] == "fails"}
    assert set(failed) == {"summary", "only reads"}
    assert "ZeroDivisionError: a summary that fails" in failed["summary"]["message"]


@pytest.mark.slow
def test_a_law_that_is_no_number(call: Call) -> None:
    """The run stops, and what follows from it is not looked at."""
    status, output, _ = call("check", "tiny", "--set", "mode=nan law", "--set", "radius=1e-3")
    assert status == 1
    assert "  fails        runs" in output
    assert "  not checked  energy" in output
    assert "NotANumber: _nan in" in output


@pytest.mark.slow
def test_every_kind_of_that_name(call: Call) -> None:
    """A body and a scenario share a name."""
    status, output, _ = call("check", "dumbbell")
    assert status == 0
    assert [line for line in output.splitlines() if line.startswith("dumbbell: ")] == [
        f"dumbbell: {kind} of nonsmooth 0.2.0" for kind in ("body", "scenario")
    ]


ONE_OF_A_KIND = {
    "bodies": "line_body",
    "distances": "fcl",
    "engines": "event_driven",
    "guards": "tilt_guard",
    "joints": "ball_joint",
    "kinematics": "ground-point",
    "laws": "stribeck",
    "loads": "function_load",
    "motions": "table",
    "scenarios": "sliding_rod",
    "shapes": "convex_hull",
}
"""One name for each group; what the properties say of all others is in tests/testing."""


def test_there_is_one_of_every_kind() -> None:
    assert set(ONE_OF_A_KIND) == set(registry.GROUPS)


@pytest.mark.fast_cases(1)
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize("name", ONE_OF_A_KIND.values())
def test_a_built_in_of_every_kind_is_checked(call: Call, name: str) -> None:
    """By its name alone: what numbers cannot give is in the example of its class."""
    status, output, _ = call("check", name)
    assert status == 0, output
    held, _, failed, _ = output.splitlines()[-1].split()[:4]
    assert int(held) > 0
    assert failed == "0"


@pytest.mark.slow
def test_an_example_takes_parameters(call: Call) -> None:
    """Those that are set come before those of the example."""
    status, output, _ = call("check", "rod", "--set", "centre_distance=0.3", "--json")
    assert status == 0
    assert json.loads(output)["status"] == "holds"
    assert "no principal moment" in call("check", "rod", "--set", "radius=0.5")[2]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("coulmb",), "Did you mean 'coulomb'"),
        (("coulomb", "--set", "frction=0.2"), "Did you mean 'friction'"),
        (("coulomb", "--set", "friction=-1"), "must be >= 0"),
        (("rigid_body", "--set", "mass=-1"), "RigidBody.mass must be > 0"),
        (("ground-sphere", "--set", "radius_b=1"), "must be left out"),
    ],
)
def test_wrong_requests(call: Call, words: tuple[str, ...], told: str) -> None:
    """Status 2, and what would be right."""
    status, output, errors = call("check", *words)
    assert (status, output) == (2, "")
    assert told in errors
