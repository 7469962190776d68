"""The scripts of the worked studies run, at a small size, and find what the pages say."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

from nonsmooth.engine.native.kernel import PLAIN

pytest.importorskip("zarr", "3.1.3")
pytestmark = pytest.mark.skipif(PLAIN, reason="takes minutes in plain mode")
SCRIPTS = Path(__file__).parents[2] / "docs" / "studies"


def _run(name: str, *words: str) -> None:
    path = str(SCRIPTS / f"{name}.py")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", [path, *words])
        runpy.run_path(path, run_name="__main__")


@pytest.mark.slow
def test_drift_velocity(tmp_path: Path) -> None:
    _run("drift_velocity", str(tmp_path / "s.zarr"), str(tmp_path / "s.png"), "2")
    assert (tmp_path / "s.png").stat().st_size > 10_000


@pytest.mark.slow
def test_ball_bifurcation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run("ball_bifurcation", str(tmp_path / "s.png"), "3")
    apart = [float(line.rpartition(" ")[2]) for line in capsys.readouterr().out.splitlines()]
    assert len(apart) == 2
    assert max(apart) < 1e-8
    assert (tmp_path / "s.png").stat().st_size > 10_000


@pytest.mark.slow
def test_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run("fit", str(tmp_path / "s.png"), "2")
    lines = [line for line in capsys.readouterr().out.splitlines() if "standard errors" in line]
    off = [abs(float(line.split(", ")[1].split()[0])) for line in lines]
    assert len(off) == 2
    assert max(off) < 3.0
    assert (tmp_path / "s.png").stat().st_size > 10_000
