"""A run that was cut off goes on to the same end, to the last bit; what must not go on is refused."""

from __future__ import annotations

import contextlib
import errno
import json
import subprocess
import sys
import time
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from laws import Coulomb
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.model.checkpoint import Difference
from nonsmooth.results.description import state_bytes, state_from
from nonsmooth.results.output import OtherVersions, Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs import folder_sink
from nonsmooth.runs.identity import digest
from nonsmooth.runs.so_far import RunSoFar
from nonsmooth.solution.state import Continuation
from nonsmooth.storage.lock import locked
from tests.results.runs import balls
from tests.runs.continued import differences
from tests.storage.forging import say

ROOT = Path(__file__).parents[2]
T_END = 3.0


def _coefficient(speed: float) -> float:
    return 0.2


@final
@dataclass(frozen=True)
class Own(FrictionLaw):
    """A law that no file can name, as it is not installed."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """Constant."""
        return _coefficient

    def is_fulfilled(self, *state: Any) -> bool:
        """Nobody asks."""
        return True


@pytest.fixture(scope="module")
def whole() -> ns.Solution:
    """Return the run that nobody cut off."""
    return ns.simulate(balls(), T_END)


@pytest.fixture
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a run be written whenever it can be."""
    for name, value in (("_COMMIT_INTERVAL", 0.0), ("_FIRST_COMMIT", 0.0), ("_MOST_STEPS", 64)):
        monkeypatch.setattr(folder_sink, name, value)


def _cut_off(folder: Path, system: ns.System, at: float, sample_interval: float | None = None) -> None:
    """Run a system, and leave what a process would that dies at a time [s]."""

    class Dies(Exception):
        pass

    def die(t: float, t_end: float) -> None:
        if t > at:
            raise Dies

    with pytest.raises(Dies):
        ns.simulate(system, T_END, output=folder, progress=die, sample_interval=sample_interval)


