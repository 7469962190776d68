"""``nonsmooth resume``: a run that was cut off ends as it would have."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nonsmooth.cli.execute import perform

Call = Callable[..., tuple[int, str, str]]


def _impatient(t: float, t_end: float, n_events: int) -> None:
    """Interrupt the run when half of it is done."""
    if t > 0.5 * t_end:
        signal.raise_signal(signal.SIGINT)


def _same(report: dict[str, Any]) -> dict[str, Any]:
    """Return what does not hang on the time that a run took, or on how it was asked for."""
    return {
        key: value for key, value in report.items() if key not in ("wall_seconds", "scenario", "parameters", "laws")
    }


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["name", "file", "class"])
def test_an_interrupted_run_ends_as_the_whole_one(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    import xarray

    asked = {
        "name": (
            "dumbbell",
            "--set",
            "t_end=20",
            "--law",
            "impact=newton,restitution=0.4",
            "--engine",
            "event_driven,tolerance=1e-8",
        ),
        "file": (str(tmp_path / "dumbbell.toml"), "--set", "t_end=20"),
        "class": (f"{tmp_path / 'mine.py'}:Mine", "--set", "t_end=20"),
    }[kind]
    if kind == "file":
        assert call("save", "dumbbell", asked[0])[0] == 0
    (tmp_path / "mine.py").write_text("from scenarios.dumbbell import DumbbellScenario as Mine  # noqa\n")
    trust = ["--trust"] if kind == "class" else []
    folder = tmp_path / "results"
    with monkeypatch.context() as patch:
        patch.setattr(perform, "TimeReached", lambda _: _impatient)
        patch.setattr(perform, "_save_figures", lambda *_: None)
        status, output, _ = call("run", *asked, "--json", "--out", str(folder))
        assert (status, json.loads(output)["status"]) == (1, "interrupted")
    with monkeypatch.context() as patch:
        patch.setattr(perform, "_save_figures", lambda *_: None)
        status, output, errors = call("resume", str(folder), "--json", *trust)
    assert status == 0, errors
    status, whole, _ = call("run", *asked, "--json")
    assert _same(json.loads(output)) == _same(json.loads(whole))
    assert json.loads((folder / "summary.json").read_text()) == json.loads(output)
    with xarray.open_zarr(folder / "solution.zarr") as saved:
        assert saved.attrs["status"] == "done"
        assert saved.sizes["event"] == json.loads(whole)["n_events"]
    status, _, errors = call("resume", str(folder))
    assert status == 2
    assert "must hold a run that was cut off, but it is 'done'" in errors


def test_a_folder_without_a_run_is_refused(call: Call, tmp_path: Path) -> None:
    status, output, errors = call("resume", str(tmp_path))
    assert (status, output) == (2, "")
    assert "must be a folder of results" in errors
