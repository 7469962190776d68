"""Ctrl-C keeps and saves what was computed."""

from __future__ import annotations

import json
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.cli.execute import obtain, perform
from nonsmooth.cli.execute.perform import Interrupt

Call = Callable[..., tuple[int, str, str]]


@pytest.mark.slow
def test_a_process_that_is_interrupted_saves_its_results(
    start: Callable[..., subprocess.Popen[str]], tmp_path: Path
) -> None:
    process = start("run", "tiny", "--set", "t_end=1e5", "--json", "--out", "results")
    assert process.stderr is not None
    for line in process.stderr:  # the first line of progress: the engine is running
        if line.startswith("t = "):
            break
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=120)
    report = json.loads(output)
    assert process.returncode == 1
    assert report["status"] == "interrupted"
    assert 0.0 < report["t_end"] < 1e5
    assert "Traceback" not in errors
    saved = tmp_path / "results"
    assert sorted(p.name for p in saved.iterdir()) == [
        "events.csv",
        "height.png",
        "solution.zarr",
        "summary.json",
        "transitions.png",
    ]
    assert len((saved / "events.csv").read_text().splitlines()) == 1 + report["n_events"]


def test_ctrl_c_between_two_calls_of_the_engine(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def impatient(t: float, t_end: float, events: int) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(perform, "TimeReached", lambda _: impatient)
    status, output, _ = call("run", "tiny", "--set", "t_end=1e5", "--json")
    report = json.loads(output)
    assert status == 1
    assert report["status"] == "interrupted"
    assert report["n_steps"] > 0


def test_ctrl_c_before_the_run_began(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*words: object, **more: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(obtain, "assemble", stopped)
    status, output, _ = call("run", "tiny", "--json")
    report = json.loads(output)
    assert status == 1
    assert (report["status"], report["t_end"]) == ("interrupted", None)


def test_the_first_ctrl_c_waits_and_the_second_does_not(capsys: pytest.CaptureFixture[str]) -> None:
    before = signal.getsignal(signal.SIGINT)
    with Interrupt() as interrupt:
        interrupt.check()
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            interrupt.check()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before
    assert "once more stops at once" in capsys.readouterr().err
