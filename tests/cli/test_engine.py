"""``--engine``: what integrates a scenario, with its options."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

JUDGED = f"{Path(__file__).parents[1] / 'runs' / 'reporting_engines.py'}:Judged"
Call = Callable[..., tuple[int, str, str]]


def test_an_option_of_the_engine_is_that_of_the_run(call: Call) -> None:
    words = ("run", "tiny", "--set", "t_end=0.2", "--json")
    plain, fine = (json.loads(call(*words, *more)[1]) for more in ((), ("--engine", "event_driven,largest_step=1e-3")))
    assert (plain["engine"]["largest_step"], fine["engine"]["largest_step"]) == (None, 1e-3)
    assert fine["n_steps"] >= 200 > plain["n_steps"]


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("event_drivn", "Unknown --engine 'event_drivn'. Did you mean 'event_driven'?"),
        ("event_driven,tolerence=1e-8", "Did you mean 'tolerance'"),
        ("event_driven,tolerance=2", "EventDriven.tolerance must be"),
        ("event_driven,tolerance", "must have the form ENGINE or ENGINE,NAME=VALUE"),
        ("", "must have the form ENGINE"),
    ],
)
def test_a_wrong_engine_is_told(call: Call, word: str, told: str) -> None:
    status, output, errors = call("run", "tiny", "--engine", word)
    assert (status, output) == (2, "")
    assert told in errors


def test_an_engine_of_a_file_reports_its_verdict_and_its_cause(call: Call) -> None:
    """It knows no contacts, and so no modes."""
    status, output, _ = call("run", "tiny", "--set", "t_end=0.1", "--json", "--engine", JUDGED)
    said = json.loads(output)
    assert (status, said["status"], said["cause"], said["mode_words"]) == (0, "done", "", None)
    assert said["verdict"]["fastest_fall"]["value"] == pytest.approx(0.981, rel=0.2)
    status, output, errors = call("run", "tiny", "--set", "t_end=0.1", "--engine", f"{JUDGED},most=0.5")
    assert status == 1
    assert output.startswith("tiny: failed (too_fast) at t = 0.05")
    assert "fastest fall" in output
    assert "largest speed downwards at the end of a step" in output
    assert "the body falls too fast. Take a parachute." in errors
