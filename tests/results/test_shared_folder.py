"""What a folder of results holds is not lost to another run, nor to a run of another folder's name."""

from __future__ import annotations

import shutil
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import nonsmooth as ns
from nonsmooth.results.output import SOLUTION
from nonsmooth.storage.lock import LOCK, WRITER, locked
from tests.results.runs import balls


@pytest.mark.parametrize("kind", ["folder", "file", "link"])
def test_what_no_run_has_made_is_not_removed(kind: str, tmp_path: Path) -> None:
    place = tmp_path / SOLUTION
    other = tmp_path / "thesis"
    other.mkdir()
    (other / "thesis.txt").write_text("all of it")
    if kind == "folder":
        other.rename(place)
    elif kind == "file":
        place.write_text("all of it")
    else:
        place.symlink_to(other)
    with pytest.raises(ns.InvalidInput, match=f"{SOLUTION} must be a folder that a run has made"):
        ns.simulate(balls(), 0.01, output=tmp_path)
    kept = place if kind == "file" else place / "thesis.txt"
    assert kept.read_text() == "all of it"


@pytest.mark.parametrize("with_lock", [True, False])
def test_a_finished_run_gives_way(with_lock: bool, tmp_path: Path) -> None:
    """Also one that was copied without hidden files."""
    ns.simulate(balls(), 0.01, output=tmp_path)
    if not with_lock:
        (tmp_path / SOLUTION / LOCK).unlink()
    run = ns.simulate(balls(), 0.02, output=tmp_path)
    assert ns.open_solution(tmp_path).t_end == run.t_end == 0.02


def test_a_second_run_is_refused_and_the_first_one_loses_nothing(tmp_path: Path) -> None:
    """While the first one writes there, whether or not it has come to its first commit."""
    ns.simulate(balls(), 0.01, output=tmp_path)
    before = ns.open_solution(tmp_path)
    lock = locked(tmp_path / SOLUTION)
    with pytest.raises(ns.InvalidInput, match="must have one run at a time that writes, but it is 'in use'"):
        ns.simulate(balls(), 0.02, output=tmp_path)
    assert ns.open_solution(tmp_path).t_end == before.t_end
    lock.release()
    for entry in (tmp_path / SOLUTION).iterdir():
        # a run that has just begun has made nothing but its lock
        if entry.name != WRITER:
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
    assert ns.simulate(balls(), 0.02, output=tmp_path).status == "done"


@pytest.mark.slow
def test_of_two_runs_that_begin_at_once_one_is_done_and_the_other_refused(tmp_path: Path) -> None:
    """A hundred times, in a new folder and in that of a finished run by turns."""
    ends, gate = (0.05, 0.06), threading.Barrier(2)

    def begin(t_end: float) -> str:
        model = ns.assemble(balls())
        gate.wait()
        try:
            return model.run(t_end, output=tmp_path).status
        except ns.InvalidInput as error:
            return str(error)

    with ThreadPoolExecutor(2) as pool:
        for n in range(100):
            if n % 2:
                shutil.rmtree(tmp_path / SOLUTION)
            said = list(pool.map(begin, ends))
            done = [end for end, one in zip(ends, said, strict=True) if one == "done"]
            # one that ends before the other begins is replaced by that
            refused = ("must have one run at a time that writes", "must not hold a run that is under way")
            assert len(done) == 2 or any(rule in one for one in said for rule in refused)
            found = ns.open_solution(tmp_path)
            assert (found.status, found.t_end in done) == ("done", True)