def _content(folder: Path) -> dict[Path, bytes]:
    """Bytes of all files in a folder."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _reached(folder: Path) -> float:
    return float(SolutionFolder.opened(Output(folder)).attributes["t_end"])


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.4])
def test_a_run_that_was_killed_goes_on_to_the_same_bits(whole: ns.Solution, tmp_path: Path, share: float) -> None:
    import xarray

    place = tmp_path / "solution.zarr"
    words = [sys.executable, "-m", "tests.results.runs", str(tmp_path), str(T_END)]
    process = subprocess.Popen(words, cwd=ROOT, stderr=subprocess.PIPE)
    try:
        for _ in range(6000):
            if (place / "zarr.json").exists() and _reached(tmp_path) >= share * T_END:
                break
            assert process.poll() is None
            time.sleep(0.005)
    finally:
        process.kill()
        process.communicate()
    with xarray.open_zarr(place) as saved:
        assert saved.attrs["status"] == "unfinished"
        assert saved.attrs["t_end"] >= share * T_END
        n = saved.sizes["event"]
        np.testing.assert_array_equal(saved["event_time"], whole.events.time[:n])
        np.testing.assert_array_equal(saved["q"], whole.q[: saved.sizes["time"]])
    after = ns.resume(tmp_path)
    assert (after.status, after.message) == (whole.status, whole.message)
    assert differences(whole, after) == []
    assert differences(whole, ns.open_solution(tmp_path)) == []
    assert replace(after.counters, wall_seconds=0.0) == replace(whole.counters, wall_seconds=0.0)


@pytest.mark.usefixtures("often")
def test_a_full_disk_ends_the_run_and_it_goes_on_when_there_is_room(
    whole: ns.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write, states = Path.write_bytes, []

    def full(path: Path, content: bytes) -> int:
        states.append(".npz" in path.suffixes)
        if sum(states) > 2:  # where it begins and one more are written
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(ns.RunFailed, match="could not be written: No space left") as failed:
        ns.simulate(balls(), T_END, output=tmp_path)
    monkeypatch.setattr(Path, "write_bytes", write)
    kept = failed.value.solution
    assert isinstance(kept, ns.Solution)
    n = len(kept.events)
    np.testing.assert_array_equal(kept.events.time, whole.events.time[:n])
    assert 0.0 < ns.open_solution(tmp_path).t_end <= kept.t_end
    assert differences(whole, ns.resume(tmp_path)) == []


@pytest.mark.usefixtures("often")
def test_samples_of_a_resumed_run_have_the_interval_that_was_given(tmp_path: Path) -> None:
    """The folder keeps the arguments of the run; one that is missing is named."""
    system = balls()
    whole = ns.simulate(system, T_END, sample_interval=0.01)
    _cut_off(tmp_path, system, 0.5, 0.01)
    say(tmp_path / "solution.zarr", sample_interval=None)
    with pytest.raises(ns.InvalidInput, match=r"arguments of the run must be as a run has written it.*sample_interval"):
        ns.resume(tmp_path)
    say(tmp_path / "solution.zarr", sample_interval=0.01)
    assert differences(whole, ns.resume(tmp_path)) == []


@pytest.mark.usefixtures("often")
def test_what_cannot_go_on_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ns.InvalidInput, match="must be a folder of results"):
        ns.resume(tmp_path)
    _cut_off(tmp_path, balls(Own()), 0.5)
    lock = locked(tmp_path / "solution.zarr")
    with pytest.raises(ns.InvalidInput, match="must have one run at a time that writes, but it is 'in use'"):
        ns.resume(tmp_path, system=balls(Own()))
    lock.release()
    with pytest.raises(ns.InvalidInput, match=r"must not hold a run that .* was cut off.*nonsmooth resume"):
        ns.simulate(balls(), T_END, output=tmp_path)
    with pytest.raises(ns.InvalidInput, match="the system that ran must be given, but it is None") as refused:
        ns.resume(tmp_path)
    assert "friction must be of an installed class, so that a file can name it; it is 'Own'. " in str(refused.value)
    assert f"nonsmooth.open_solution({str(tmp_path)!r}, system=system)" in str(refused.value)
    with pytest.raises(ns.InvalidInput, match="must hold a run of this model"):
        ns.resume(tmp_path, system=balls(Coulomb(0.3)))
    versions = SolutionFolder.opened(Output(tmp_path)).said("versions")
    say(tmp_path / "solution.zarr", versions=json.dumps(versions | {"engine": "another"}))
    with pytest.warns(OtherVersions, match="engine another, now"):
        after = ns.resume(tmp_path, system=balls(Own()))
    assert differences(ns.simulate(balls(Own()), T_END), after) == []
    with pytest.raises(ns.InvalidInput, match=r"must hold a run that was cut off, but it is 'done'"):
        ns.resume(tmp_path, system=balls(Own()))


def test_a_refused_resume_leaves_the_folder_as_it_is(tmp_path: Path) -> None:
    def stop(t: float, t_end: float) -> None:
        if t > 0.3:
            raise KeyboardInterrupt

    cut = ns.simulate(balls(), T_END, output=tmp_path, progress=stop)
    assert cut.status == "interrupted"
    with contextlib.closing(SolutionFolder.held(Output(tmp_path))) as folder:
        folder.add_coordinates({"height": cut.t}, lambda name: "s")
    before = _content(tmp_path)
    with pytest.raises(ns.InvalidInput, match="must hold a run of this model"):
        ns.resume(tmp_path, system=balls(Coulomb(0.3)))
    assert _content(tmp_path) == before


def test_a_foreign_folder_runs_no_file_and_no_pickle(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[Callable[..., Any], tuple[str]]:
            return exec, ("raise SystemExit('executed')",)

    state = ns.State.at(balls())
    path = tmp_path / "state.npz"
    np.savez(path, q=np.array([Trap()], dtype=object), allow_pickle=True)
    with pytest.raises(ns.InvalidInput, match="must hold a state"):
        state_from(path.read_bytes(), "it")
    assert state_from(state_bytes(state), "it").energy == state.energy
    (tmp_path / "evil.py").write_text("raise SystemExit('executed')")
    text = f'[bodies.ball]\ntype = "{tmp_path / "evil.py"}:Ball"\n'
    _cut_off(tmp_path, balls(), 0.2)
    folder = SolutionFolder.opened(Output(tmp_path))
    folder._arrays.add("system", (), np.array(text), {}, grows=False)
    folder._arrays.commit(safely=False)
    with pytest.raises(ns.InvalidInput, match="must name what an installed package has registered"):
        ns.resume(tmp_path)


def test_a_state_from_a_file_leaves_functions_and_offsets_alone(tmp_path: Path) -> None:
    model = ns.assemble(balls())
    memory, blank, key = model._laid.memory, model._blank, model._key()
    places = tuple(np.flatnonzero(may_change) for may_change in memory.changing)
    bits = tuple(np.full(len(part), 7) for part in places)
    foreign = Continuation(key, Difference(places, bits, blank.n_slots), 0)
    folder = tmp_path / "run"
    _cut_off(folder, balls(), 0.2)
    arrays = SolutionFolder.opened(Output(folder))
    checkpoint, content = arrays.said("checkpoint"), state_bytes(model.start.with_continuation(foreign))
    (folder / "solution.zarr" / checkpoint["file"]).write_bytes(content)
    say(folder / "solution.zarr", checkpoint=json.dumps(checkpoint | {"checksum": zlib.crc32(content)}))
    with pytest.raises(ns.InvalidInput, match=r"State\.continuation: \w+ must be from 0"):
        model.resume(folder)
    for part, before, may_change in zip(memory.kept, blank.parts, memory.changing, strict=True):
        np.testing.assert_array_equal(part[~may_change], before[~may_change])
    assert digest(model._laid, model.engine) == key


def test_a_run_that_ends_on_a_condition_needs_it_again(tmp_path: Path, often: None) -> None:
    """No file holds it: without it nothing goes on, with it the run ends where the undisturbed one does."""

    def until(run: RunSoFar) -> bool:
        return run.n_impacts >= 9

    def dies(run: RunSoFar) -> bool:
        if run.n_impacts >= 6:
            raise ArithmeticError
        return False

    whole = ns.simulate(balls(), T_END, until=until)
    with pytest.raises(ArithmeticError):
        ns.simulate(balls(), T_END, until=dies, output=tmp_path)
    with pytest.raises(ns.InvalidInput, match="until must be given for a run that was to end on a condition"):
        ns.resume(tmp_path)
    after = ns.resume(tmp_path, until=until)
    assert (after.status, after.message, after.counters.impacts) == ("done", whole.message, 9)
    assert differences(whole, after) == []
