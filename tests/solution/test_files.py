"""Result files: what is in them, and that they are whole or not there."""

from __future__ import annotations

import csv
import errno
import stat
from pathlib import Path

import numpy as np
import pytest

from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth import Solution, System, simulate
from nonsmooth.solution import files


@pytest.fixture(scope="module")
def solution() -> Solution:
    """Return a ball that bounces and comes to rest."""
    ball, plate = Ball(radius=5e-3), Plate()
    system = System([ball, plate])
    system.place(ball, position=(0.0, 0.0, 2e-2), velocity=(0.1, 0.0, 0.0))
    system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(restitution=0.3))
    return simulate(system, 0.2)


def test_the_dataset_comes_back_as_it_was(solution: Solution, tmp_path: Path) -> None:
    import xarray

    paths = files.save(solution, tmp_path / "a" / "b", {"height": solution.q[:, 2]})
    assert [path.name for path in paths] == ["solution.nc", "events.csv"]
    with xarray.open_dataset(paths[0], engine="h5netcdf") as saved:
        saved.load()
    np.testing.assert_array_equal(saved["q"], solution.q)
    np.testing.assert_array_equal(saved["u"], solution.u)
    np.testing.assert_array_equal(saved["time"], solution.t)
    np.testing.assert_array_equal(saved["height"], solution.q[:, 2])
    np.testing.assert_array_equal(saved["event_time"], solution.events.time)
    np.testing.assert_array_equal(saved["impulse"], solution.events.impulse)
    assert saved["mode_after"].values.tolist() == solution.events.words("after")
    assert saved["event_cause"].values.tolist() == solution.events.causes()
    assert saved["impulse"].attrs["units"] == "N s"
    assert saved.attrs["energy_residual"] == solution.energy.residual
    assert saved.attrs["status"] == "done"


def test_the_table_has_every_event_exactly(solution: Solution, tmp_path: Path) -> None:
    _, path = files.save(solution, tmp_path)
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    assert head[:6] == ["time [s]", "cause", "contact or guard", "mode before", "mode during", "mode after"]
    assert [float(row[0]) for row in rows] == solution.events.time.tolist()
    assert [tuple(row[1:2] + row[3:6]) for row in rows] == [line[1:] for line in solution.transitions()]
    assert [float(row[8]) for row in rows] == solution.events.restitution_loss.tolist()
    assert {row[2] for row in rows} == {"", "plate - ball"}


def test_what_fails_leaves_the_old_file_and_no_other(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("old")

    def half() -> None:
        with files.replacing(path) as part:
            part.write_text("half")
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(files.FileError, match=f"{path} could not be written: No space left on device"):
        half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_cannot_be_written_does_not_cost_the_other(solution: Solution, tmp_path: Path) -> None:
    (tmp_path / "solution.nc" / "in the way").mkdir(parents=True)
    with pytest.raises(files.FileError, match=r"solution\.nc could not be written"):
        files.save(solution, tmp_path)
    assert (tmp_path / "events.csv").stat().st_size > 0
    assert not list(tmp_path.glob(".*"))


def test_prepare_makes_the_folder_and_leaves_nothing_in_it(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    files.prepare(folder)
    assert stat.S_ISDIR(folder.stat().st_mode)
    assert not list(folder.iterdir())


def test_prepare_refuses_what_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(files.FileError, match="could not be written"):
        files.prepare(tmp_path / "file" / "results")
    with pytest.raises(files.FileError, match=r"file could not be written: It is a file\. Name a folder"):
        files.prepare(tmp_path / "file")
