"""``nonsmooth orbit``, ``continue`` and ``bifurcation``: what they print and save, and what they refuse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.engine.native.kernel import PLAIN

Call = Callable[..., tuple[int, str, str]]
START = ("bouncing_ball", "--set", "start_phase=1.1", "--set", "speed=0.19")
BALL = (*START, "--set", "gamma=0.8")
ASKED = (*BALL, "--period", "0.04", "--within", "z,vz")
pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
STUCK = ("block_on_belt", "--section", "x=0.5", "--settle", "20", "--within", "x,vx")
"""Stuck to the belt where it passes the section, which holds its velocity."""


@pytest.mark.slow
def test_an_orbit(call: Call, tmp_path: Path) -> None:
    status, output, _ = call("orbit", *ASKED, "--out", str(tmp_path / "out"))
    assert status == 0
    assert output.startswith("stable, largest multiplier 0.8\n")
    assert "-0.34612213+0.72124855j" in output
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["multipliers.csv", "multipliers.png"]
    status, _, errors = call("orbit", *ASKED, "--out", str(tmp_path / "out"))
    assert status == 2
    assert "--overwrite" in errors


@pytest.mark.parametrize(("gamma", "word"), [("0.8", "stable, "), ("1.2", "unstable, ")])
def test_the_verdict_comes_first(call: Call, gamma: str, word: str) -> None:
    """The period of the table is taken; beyond Gamma = 1.049 the orbit of one period doubles."""
    status, output, _ = call("orbit", *START, "--set", f"gamma={gamma}", "--within", "z,vz")
    assert status == 0
    lines = output.splitlines()
    assert lines[0].startswith(f"{word}largest multiplier ")
    assert [line.split() for line in lines if "period" in line] == [["period", "0.04", "s"]]
    assert ["multiplier", "magnitude", "error"] in [line.split() for line in lines]


@pytest.mark.slow
def test_along_a_parameter(call: Call, tmp_path: Path) -> None:
    status, output, _ = call("continue", *ASKED, "--over", "gamma=0.78:0.82", "--out", str(tmp_path / "out"))
    assert status == 0
    assert "gamma from 0.78" in output
    lines = (tmp_path / "out" / "branch.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "gamma,largest_multiplier,stable"
    assert all(line.split(",")[1].startswith(("0.8", "0.79999")) for line in lines[1:])


def test_a_bifurcation_diagram(call: Call, tmp_path: Path) -> None:
    words = ("--over", "gamma=0.7:0.8:3", "--period", "0.04", "--show", "vz", "--settle", "300", "--keep", "8")
    status, output, _ = call("bifurcation", *START, *words, "--out", str(tmp_path / "out"))
    assert status == 0
    assert "3 repeat after 1 periods" in output
    assert len((tmp_path / "out" / "bifurcation.csv").read_text(encoding="utf-8").splitlines()) == 4


def test_a_diagram_over_a_frequency(call: Call) -> None:
    """The period follows the frequency; a fixed one is refused where it does not fit, with the word that does."""
    words = ("bifurcation", *BALL, "--over", "frequency=25:26:2", "--show", "vz", "--settle", "300", "--keep", "8")
    status, output, _ = call(*words, "--period", "1/frequency")
    assert status == 0
    assert "2 repeat after 1 periods" in output
    assert call(*words) == (status, output, "")  # the period of the table follows by itself
    status, output, errors = call(*words, "--period", "0.04")
    assert status == 1
    assert "1 failed" in output
    assert "--period 1/NAME" in errors


@pytest.mark.slow
def test_a_branch_over_a_frequency(call: Call) -> None:
    words = "--over", "frequency=24.5:25.5", "--period", "1/frequency", "--within", "z,vz"
    status, output, _ = call("continue", *BALL, *words)
    assert status == 0
    assert "ends by the end of the range; the end of the range" in output


@pytest.mark.slow
def test_a_followed_diagram(call: Call, tmp_path: Path) -> None:
    words = ("--over", "gamma=0.3:0.8:2", "--period", "0.04", "--show", "vz", "--settle", "200", "--keep", "8")
    status, output, _ = call("bifurcation", *START, *words, "--at", "0.02", "--follow", "--out", str(tmp_path / "out"))
    assert status == 0
    assert "1 of 2 values have two motions" in output
    assert "up: 2 repeat after 1 periods" in output
    lines = (tmp_path / "out" / "bifurcation.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == ",".join(["way", "gamma", *(f"vz_{i}" for i in range(1, 9))])
    assert [line.split(",")[:2] for line in lines[1:]] == [
        ["up", "0.3"],
        ["up", "0.8"],
        ["down", "0.3"],
        ["down", "0.8"],
    ]


@pytest.mark.slow
def test_an_orbit_without_a_period(call: Call) -> None:
    within = "phi_m,phi_s,y rate,phi_m rate,phi_s rate"
    status, output, _ = call("orbit", "woodpecker", "--section", "phi_m=0", "--settle", "1", "--within", within)
    assert status == 0
    assert "0.14597606" in output
    assert "multiplier 1 along the motion" in output


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("orbit", *BALL, "--period", "-1"), "period must be positive and finite, but it is -1.0"),
        (("orbit", *BALL, "--period", "0.04", "--within", "z,vx2"), "'vx2'"),
        (("orbit", "woodpecker"), "No body of it is driven periodically. Add --period SECONDS, or --section"),
        (("orbit", *BALL, "--section", "z=0:up"), "must have the form NAME=LEVEL or NAME=LEVEL:falling"),
        (("continue", *ASKED, "--over", "gamma=0.7"), "--over gamma must have the form LOW:HIGH, "),
        (
            ("bifurcation", *START, "--over", "gamma=0.7:0.8", "--period", "0.04", "--show", "vz"),
            "must have the form LOW:HIGH:N",
        ),
        (
            ("bifurcation", *BALL, "--over", "gamma=0:1:3", "--period", "0.04", "--show", "vz"),
            "must be left out with --over gamma",
        ),
        (("continue", *ASKED, "--over", "gama=0.7:0.9"), "Did you mean 'gamma'"),
        (("continue", *BALL, "--over", "frequncy=24:26", "--period", "1/frequncy"), "Did you mean 'frequency'"),
        (("continue", *BALL, "--over", "frequency=24:26", "--period", "1/f"), "--period: unknown parameter of --over"),
        (
            ("continue", *BALL, "--over", "frequency=24:26", "--period", "1:f"),
            "a number of seconds, N/NAME or Npi/NAME",
        ),
        (("continue", *ASKED, "--over", "gamma=0.9:1.0"), "around the value of the orbit"),
        (("continue", *STUCK, "--over", "decay=2.9:3.1"), "must leave something free at the section"),
    ],
)
def test_what_is_refused(call: Call, words: tuple[str, ...], said: str) -> None:
    status, _, errors = call(*words)
    assert status == 2
    assert said in errors
