"""``nonsmooth run --accept``: a table of criteria, and the exit status."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

Call = Callable[..., tuple[int, str, str]]


def test_a_run_that_is_accepted(call: Call) -> None:
    status, output, errors = call("run", "block_on_belt", "--accept")
    assert (status, errors) == (0, "")
    table = output[output.index("accepted") :].splitlines()
    assert table[0].split() == ["accepted", "value", "range", "source"]
    assert table[1].split()[:6] == ["holds", "elongation", "at", "the", "first", "breakaway"]
    assert "0.9999986 .. 1.0000014" in table[1]
    assert "Leine et al. (1998)" in table[1]
    assert call("run", "block_on_belt")[1].count("breakaway [m]") == 0


def test_a_run_that_is_not(call: Call) -> None:
    status, output, errors = call("run", "tiny", "--accept", "--set", "mode=missed")
    assert status == 1
    assert "error: not accepted: gap at the first impact [m] is" in errors
    assert "must be 0.000999999 to 0.001000001" in errors
    rows = [line.split() for line in output[output.index("not accepted") :].splitlines()]
    assert (rows[1][0], rows[2][0]) == ("fails", "holds")
    assert call("run", "tiny", "--set", "mode=missed")[0] == 0


@pytest.mark.slow
def test_as_json(call: Call, tmp_path: Path) -> None:
    """With all digits, and in summary.json too."""
    status, output, _ = call("run", "tiny", "--accept", "--json", "--out", str(tmp_path / "out"))
    assert status == 0
    first, second = json.loads(output)["acceptance"]
    assert abs(first["value"]) < 1e-9
    assert first["fulfilled"] is True
    assert (second["lower"], second["upper"], second["source"]) == (1.0, None, "it falls on the plate")
    kept = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert kept["acceptance"] == [first, second]


def test_no_criterion_is_no_acceptance(call: Call, tmp_path: Path) -> None:
    status, output, errors = call("run", "tiny", "--accept", "--set", "mode=none")
    assert status == 1
    assert "  not accepted: no criterion" in output
    assert "has no criterion for these parameters" in errors
    path = tmp_path / "belt.toml"
    assert call("save", "block_on_belt", str(path), "--set", "t_end=1")[0] == 0
    status, _, errors = call("run", str(path), "--accept")
    assert status == 1
    assert "has no criterion" in errors


@pytest.mark.parametrize("mode", ["nan law"])
def test_a_run_that_fails_is_not_accepted(call: Call, mode: str) -> None:
    assert call("run", "tiny", "--accept", "--set", f"mode={mode}")[0] == 1


def test_other_laws_are_not_judged(call: Call) -> None:
    status, output, errors = call("run", "tiny", "--accept", "--law", "friction=frictionless")
    assert (status, output) == (2, "")
    assert "--accept must be left out of a run with --law" in errors
