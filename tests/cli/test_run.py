"""``nonsmooth run`` without files: what it prints, and that it is all."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

Call = Callable[..., tuple[int, str, str]]
KEYS = {
    "scenario",
    "parameters",
    "laws",
    "engine",
    "status",
    "message",
    "t_end",
    "wall_seconds",
    "n_events",
    "n_impacts",
    "n_steps",
    "step_limits",
    "event_intervals",
    "contacts",
    "unseen_contacts",
    "impulses_beyond_cone",
    "friction_gain",
    "closing_gain",
    "mode_words",
    "energy_residual",
    "cause",
    "verdict",
    "final",
    "summary",
    "units",
}


def test_json_is_the_only_line_and_complete(call: Call) -> None:
    status, output, errors = call("run", "tiny", "--json", "--set", "t_end=0.2")
    assert status == 0
    assert output.count("\n") == 1
    report = json.loads(output)
    assert report.keys() == KEYS
    assert report["scenario"] == "tiny"
    assert report["parameters"] == {"t_end": 0.2, "radius": 5e-3, "mode": "bounce"}
    assert report["status"] == "done"
    assert report["t_end"] == pytest.approx(0.2, abs=1e-12)
    assert report["n_impacts"] >= 2
    assert report["n_events"] > report["n_impacts"]
    assert sum(report["step_limits"].values()) >= report["n_steps"] > 0
    assert sum(report["event_intervals"].values()) == report["n_events"] - 1
    assert sum(report["mode_words"].values()) == pytest.approx(1.0, abs=1e-12)
    assert report["energy_residual"] < 1e-8
    assert [len(report["final"][name]) for name in ("q", "u")] == [7, 6]
    assert report["summary"]["drift_velocity"] == [1.0, None]
    assert report["summary"]["count"] == report["n_events"]
    assert errors == "a plug-in that prints\n"


def test_the_summary_to_read(call: Call) -> None:
    status, output, _ = call("run", "tiny")
    assert status == 0
    assert output.startswith("tiny: done at t = 0.1 s")
    for words in ("attractor", "bounce", "drift velocity", "energy residual", "time in modes", "{0,0,0}", "%"):
        assert words in output


@pytest.mark.slow
def test_nothing_is_written_and_no_heavy_package_imported(tmp_path: Path) -> None:
    code = (
        "import sys; from nonsmooth.cli.main import main; status = main(['run', 'tiny', '--json']); "
        "print(status, sorted({'matplotlib', 'xarray', 'zarr', 'trimesh', 'fcl'} & set(sys.modules)))"
    )
    environment = {"PYTHONPATH": ":".join(sys.path), "NONSMOOTH_PLAIN": "1"}
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.stdout.splitlines()[1:] == ["0 []"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("extra", [(), ("--out", "results")])
def test_a_failed_run_reports_what_was_computed(
    call: Call, extra: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, output, errors = call("run", "tiny", "--json", "--set", "mode=nan law", *extra)
    report = json.loads(output)
    assert status == 1
    assert report["status"] == "failed"
    assert 0.0 < report["t_end"] < 0.1
    assert "NotANumber" in report["message"]
    assert f"error: {report['message']}\n" in errors
    assert "Traceback" not in errors
    # of the one mode that it came to there is no picture of transitions
    kept = ["events.csv", "height.png", "solution.zarr", "summary.json"] if extra else []
    assert sorted(path.name for path in tmp_path.glob("results/*")) == kept


def test_a_summary_that_fails_costs_nothing_else(call: Call) -> None:
    status, output, errors = call("run", "tiny", "--json", "--set", "mode=bad summary")
    report = json.loads(output)
    assert status == 1
    assert (report["status"], report["summary"]) == ("done", None)
    assert report["final"]["q"]
    assert "error: Tiny.summarise failed: ZeroDivisionError: a summary that fails\n" in errors
