"""``nonsmooth run --out``: the files, and what happens where they cannot be written."""

from __future__ import annotations

import importlib.util
import json
import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

Call = Callable[..., tuple[int, str, str]]
_PNG = b"\x89PNG\r\n"


@contextmanager
def _largest_file(size: int) -> Iterator[None]:
    """Let no file grow over ``size`` bytes: what a full disk does, without one."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.slow
def test_results_events_summary_and_figures(call: Call, tmp_path: Path) -> None:
    import xarray

    folder = tmp_path / "new" / "results"
    status, output, errors = call("run", "tiny", "--json", "--out", str(folder))
    assert status == 0
    assert f"results are in {folder}\n" in errors
    assert sorted(p.name for p in folder.iterdir()) == [
        "events.csv",
        "height.png",
        "solution.zarr",
        "summary.json",
        "transitions.png",
    ]
    assert json.loads((folder / "summary.json").read_text()) == json.loads(output)
    for name in ("height.png", "transitions.png"):
        assert (folder / name).read_bytes().startswith(_PNG)
    with xarray.open_zarr(folder / "solution.zarr") as saved:
        assert saved.sizes["event"] == json.loads(output)["n_events"]
        np.testing.assert_array_equal(saved["height"], saved["q"][:, 2])


@pytest.mark.slow
def test_a_disk_that_is_full_in_a_run_is_an_error_with_the_path(call: Call, tmp_path: Path) -> None:
    call("run", "tiny", "--out", str(tmp_path / "first"))  # so that what is compiled or cached is there already
    folder = tmp_path / "full"
    with _largest_file(4096):
        status, output, errors = call("run", "tiny", "--json", "--out", str(folder))
    assert status == 1
    assert json.loads(output)["status"] == "failed"
    full = folder / "solution.zarr" / "zarr.json"
    assert f"error: {full} could not be written: File too large." in errors
    assert "Traceback" not in errors
    assert [path.name for path in folder.iterdir()] == ["solution.zarr"]


@pytest.mark.parametrize(("folder", "size"), [("file/results", -1), ("file", -1), ("", -1), ("full", 0)])
def test_a_wrong_folder_is_found_before_the_run(call: Call, tmp_path: Path, folder: str, size: int) -> None:
    """It is a wrong request, of which nothing else is told."""
    (tmp_path / "file").touch()
    where = str(tmp_path / folder) if folder else ""
    with _largest_file(size):
        status, output, errors = call("run", "tiny", "--json", "--out", where)
    assert (status, output) == (2, "")
    *_, told = errors.splitlines()
    assert told.startswith(f"error: {where or 'folder of results'} must be a ")
    assert errors.count("error: ") == 1


@pytest.mark.slow
def test_results_are_not_overwritten_unasked(call: Call, tmp_path: Path) -> None:
    assert call("run", "tiny", "--out", str(tmp_path))[0] == 0
    before = (tmp_path / "summary.json").read_bytes()
    for command in ("run", "figures"):
        status, output, errors = call(command, "tiny", "--out", str(tmp_path))
        assert (status, output) == (2, "")
        assert f"error: {tmp_path} must be a folder that is empty or new, " in errors
        assert "add --overwrite" in errors
    assert (tmp_path / "summary.json").read_bytes() == before
    assert call("run", "tiny", "--set", "t_end=0.1", "--out", str(tmp_path), "--overwrite")[0] == 0
    assert json.loads((tmp_path / "summary.json").read_text())["t_end"] == 0.1


@pytest.mark.slow
def test_a_figure_that_fails_costs_nothing_else(call: Call, tmp_path: Path) -> None:
    status, output, errors = call("run", "tiny", "--json", "--set", "mode=bad figure", "--out", str(tmp_path))
    assert status == 1
    assert json.loads(output)["status"] == "done"
    assert "error: Tiny.figures failed: ZeroDivisionError: a figure that fails\n" in errors
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "events.csv",
        "solution.zarr",
        "summary.json",
        "transitions.png",
    ]


@pytest.mark.parametrize("command", ["run", "figures"])
def test_missing_packages_are_told_before_the_run(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "matplotlib" else find(name))
    status, output, errors = call(command, "tiny", "--out", str(tmp_path / "results"))
    assert status == 2
    assert output == ""
    assert 'error: --out needs matplotlib: pip install "nonsmooth[full]"\n' in errors
    assert list(tmp_path.iterdir()) == []
