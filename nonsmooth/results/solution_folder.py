"""The solution of a run on disk: it grows with the run, and tells where the run goes on if it was cut off."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_kind
from nonsmooth.datasets import described
from nonsmooth.engine.memory.layout import BOOKED, N_ACCOUNTS
from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import LabelledArray
from nonsmooth.interfaces import Engine
from nonsmooth.results.damage import naming_damage
from nonsmooth.results.description import MESSAGE, UNFINISHED, attributes_of, energies, system_variable
from nonsmooth.results.lock import LOCK, Lock, check_no_links, is_marked
from nonsmooth.results.output import Output
from nonsmooth.results.state_file import state_bytes, state_from
from nonsmooth.results.zarr_folder import ZarrFolder
from nonsmooth.solution.events import Events
from nonsmooth.solution.files import FileError, content_of
from nonsmooth.solution.request import RunRequest
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.solution.variables import (
    GROWING,
    events_of,
    of_events,
    of_memory,
    of_rest_of_events,
    of_rest_of_samples,
    of_samples,
    of_system,
)
from nonsmooth.system.system import System

Floats = NDArray[np.float64]
_STATES = ("state/0.npz", "state/1.npz")
"""By turns: the one that the last commit names is not touched."""
_LAST = "state/end.npz"
_OWN = "scenario_coordinates"
"""Attribute with the names of what the scenario adds."""


@final
class SolutionFolder:
    """The arrays of a solution in a folder, and the state from which the run goes on.

    Parameters
    ----------
    arrays : ZarrFolder
        The arrays.
    n_q, n_u : int
        Numbers of coordinates and velocities.
    lock : Lock or None
        What lets nobody else write there.
    """

    def __init__(self, arrays: ZarrFolder, n_q: int, n_u: int, lock: Lock | None = None) -> None:
        self._arrays, self._n_q, self._n_u, self._lock = arrays, n_q, n_u, lock
        self._lengths = dict.fromkeys(GROWING, 0)
        self._safe = False

    @classmethod
    def created(
        cls, output: Output, system: System, engine: Engine, request: RunRequest, n_states: int
    ) -> SolutionFolder:
        """Make the folder of a run that begins; what it holds counts from the first :meth:`append` on.

        Raises
        ------
        InvalidInput
            If a run was cut off there, or writes there, or the folder is none of a run.
        FileError
            If it cannot be written.
        """
        path = output.solution
        check_ours(path)
        # not with the lock at first, for which whoever has just ended would have to wait
        _check_may_be_emptied(output)
        # from here on nobody else writes there: what another run has begun meanwhile is not removed
        lock = Lock(path)
        try:
            check_free(output)
            _check_may_be_emptied(output)
            lock.mark()
            _empty(path)
        except BaseException:
            lock.close()
            raise
        made = ZarrFolder(path, attributes_of(output, engine, request))
        found = cls(made, sum(body.n_q for body in system.bodies), sum(body.n_u for body in system.bodies), lock)
        for variable in (
            *of_system(system),
            *of_memory(),
            system_variable(system, output, engine, request.t_end, made.attributes),
        ):
            made.add(variable, grows=False)
        n_y = found._n_q + found._n_u + N_ACCOUNTS + n_states
        sizes = len(system.contacts), found._n_q, found._n_u, n_y
        nothing = Events.from_buffers(np.zeros(0), np.zeros(0, np.int64), *sizes)
        for variable in found._variables(nothing, np.zeros((0, 1 + n_y + BOOKED))):
            made.add(variable, grows=True)
        return found

    @classmethod
    def opened(cls, output: Output) -> SolutionFolder:
        """Open the folder of a run.

        Raises
        ------
        InvalidInput
            If there is none.
        """
        return cls._of(ZarrFolder.opened(output.solution))

    @classmethod
    def held(cls, output: Output) -> SolutionFolder:
        """Open the folder of a run to write to it; nobody else does until it is closed.

        Raises
        ------
        InvalidInput
            If there is none, it holds a link, or another run writes there.
        FileError
            If it cannot be written to.
        """
        # a folder without a run gets no lock
        cls.opened(output)
        check_no_links(output.solution)
        lock = Lock(output.solution)
        try:
            # what another run has written until it gave the lock back counts
            return cls._of(ZarrFolder.opened(output.solution), lock)
        except BaseException:
            lock.close()
            raise

    @classmethod
    def _of(cls, arrays: ZarrFolder, lock: Lock | None = None) -> SolutionFolder:
        try:
            found = cls(arrays, arrays.length("coordinate"), arrays.length("velocity"), lock)
            found._lengths = {"time": arrays.length("time"), "event": arrays.length("event_time")}
            found._lengths["listing"] = arrays.length("listed_contact")
        except KeyError as error:
            raise InvalidInput(
                str(arrays.path), "must hold a solution", f"no {error}", "Name a folder that `run` wrote."
            ) from error
        return found

    @property
    def attributes(self) -> dict[str, Any]:
        """What is said of the run."""
        return self._arrays.attributes

    @property
    def place(self) -> Path:
        """The folder of the results, in which that of the arrays is."""
        return self._arrays.path.parent

    @property
    def status(self) -> str:
        """That of the solution, or "unfinished"."""
        return str(self.attributes.get("status"))

    def said(self, name: str, kind: type = dict) -> Any:
        """Return an attribute that holds more than a number or a word: a table or, where asked for, a list.

        Raises
        ------
        InvalidInput
            If it is not there, or something else.
        """
        thing = f"{self._arrays.path}: {name}"
        try:
            found = json.loads(self.attributes[name])
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise InvalidInput(thing, "must be there", None, "Name a folder that `run` wrote.") from error
        check_kind(thing, found, kind, "It is damaged.")
        return found

    def system_text(self) -> str:
        """Return the system as a scenario file, "" where it could not be written."""
        return str(self._arrays.read("system"))

    def events(self) -> Events:
        """Return all events."""
        with naming_damage(f"{self._arrays.path}: events"):
            return events_of(self._arrays.read, self._arrays.length("contact"))

    def rows(self) -> Floats:
        """Return all samples: time, q, u, accounts, inner states of laws, what is booked, shape [n, 1 + n_y + 4]."""
        parts = [self._arrays.read(name) for name in ("time", "q", "u", "account", "law_state", "booked")]
        if len(lengths := {len(part) for part in parts}) > 1:
            rule = "must have one number of samples in all of its arrays"
            raise InvalidInput(f"{self._arrays.path}", rule, sorted(lengths), "Results are damaged there.")
        return np.column_stack(parts) if len(parts[0]) else np.zeros((0, 1 + sum(p.shape[1] for p in parts[1:])))

    def state(self) -> State:
        """Return the state that belongs to the last commit."""
        name = str(self.attributes.get("state"))
        if name not in (*_STATES, _LAST):
            raise InvalidInput(f"{self._arrays.path}: state", "must name a state", name, "It is damaged.")
        return self._state(name)

    @property
    def request(self) -> RunRequest:
        """The arguments of the run.

        Raises
        ------
        InvalidInput
            If one is missing, or no number.
        """
        found = self.attributes
        with naming_damage(f"{self._arrays.path}: arguments of the run"):
            return RunRequest(
                float(found["t_end_asked"]),
                float(found["sample_start"]),
                float(found["sample_interval"]),
                bool(found["default_samples"]),
                bool(found["conditional"]),
            )

    @property
    def wall_seconds(self) -> float:
        """How long the run took until its last checkpoint [s]."""
        with naming_damage(f"{self._arrays.path}: checkpoint"):
            return float(self.said("checkpoint")["wall_seconds"])

    def check_cut_off(self) -> None:
        """Raise InvalidInput unless it holds a run that was cut off."""
        if "checkpoint" not in self.attributes:
            raise InvalidInput(
                f"{self.place}",
                "must hold a run that was cut off",
                self.status,
                "To go on behind its end, run its model from the `state` of nonsmooth.open_solution.",
            )

    def state_at_checkpoint(self) -> State:
        """State of the run at its last checkpoint. The folder stays as it is.

        Raises
        ------
        InvalidInput
            If there is none.
        """
        return self._state(self._checkpoint_state())

    def cut_to_checkpoint(self) -> None:
        """Remove what the run had done after its last checkpoint.

        Raises
        ------
        InvalidInput
            If there is none.
        """
        name, checkpoint = self._checkpoint_state(), self.said("checkpoint")
        for coordinate in str(self.attributes.pop(_OWN, "")).split():
            self._arrays.remove(coordinate)
        with naming_damage(f"{self._arrays.path}: checkpoint"):
            lengths = {one: min(max(0, int(checkpoint[one])), self._lengths[one]) for one in GROWING}
        for dimension, length in lengths.items():
            self._lengths[dimension] = length
            self._arrays.cut(dimension, length)
        self.attributes["state"], self._safe = name, True

    def _checkpoint_state(self) -> str:
        """Name of the state of the last checkpoint."""
        name = str(self.said("checkpoint").get("state"))
        if name not in _STATES:
            raise InvalidInput(f"{self._arrays.path}: checkpoint", "must name a state", name, "It is damaged.")
        return name

    def append(self, events: Events, rows: Floats, state: State, wall: float) -> None:
        """Append what a run has done since, with the state from which it goes on.

        Parameters
        ----------
        events : Events
            Further events.
        rows : array
            Further samples, as :meth:`rows` returns them.
        state : State
            Where the run is, after these and before any other.
        wall : float
            Time that the run took [s].

        Raises
        ------
        FileError
            If that cannot be written; what was there before is.
        """
        self._put_checkpoint(events, rows, state, wall)
        self._arrays.commit_safely()
        self._safe = True

    def begin(self, events: Events, rows: Floats, state: State, wall: float) -> None:
        """Write where a run begins or goes on, as :meth:`append` does.

        Raises
        ------
        FileError
            If that cannot be written.
        """
        self._put_checkpoint(events, rows, state, wall)
        self._commit()

    def _put_checkpoint(self, events: Events, rows: Floats, state: State, wall: float) -> None:
        lengths = self._write(events, rows)
        name = _STATES[self.attributes.get("state") == _STATES[0]]
        self._arrays.file(name, state_bytes(state))
        checkpoint = json.dumps({"state": name, "wall_seconds": wall, **lengths})
        self.attributes.update(
            status=UNFINISHED, message=MESSAGE, state=name, checkpoint=checkpoint, t_end=state.time, **energies(state)
        )
        self._lengths = lengths

    def finish(self, events: Events, rows: Floats, solution: Solution) -> None:
        """Append the last events and samples, and say how the run ended.

        Raises
        ------
        FileError
            If that cannot be written; what was there before is.
        """
        lengths = self._write(events, rows)
        self._arrays.file(_LAST, state_bytes(solution.state))
        self.attributes.update(
            status=solution.status,
            message=solution.message,
            state=_LAST,
            t_end=solution.t_end,
            counters=json.dumps(vars(solution.counters) | {"limits": dict(solution.counters.limits)}),
            cause=solution.end.cause,
            verdict=json.dumps([{**vars(one), "value": value} for one, value in solution.end.verdict.items()]),
            **energies(solution.state),
        )
        if solution.status in ("done", "suspect"):
            self.attributes.pop("checkpoint", None)
        self._lengths = lengths
        self._commit()
        self._arrays.spell_out(self._arrays.names)
        if "checkpoint" not in self.attributes:
            for name in _STATES:
                (self._arrays.path / name).unlink(missing_ok=True)

    def add_coordinates(self, coordinates: Mapping[str, Any], unit_of: Callable[[str], str]) -> None:
        """Add the scenario's own coordinates over the samples: name -> array [n_samples], and the unit of each.

        Raises
        ------
        InvalidInput
            If a name cannot be that of a folder, or is taken, or an array is not of numbers.
        FileError
            If that is not possible.
        """
        own = self.attributes.get(_OWN, "").split()
        taken = sorted(coordinates.keys() & (self._arrays.names - {*own}))
        if taken:
            raise InvalidInput("coordinates", "must have names of their own", taken, "Rename them.")
        arrays = {name: np.asarray(values) for name, values in coordinates.items()}
        strange = sorted(name for name, values in arrays.items() if values.dtype.kind not in "biuf")
        if strange:
            raise InvalidInput("coordinates", "must be arrays of numbers", strange, "Return floats over the samples.")
        self.attributes[_OWN] = " ".join(coordinates)
        for name, values in arrays.items():
            attributes = described(f"coordinate of the scenario: {name}", unit_of(name))
            self._arrays.add(LabelledArray(name, ("time",), values, attributes), grows=True)
        self._arrays.commit()
        self._arrays.spell_out(coordinates)

    def close(self) -> None:
        """Let others write there."""
        if self._lock is not None:
            self._lock.close()

    def _commit(self) -> None:
        # what a run did in less than a second can be had again
        if self._safe:
            self._arrays.commit_safely()
        else:
            self._arrays.commit()

    def _write(self, events: Events, rows: Floats) -> dict[str, int]:
        lengths = dict(self._lengths)
        for variable in self._variables(events, rows):
            first = self._lengths[variable.dimensions[0]]
            self._arrays.write(variable.name, first, variable.values)
            lengths[variable.dimensions[0]] = first + len(variable.values)
        return lengths

    def _variables(self, events: Events, rows: Floats) -> list[LabelledArray]:
        n_states = rows.shape[1] - 1 - self._n_q - self._n_u - N_ACCOUNTS - BOOKED
        parts = np.cumsum([1, self._n_q, self._n_u, N_ACCOUNTS, n_states])
        t, q, u, *rest = np.split(rows, parts, axis=1)
        samples = [*of_samples(t[:, 0], q, u), *of_rest_of_samples(*rest)]
        return [*samples, *of_events(events), *of_rest_of_events(events)]

    def _state(self, name: str) -> State:
        path = self._arrays.path / name
        try:
            return state_from(content_of(path), str(path))
        except OSError as error:
            raise InvalidInput(str(path), "must be there", error.strerror, "It is damaged.") from error


def check_free(output: Output) -> None:
    """Look whether new results may go to a folder.

    Raises
    ------
    InvalidInput
        If a run that was cut off can go on there.
    """
    try:
        status = SolutionFolder.opened(output).status
    except InvalidInput:
        return
    if status == UNFINISHED:
        raise InvalidInput(
            str(output.folder),
            "must not hold a run that goes on or was cut off",
            UNFINISHED,
            f"`nonsmooth resume {output.folder}` goes on with it; remove {output.solution} to give it up.",
        )


def check_ours(path: Path) -> None:
    """Look whether a folder of arrays is new, empty or one that a run has made, so that it may be emptied.

    Raises
    ------
    InvalidInput
        If it holds anything else.
    FileError
        If it cannot be read.
    """
    if path.is_symlink() or (path.exists() and not path.is_dir()):
        what = "a link" if path.is_symlink() else "a file"
        raise InvalidInput(str(path), "must be a folder that a run has made", what, "Name another folder.")
    try:
        names = sorted(one.name for one in path.iterdir()) if path.exists() else []
    except OSError as error:
        raise FileError(path, error) from error
    if names not in ([], [LOCK]) and not is_marked(path) and not _is_solution(path):
        raise InvalidInput(
            str(path),
            "must be a folder that a run has made, as it would be emptied",
            f"a folder with {', '.join(map(repr, names[:3]))}",
            "Name another folder.",
        )


def _check_may_be_emptied(output: Output) -> None:
    """Raise InvalidInput if another run has ended there that this one must not replace."""
    if not output.overwrite and _is_solution(output.solution):
        rule, remedy = "must be a folder that is empty or new", "Another run has ended there meanwhile: name another."
        raise InvalidInput(str(output.folder), rule, "a folder with results", remedy)


def _is_solution(path: Path) -> bool:
    """Return whether a folder holds the solution of a run, also one that was copied without its lock."""
    try:
        return "versions" in ZarrFolder.opened(path).attributes
    except InvalidInput:
        return False


def _empty(path: Path) -> None:
    """Remove all but the lock, by which the folder is held."""
    try:
        for one in path.iterdir():
            if one.name == LOCK:
                continue
            if one.is_dir() and not one.is_symlink():
                shutil.rmtree(one)
            else:
                one.unlink()
    except OSError as error:
        raise FileError(path, error) from error
