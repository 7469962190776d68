"""Laws that fail or run in Python, from the command line: a warning, an error, what was computed, what a check says."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.engine.native.kernel import PLAIN

Call = Callable[..., tuple[int, str, str]]

_LAW = """
from dataclasses import dataclass
from nonsmooth.interfaces import FrictionLaw, ImpactMap, ImpactProcess
from nonsmooth.parameters import parameter

TABLE = {"level": 1.0}

def endless(x):
    while x > -100.0:
        x = abs(x)
    return x

def by_table(speed, level):
    return level * TABLE["level"]

def lost(speed, level):
    if 0.1 < speed < 0.12:
        raise ValueError("no such speed")
    return level

def turning(speed, level):
    return endless(speed) if speed > 1.0 else level

def misspelt(speed, levle):
    return levle

def spring(indentation):
    return indentation

def share(rate):
    return endless(rate) if rate > 0.5 else 1.0

def turning_map(n, delassus, rates, out, friction):
    for i in range(3 * n):
        out[i] = 0.0
    out[0] = endless(rates[0]) if rates[0] < 0.0 else 0.0

@dataclass(frozen=True)
class Friction(FrictionLaw):
    level: float = parameter(0.2, doc="coefficient", minimum=0.0)

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        return True

@dataclass(frozen=True)
class Table(Friction):
    coefficient = staticmethod(by_table)

@dataclass(frozen=True)
class Lost(Friction):
    coefficient = staticmethod(lost)

@dataclass(frozen=True)
class Turning(Friction):
    coefficient = staticmethod(turning)

@dataclass(frozen=True)
class Misspelt(Friction):
    coefficient = staticmethod(misspelt)

@dataclass(frozen=True)
class Process(ImpactProcess):
    force, efficiency, contact_time = staticmethod(spring), staticmethod(share), 1e-5

    def is_fulfilled(self, stored, returned, tolerance):
        return True

@dataclass(frozen=True)
class Map(ImpactMap):
    impulses, contact_time = staticmethod(turning_map), 1e-5

    def is_fulfilled(self, delassus, before, impulses, friction, tolerance):
        return True
"""
_NAMES = ("Turning", "Misspelt", "Process", "Map")


@pytest.fixture
def law(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a file of laws, four of which are installed, too, under names in small letters."""
    path = tmp_path / "failing_plugin.py"
    path.write_text(_LAW)
    info = tmp_path / "failing-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: failing\nVersion: 0.1\n")
    lines = [f"failing_{name.lower()} = failing_plugin:{name}" for name in _NAMES]
    (info / "entry_points.txt").write_text("\n".join(["[nonsmooth.laws]", *lines, ""]))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "failing_plugin", raising=False)
    return path


@pytest.mark.filterwarnings("default")
def test_a_law_that_runs_in_python_is_one_line_of_warning(call: Call, law: Path) -> None:
    words = ("run", "block_on_belt", "--set", "t_end=1", "--json")
    status, output, errors = call(*words, "--law", f"friction={law}:Table")
    _, expected, _ = call(*words, "--law", "friction=coulomb,friction=0.2")
    assert status == 0
    assert json.loads(output)["final"] == json.loads(expected)["final"]
    told = [line for line in errors.splitlines() if line.startswith("warning: ")]
    if PLAIN:
        assert told == []
        return
    assert len(told) == 1
    for word in ("Table (contact '", f"by_table in {law}, line", '`return level * TABLE["level"]`', "A call takes"):
        assert word in told[0]


@pytest.mark.slow
def test_a_run_that_fails_says_where_and_saves_what_it_has(call: Call, law: Path, tmp_path: Path) -> None:
    results = tmp_path / "results"
    words = ("--set", "t_end=20", "--law", f"friction={law}:Lost", "--out", str(results), "--json")
    status, output, errors = call("run", "block_on_belt", *words)
    report = json.loads(output)
    assert (status, report["status"]) == (1, "failed")
    line = _LAW.splitlines().index('        raise ValueError("no such speed")') + 1
    for text in (errors, report["message"]):
        assert re.search(
            rf"Lost: lost in {law}, line \d+, raises ValueError\('no such speed'\) \(line {line}\) at 0\.1", text
        )
    assert 0.0 < report["t_end"] < 20.0
    assert report["n_steps"] > 10
    assert len((results / "events.csv").read_text().splitlines()) == 1 + report["n_events"]
    assert (results / "solution.zarr").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "owner", "function"),
    [
        ("failing_turning", "Turning.coefficient(", "turning"),
        ("failing_process", "Process.efficiency(", "share"),
        ("failing_map", "Map.impulses(", "turning_map"),
    ],
)
def test_a_check_of_a_law_that_never_comes_back_ends(
    call: Call, law: Path, name: str, owner: str, function: str
) -> None:
    """Within its budget, and names function, input, file and the line where it was."""
    status, output, _ = call("check", name)
    assert status == 1
    assert re.search(r"^ +fails +time budget ", output, re.M)
    line = next(line for line in output.splitlines() if "'time budget' does not hold" in line)
    assert owner in line
    assert f"{function} in {law}, line " in line
    number = re.search(r"at line (\d+)", line)
    assert number is not None
    assert _LAW.splitlines()[int(number[1]) - 1].strip() in ("while x > -100.0:", "x = abs(x)")


def test_a_check_of_a_law_that_asks_for_what_it_does_not_have(call: Call, law: Path) -> None:
    status, output, _ = call("check", "failing_misspelt")
    assert status == 1
    assert re.search(r"^ +fails +known parameters ", output, re.M)
    assert f"misspelt in {law}, line " in output
    assert "Did you mean 'level'" in output
