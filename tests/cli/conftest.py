"""The command line, with a plug-in installed that brings the scenario ``tiny`` and some broken entries."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nonsmooth.cli.main import main
from nonsmooth.plugins import registry

PLUGIN = Path(__file__).parent / "plugin"
ROOT = Path(__file__).parents[2]

Call = Callable[..., tuple[int, str, str]]
Start = Callable[..., subprocess.Popen[str]]


@pytest.fixture(autouse=True)
def _plugin(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.syspath_prepend(str(PLUGIN))
    registry._points.cache_clear()
    yield
    registry._points.cache_clear()


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Return a function that runs the command in this process: words -> status, output, errors."""

    def run(*words: str) -> tuple[int, str, str]:
        capsys.readouterr()
        try:
            status = main(words)
        except SystemExit as stop:  # argparse's way
            status = int(stop.code or 0)
        return status, *capsys.readouterr()

    return run


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Return a function that starts ``python -m nonsmooth`` in an empty folder."""
    started: list[subprocess.Popen[str]] = []

    def run(*words: str) -> subprocess.Popen[str]:
        environment = {k: v for k, v in os.environ.items() if k != "NONSMOOTH_PLAIN"}
        environment["PYTHONPATH"] = os.pathsep.join([str(ROOT), str(PLUGIN), os.environ.get("PYTHONPATH", "")])
        process = subprocess.Popen(
            [sys.executable, "-m", "nonsmooth", *words],
            cwd=tmp_path,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield run
    for process in started:
        process.kill()
        process.communicate()
