"""What is wrong is told before anything is computed: the thing, the rule, the value and the remedy."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import RigidBody
from nonsmooth.cli.main import main
from nonsmooth.errors import MissingPackagesError
from nonsmooth.solution.exports import exporter

_WRONG: dict[str, tuple[Callable[[Path], Any], str]] = {
    "suffix": (lambda at: exporter(at / "run.xyz"), r"must end in one of \.glb, \.pvd, .*run\.xyz.*suffix"),
    "no suffix": (lambda at: exporter(at / "glb"), r"must end in one of \.glb"),
    "path": (lambda at: exporter(3), r"export: path must be a path"),  # type: ignore[arg-type]
    "folder": (lambda at: exporter(at / "a" / "b.glb"), r"a must be a folder that can be written to.*It is a file"),
    "directory": (lambda at: exporter(at / "d.glb"), r"export: path must be a file.*d\.glb"),
    "option": (lambda at: exporter(at / "a.glb", speed=2.0), r"export: speed is no option of \.glb.*2\.0.*most_knots"),
    "view": (lambda at: exporter(at / "a.gif", view="back"), r"view must be one of 'corner', 'front'.*'back'"),
    "speed": (lambda at: exporter(at / "a.gif", speed=0.0), r"export: speed must be .*0.*time of the run"),
    "speed below": (lambda at: exporter(at / "a.webp", speed=-1.0), r"export: speed must be .*-1"),
    "rate": (lambda at: exporter(at / "a.gif", frames_per_second=100.0), r"frames_per_second must be .*50.*100"),
    "size": (lambda at: exporter(at / "a.gif", size=10), r"export: size must be .*240.*10"),
    "count": (lambda at: exporter(at / "a.pvd", count=1), r"export: count must be .*1"),
    "series": (lambda at: exporter(at / "a.csv", series="energy"), r"'energy'.*Did you mean 'energies'"),
    "no series": (lambda at: exporter(at / "a.csv", series=3), r"export: series must be of the kind Series.*3"),
}


@pytest.mark.parametrize("name", _WRONG)
def test_what_is_wrong_is_named(tmp_path: Path, name: str) -> None:
    (tmp_path / "a").write_text("")
    (tmp_path / "d.glb").mkdir()
    call, message = _WRONG[name]
    with pytest.raises(ns.InvalidInput, match=message):
        call(tmp_path)


def test_without_ffmpeg_the_remedy_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(MissingPackagesError, match=r"ffmpeg, which is not found\. Install it .*\.webp or \.gif"):
        exporter(tmp_path / "a.mp4")


@pytest.mark.slow
def test_packages_are_asked_for_when_they_are_needed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    exporter(tmp_path / "a.glb")
    for file in ("a.gif", "a.csv"):
        with pytest.raises(MissingPackagesError, match=r"nonsmooth\[full\]"):
            exporter(tmp_path / file)


def test_too_many_pictures_are_refused(drift: ns.Solution, tmp_path: Path) -> None:
    with pytest.raises(ns.InvalidInput, match=r"export: speed must leave 1000 pictures at most.*make 7501.*0\.001"):
        drift.export(tmp_path / "a.gif", speed=0.001)
    assert list(tmp_path.iterdir()) == []


def test_a_series_without_times_is_refused(drift: ns.Solution, tmp_path: Path) -> None:
    with pytest.raises(ns.InvalidInput, match=r"export: series must be over time"):
        drift.export(tmp_path / "a.csv", series=drift)


def test_what_cannot_be_seen_has_no_pictures(tmp_path: Path) -> None:
    run = ns.simulate(ns.System([RigidBody(1.0, np.eye(3).tolist(), ())]), 0.1)
    with pytest.raises(ns.InvalidInput, match=r"must have something to be seen.*shapes or a sketch"):
        run.export(tmp_path / "a.glb")
    assert "q" in run.export(tmp_path / "a.csv").read_text()


def test_suffixes_may_be_large(drift: ns.Solution, tmp_path: Path) -> None:
    assert drift.export(str(tmp_path / "A.GLB")).read_bytes()[:4] == b"glTF"


@pytest.mark.parametrize(("file", "options"), [("a.glb", {}), ("a.csv", {}), ("a.pvd", {"count": 5}), ("a.html", {})])
def test_an_interrupted_export_leaves_the_old_files(
    file: str, options: dict[str, Any], drift: ns.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All of them, also those of a series, and no others."""
    path = tmp_path / file

    def export() -> None:
        drift.to_html(path) if path.suffix == ".html" else drift.export(path, **options)

    export()
    before = {one: one.read_bytes() for one in tmp_path.rglob("*") if one.is_file()}
    write, left = Path.write_bytes, [3 if path.suffix == ".pvd" else 0]

    def interrupt(path: Path, content: bytes | str, **options: str) -> int:
        left[0] -= 1
        if left[0] < 0:
            write(path, b"half")
            raise KeyboardInterrupt
        return write(path, content if isinstance(content, bytes) else content.encode())

    for name in ("write_bytes", "write_text"):
        monkeypatch.setattr(Path, name, interrupt)
    with pytest.raises(KeyboardInterrupt):
        export()
    monkeypatch.undo()
    assert {one: one.read_bytes() for one in tmp_path.rglob("*") if one.is_file()} == before
    export()
    assert {one: one.read_bytes() for one in tmp_path.rglob("*") if one.is_file()} == before


def test_a_series_replaces_no_files_of_another_kind(drift: ns.Solution, tmp_path: Path) -> None:
    (tmp_path / "a_vtp").mkdir()
    (tmp_path / "a_vtp" / "thesis.txt").write_text("all of it")
    with pytest.raises(ns.InvalidInput, match=r"must have only VTP files, as it would be replaced.*thesis\.txt"):
        drift.export(tmp_path / "a.pvd", count=5)
    assert (tmp_path / "a_vtp" / "thesis.txt").read_text() == "all of it"


@pytest.mark.slow
def test_the_command_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "new" / "run.gif"
    words = ["--set", "t_end=0.1", "--speed", "0.5", "--size", "240", "--view", "front"]
    assert main(["export", "bouncing_ball", str(path), *words]) == 0
    assert f"the run is in {path}" in capsys.readouterr().err
    assert path.read_bytes()[:6] == b"GIF89a"


def test_the_command_refuses_before_it_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "no such scenario", str(tmp_path / "a.xyz")]) == 2
    assert "must end in one of" in capsys.readouterr().err
    assert main(["export", "bouncing_ball", str(tmp_path / "a.csv"), "--view", "front"]) == 2
    assert "is no option of .csv" in capsys.readouterr().err


@pytest.mark.slow
def test_a_stored_run_is_exported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(tmp_path / "stored")
    assert main(["run", "bouncing_ball", "--set", "t_end=0.1", "--out", folder]) == 0
    assert main(["export", folder, str(tmp_path / "a.csv"), "--series", "energies"]) == 0
    assert main(["export", folder, str(tmp_path / "b.csv"), "--set", "t_end=1"]) == 2
    assert "takes --set, --law and --engine for a scenario only" in capsys.readouterr().err
    assert main(["export", folder, str(tmp_path / "a.csv")]) == 2
    assert "a.csv must be a new file" in capsys.readouterr().err
