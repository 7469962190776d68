"""Scenario files in YAML: the same tables as in TOML, with the numbers of YAML 1.2."""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given

import nonsmooth as ns
from nonsmooth.cli.main import main
from nonsmooth.errors import MissingPackagesError
from nonsmooth.files import yaml_text
from nonsmooth.plugins import registry
from tests.files.test_round_trip import SCENARIOS, same
from tests.files.test_text import _same, _tables

pytest.importorskip("yaml")

_ROLL = """
title: A ball that stops slipping
t_end: 0.5
laws:
  hard: {type: energetic, restitution: 5e-1}
bodies:
  floor: {type: plate}
  ball: {type: ball, radius: 1e-2, start: {place: touching, velocity: [0.7, 0, 0.0]}}
contacts:
  - between: [ball, floor]
    normal: unilateral
    friction: {type: coulomb, friction: 0.3}
    impact: hard
"""


@pytest.mark.slow
@given(_tables)
def test_what_was_written_is_read(tables: dict[str, Any]) -> None:
    assert _same(yaml_text.tables_of(yaml_text.text_of(tables)), tables)


def test_words_and_numbers() -> None:
    """Those of YAML 1.2, and not on and off, sixties and octals."""
    text = "a: [1e-3, 1E3, .5, 5., -1, +7, 0, true, no, on, 1:30, 2020-01-02, 1_0, .inf, '1', 1e, ~]"
    found = yaml_text.tables_of(text)["a"]
    numbers: list[Any] = [1e-3, 1e3, 0.5, 5.0, -1, 7, 0, True]
    assert found == [*numbers, "no", "on", "1:30", "2020-01-02", "1_0", math.inf, "1", "1e", None]
    assert list(map(type, found[:8])) == list(map(type, numbers))


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_comes_back(name: str, tmp_path: Path) -> None:
    system = registry.load("scenarios", name)().build()
    ns.save_system(system, tmp_path / "one.yaml")
    assert same(system, ns.load_system(tmp_path / "one.yaml").system)


def test_a_file_by_hand(tmp_path: Path) -> None:
    """It says what its TOML twin says: sliding ends in rolling with 5/7 of the speed."""
    path = tmp_path / "roll.yml"
    path.write_text(_ROLL)
    setup = ns.load_system(path)
    assert setup.t_end is not None
    solution = ns.simulate(setup.system, setup.t_end)
    assert solution.u_end[0] == pytest.approx(0.5, rel=1e-9)
    ns.save_system(setup.system, tmp_path / "roll.toml")
    assert same(setup.system, ns.load_system(tmp_path / "roll.toml").system)


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("t_end: 0.5", "t_end: [0.5", "must be YAML text, but it is .* line 4"),
        ("t_end: 0.5", "t_end: 0.5\nt_end: 0.6", "a key twice: t_end"),
        ("t_end: 0.5", "1: 0.5", "a key that is no word: 1"),
        ("radius: 1e-2", "radius: 1e-2m", r"Ball.radius must be a finite number, but it is '1e-2m'"),
        ("impact: hard", "impact: hrd", "Did you mean 'hard'"),
    ],
)
def test_mistakes(before: str, after: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "roll.yaml"
    path.write_text(_ROLL.replace(before, after))
    with pytest.raises(ns.InvalidInput, match=told):
        ns.load_system(path)
    path.write_text("- a list")
    with pytest.raises(ns.InvalidInput, match="it is no table"):
        ns.load_system(path)


def test_other_endings(tmp_path: Path) -> None:
    with pytest.raises(ns.InvalidInput, match=r"must end in .toml, .yaml, .yml"):
        ns.save_system(ns.load_system(_written(tmp_path)).system, tmp_path / "roll.json")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["roll.yaml"]


def _written(folder: Path) -> Path:
    path = folder / "roll.yaml"
    path.write_text(_ROLL)
    return path


def test_without_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error names the extra; TOML files do not need it."""

    def missing(name: str) -> Any:
        raise ImportError(f"No module named {name!r}")

    path = _written(tmp_path)
    yaml_text._yaml.cache_clear()
    monkeypatch.setattr(importlib, "import_module", missing)
    try:
        with pytest.raises(MissingPackagesError, match=r'pip install "nonsmooth\[yaml\]"'):
            ns.load_system(path)
    finally:
        monkeypatch.undo()
        yaml_text._yaml.cache_clear()
    ns.load_system(path)


@pytest.mark.slow
def test_from_the_command_line(tmp_path: Path) -> None:
    path = _written(tmp_path)
    assert main(["run", str(path), "--set", "bodies.ball.radius=0.02"]) == 0
    out = tmp_path / "belt.yaml"
    assert main(["save", "block_on_belt", str(out)]) == 0
    assert ns.load_system(out).t_end is not None
