"""A folder of another person: nothing outside of it is written or removed, and what no run has written is refused."""

from __future__ import annotations

import json
import os
import shutil
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import nonsmooth as ns
from nonsmooth.cli.main import main
from nonsmooth.results.output import SOLUTION, Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.solution.end import RunRequest
from nonsmooth.storage.lock import LOCK
from tests.results.runs import balls
from tests.storage.forging import forge, say

MINE = "all of it"


class Dies(Exception):
    """What cuts a run off."""


@pytest.fixture(scope="module")
def cut_off(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a run that was cut off."""

    def die(t: float, t_end: float) -> None:
        raise Dies

    folder = tmp_path_factory.mktemp("cut_off") / "run"
    with pytest.raises(Dies):
        ns.simulate(balls(), 0.05, output=folder, progress=die)
    return folder


@pytest.fixture
def theirs(cut_off: Path, tmp_path: Path) -> Path:
    """Return the arrays of a folder of another person, beside files of the user."""
    home = tmp_path / "home"
    (home / "thesis").mkdir(parents=True)
    (home / "thesis" / "thesis.txt").write_text(MINE)
    (home / "settings").write_text(MINE)
    shutil.copytree(cut_off, tmp_path / "theirs")
    return tmp_path / "theirs" / SOLUTION


def _files(home: Path) -> dict[str, bytes]:
    return {str(path.relative_to(home)): path.read_bytes() for path in home.rglob("*") if path.is_file()}


def _link(path: Path, to: Path) -> None:
    path.unlink(missing_ok=True)
    path.parent.mkdir(exist_ok=True)
    path.symlink_to(to)


def _moved(place: Path, home: Path) -> None:
    """Put a link in the place of a folder."""
    shutil.move(place, home / place.name)
    place.symlink_to(home / place.name)


OUTWARDS: dict[str, Callable[[Path, Path], None]] = {
    "a coordinate over the parent": lambda at, home: say(at, scenario_coordinates="../../home/thesis"),
    "a coordinate elsewhere": lambda at, home: say(at, scenario_coordinates=str(home / "thesis")),
    "a link beside the metadata": lambda at, home: _link(at / ".zarr.json.part", home / "settings"),
    "a link beside a file": lambda at, home: _link(at.parent / ".summary.json.part", home / "settings"),
    "a link in place of a file": lambda at, home: _link(at.parent / "events.csv", home / "settings"),
    "a link that leads nowhere": lambda at, home: _link(at / "writer" / "state-end.npz", home / "new"),
    "a link in place of the lock": lambda at, home: _link(at / LOCK, home / "new"),
    "a link in place of the states": lambda at, home: _moved(at / "writer", home),
    "a link in place of an array": lambda at, home: _moved(at / "body", home),
    "a link in place of all": lambda at, home: _moved(at, home),
}


@pytest.mark.parametrize("way", OUTWARDS)
@pytest.mark.parametrize("by", ["Python", "command"])
def test_nothing_outside_is_written_or_removed(by: str, way: str, theirs: Path) -> None:
    home = theirs.parents[1] / "home"
    OUTWARDS[way](theirs, home)
    before = _files(home)
    assert ns.open_solution(theirs.parent).status == "unfinished"
    if by == "command":
        main(["resume", str(theirs.parent)])
    elif "link" in way and "file" not in way:
        with pytest.raises(ns.InvalidInput, match="must be a file or folder of its own to be written to"):
            ns.resume(theirs.parent)
    else:
        assert ns.resume(theirs.parent).status == "done"
    assert _files(home) == before


@pytest.mark.skipif(os.name != "posix", reason="there are no pipes with names")
@pytest.mark.parametrize("name", ["zarr.json", "system/c", "writer/state-0.npz"])
def test_a_pipe_is_not_read(name: str, theirs: Path) -> None:
    """Nobody would write to it."""
    (theirs / name).unlink()
    os.mkfifo(theirs / name)
    with pytest.raises(ns.InvalidInput, match="It is a pipe or a device"):
        ns.open_solution(theirs.parent)
    (theirs.parent / "system.toml").unlink(missing_ok=True)
    os.mkfifo(theirs.parent / "system.toml")
    with pytest.raises(ns.InvalidInput, match="It is a pipe or a device"):
        ns.load_system(theirs.parent / "system.toml")


REQUEST: dict[str, Any] = {"scenario": "bouncing_ball", "set": [], "law": [], "engine": None}
SAID: dict[str, tuple[Any, ...]] = {
    "engine": ('"evil.py:E"', "[]", "5", "null", '{"type": 5}', "[" * 100_000),
    "counters": ("[]", "5", "{"),
    "verdict": ("5", "[5]", "[{}]"),
    "state": ("../../home/settings", "", 5, '{"file": "../../home/settings"}', '{"file": 5}'),
}
RESUMED: dict[str, tuple[Any, ...]] = {
    "request": ("[]", "5", *(json.dumps(REQUEST | {name: [5]}) for name in REQUEST)),
    "checkpoint": ("[]", "{}", '{"file": "writer/state-0.npz"}', '{"file": "../../home/settings"}'),
    "versions": ("[]", "5"),
}


@pytest.mark.parametrize("name", [*SAID, *RESUMED])
def test_what_no_run_has_said_is_refused_by_name(name: str, theirs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for value in (SAID | RESUMED)[name]:
        say(theirs, **{name: value})
        if name in SAID:
            with pytest.raises(ns.InvalidInput, match=name):
                ns.open_solution(theirs.parent)
        else:
            assert main(["resume", str(theirs.parent)]) == 2
            assert name in capsys.readouterr().err


def test_metadata_in_one_another_without_end_are_refused(theirs: Path) -> None:
    (theirs / "zarr.json").write_text("[" * 200_000)
    with pytest.raises(ns.InvalidInput, match="must be a folder of results"):
        ns.open_solution(theirs.parent)


def test_arrays_that_contradict_one_another_are_refused(theirs: Path) -> None:
    def lengthen(content: dict[str, Any]) -> None:
        content["consolidated_metadata"]["metadata"]["event_law_state"]["shape"][0] = 10**12

    forge(theirs, lengthen)
    with pytest.raises(ns.InvalidInput, match=r"must have \d+ rows in all arrays over 'event', but it is \[10+\]"):
        ns.open_solution(theirs.parent)


def test_a_state_larger_than_the_memory_is_refused(theirs: Path) -> None:
    head = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }"
    path = theirs / "writer" / "state-0.npz"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("time.npy", b"\x93NUMPY\x01\x00v\x00" + head.ljust(117) + b"\n")
    say(theirs, state=json.dumps({"file": "writer/state-0.npz", "checksum": zlib.crc32(path.read_bytes())}))
    with pytest.raises(ns.InvalidInput, match="must hold a state"):
        ns.open_solution(theirs.parent)


def test_a_terminal_obeys_no_name_of_a_folder(theirs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As one that would change the title of its window."""
    say(theirs, request=json.dumps(REQUEST | {"scenario": "\x1b]0;theirs\x07"}))
    assert main(["resume", str(theirs.parent)]) == 0
    said = "".join(capsys.readouterr())
    assert "\\x1b]0;theirs\\x07: done" in said
    assert "\x1b" not in said


def test_a_run_that_ended_meanwhile_is_not_resumed(theirs: Path) -> None:
    """Whoever has waited for the lock goes by what the other has written."""
    first = SolutionFolder.held(Output(theirs.parent))
    with pytest.raises(ns.InvalidInput, match="must have one run at a time"):
        ns.resume(theirs.parent)
    first.close()
    assert ns.resume(theirs.parent).status == "done"
    with pytest.raises(ns.InvalidInput, match="must hold a run that was cut off, but it is 'done'"):
        ns.resume(theirs.parent)


def test_a_lock_alone_makes_no_folder_ours(tmp_path: Path) -> None:
    """Programs of others have locks, too."""
    place = tmp_path / SOLUTION
    place.mkdir()
    (place / LOCK).parent.mkdir()
    (place / LOCK).touch()
    (place / "thesis.txt").write_text(MINE)
    with pytest.raises(ns.InvalidInput, match="must be a folder that a run has made"):
        ns.simulate(balls(), 0.01, output=tmp_path)
    assert (place / "thesis.txt").read_text() == MINE
    (place / "thesis.txt").unlink()
    assert ns.simulate(balls(), 0.01, output=tmp_path).status == "done"
    # of a run that was cut off before its first commit
    request = RunRequest(1.0, 0.0, 0.1, has_default_samples=True, is_conditional=False)
    SolutionFolder.created(Output(tmp_path), balls(), ns.EventDriven(), request, n_states=0).close()
    with pytest.raises(ns.InvalidInput, match="must be a folder of results, but it is 'not there'"):
        ns.open_solution(tmp_path)
    assert ns.simulate(balls(), 0.01, output=tmp_path).status == "done"


def test_a_run_that_ended_meanwhile_stays_unless_it_may_be_replaced(tmp_path: Path) -> None:
    ns.simulate(balls(), 0.01, output=tmp_path)
    with pytest.raises(ns.InvalidInput, match="Another run has ended there meanwhile"):
        ns.simulate(balls(), 0.02, output=Output(tmp_path, overwrite=False))
    assert ns.open_solution(tmp_path).t_end == 0.01
