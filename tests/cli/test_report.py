"""Strict JSON from whatever a scenario reports."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth.cli.report.run_report import _modes, as_json, as_text


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (math.nan, None),
        (-math.inf, None),
        (np.float64(0.1), 0.1),
        (np.int64(3), 3),
        (np.bool_(True), True),
        (np.array([1.0, np.inf, 0.1 + 0.2]), [1.0, None, 0.1 + 0.2]),
        ([(1, np.float32(0.5))], [[1, 0.5]]),
        ({"NaN": "Infinity"}, {"NaN": "Infinity"}),
        (Path("a"), "a"),
        (None, None),
    ],
)
def test_values_come_out_as_plain_json(value: Any, expected: Any) -> None:
    text = as_json({"value": value})
    assert "\n" not in text

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    assert json.loads(text, parse_constant=refuse) == {"value": expected}


def test_words_of_many_contacts_tell_what_differs() -> None:
    """Each line by its counts and by the contacts in which it is unlike the line above."""
    n = 40
    names = [f"contact {i}" for i in range(n)]

    def word(*slipping: int) -> str:
        closed, slip = n * "1", "".join(str(int(i in slipping)) for i in reversed(range(n)))
        return f"{{{closed},{n * '0'},{slip}}}"

    lines = _modes({word(): 0.5, word(3): 0.3, word(3, 5, 7, 9): 0.15, f"{{{','.join(3 * [n * '0'])}}}": 0.05}, names)
    assert [" ".join(line.split()) for line in lines] == [
        "40 closed 50.00%",
        "40 closed, 1 slipping; unlike above contact 3 30.00%",
        "40 closed, 4 slipping; unlike above contact 5, contact 7, 1 more 15.00%",
        "all open; unlike above contact 0, contact 1, 38 more 5.00%",
    ]


def test_the_text_has_units_and_no_round_off() -> None:
    """Beside each number that has one; what is next to nothing is 0, and what is not there is none."""
    shares = {f"{{{i:03b}}}": 1.0 / (i + 2) for i in range(8)}
    report = {
        "scenario": "toy",
        "status": "done",
        "t_end": 4.0,
        "wall_seconds": 0.01,
        "n_events": 3,
        "n_impacts": 2,
        "n_steps": 5,
        "step_limits": {"no step": 7, "error": 2, "event": 3},
        "event_intervals": {},
        "contacts": ["plate - ball 1", "plate - ball 2", "tip"],
        "unseen_contacts": [],
        "impulses_beyond_cone": 0,
        "friction_gain": 0.0,
        "closing_gain": 0.0,
        "mode_words": shares,
        "energy_residual": 1.2e-16,
        "cause": "",
        "verdict": {},
        "summary": {
            "drift_velocity": np.array([5e-18, -0.0022]),
            "first_rest": None,
            "largest_gap": 3e-17,
            "tiny_force": 2e-9,
            "inverted": True,
            "causes": {"slip_to_stick": 2, "start": 1},
            "strikes": [],
        },
        "units": {"drift_velocity": "m/s", "first_rest": "s", "largest_gap": "m", "tiny_force": "N", "strikes": "s"},
    }
    lines = [" ".join(line.split()) for line in as_text(report).splitlines()]
    assert lines[0] == "toy: done at t = 4 s in 0.01 s of wall time; 3 events, 2 impacts, 5 steps"
    assert lines[1:8] == [
        "drift velocity 0, -0.0022 m/s",
        "first rest none",
        "largest gap 0 m",
        "tiny force 2e-09 N",
        "inverted yes",
        "causes slip to stick 2, start 1",
        "strikes none",
    ]
    assert lines[8] == "energy residual 1.2e-16"
    assert lines[9] == "steps limited by event 3, error 2"
    assert lines[10] == "time in modes {000} 50.00%"
    assert lines[-2] == "and 3 more"
    assert lines[-1] == "contacts from the right plate - ball 1, plate - ball 2, tip"
    assert len(lines) == 17
    assert "null" not in "".join(lines)
