"""The solution of a run on disk, which grows with the run, and the state from which the run is resumed."""

from __future__ import annotations

import contextlib
import json
import zlib
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_kind
from nonsmooth.datasets import described
from nonsmooth.engine.memory.layout import BOOKED, N_ACCOUNTS
from nonsmooth.errors import InvalidInput, NonsmoothError
from nonsmooth.histories.history import LabelledArray
from nonsmooth.interfaces import Engine
from nonsmooth.results.description import (
    MESSAGE,
    UNFINISHED,
    attributes_of,
    energies,
    state_bytes,
    state_from,
    system_variable,
)
from nonsmooth.results.output import Output
from nonsmooth.results.overwriting import arrays_of_run, check_ours, check_replaceable, empty
from nonsmooth.solution.end import RunRequest
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.solution.variables import (
    GROWING,
    SAMPLES,
    of_all_of_events,
    of_memory,
    of_samples,
    of_system,
    stored_events,
)
from nonsmooth.storage.array_folder import ArrayFolder
from nonsmooth.storage.files import content_of
from nonsmooth.storage.lock import WRITER, check_no_links, locked
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from filelock import BaseFileLock

Floats = NDArray[np.float64]
_STATES = (f"{WRITER}/state-0.npz", f"{WRITER}/state-1.npz")
"""Files of the state, used in turns: the file that the last commit names is not overwritten."""
_LAST = f"{WRITER}/state-end.npz"
"""File of the state at the end of the run."""
_OWN = "scenario_coordinates"
"""Attribute with the names of the arrays that the scenario adds."""
_LENGTHS = {"time": "time", "event": "event_time", "listing": "listed_contact"}
"""Dimension that grows during a run -> name of an array whose length is the length of this dimension."""


@contextlib.contextmanager
def naming_damage(thing: str) -> Iterator[None]:
    """Context in which an error caused by damaged content becomes InvalidInput, whose message names ``thing``.

    Raises
    ------
    InvalidInput
        A value is missing or of another kind.
    """
    try:
        yield
    except NonsmoothError:
        raise
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise InvalidInput(thing, "must be as a run has written it", reason, "It is damaged.") from error


@final
class SolutionFolder:
    """The arrays of a solution in a folder, and the state from which the run is resumed.

    Parameters
    ----------
    arrays : ArrayFolder
        The arrays.
    lock : BaseFileLock or None
        The lock of the folder, if it is written to.
    """

    def __init__(self, arrays: ArrayFolder, lock: BaseFileLock | None = None) -> None:
        self._arrays, self._lock = arrays, lock
        self._safe = False
        # numbers of coordinates and velocities; then the committed lengths of growing dimensions (samples, events)
        self._n_q, self._n_u = (arrays.layout(name).shape[0] for name in ("coordinate", "velocity"))
        self._lengths = {dimension: arrays.layout(name).shape[0] for dimension, name in _LENGTHS.items()}

    @classmethod
    def created(
        cls, output: Output, system: System, engine: Engine, request: RunRequest, n_states: int
    ) -> SolutionFolder:
        """Make the folder of a run that begins. Other processes can read it after the first :meth:`begin`.

        Raises
        ------
        InvalidInput
            A run was cut off in the folder or writes to it, or the folder was not made by a run.
        FileError
            The folder cannot be written to.
        """
        path = output.solution
        # check first without the lock, because a process that has just ended may still own it
        check_ours(path)
        check_replaceable(output)
        # check again under the lock, so that the results of a run that has begun meanwhile are not removed
        lock = locked(path)
        try:
            check_replaceable(output)
            attributes = attributes_of(output, engine, request)
            arrays = ArrayFolder(path, attributes)
            arrays.mark()
            empty(path, (*_STATES, _LAST))
            for one in (
                *of_system(system),
                *of_memory(),
                system_variable(system, output, engine, request.t_end, attributes),
            ):
                arrays.add(one.name, one.dimensions, one.values, one.attributes, grows=False)
            n_q, n_u = (sum(getattr(body, name) for body in system.bodies) for name in ("n_q", "n_u"))
            n_y = n_q + n_u + N_ACCOUNTS + n_states
            nothing = Events.from_buffers(np.zeros(0), np.zeros(0, np.int64), len(system.contacts), n_q, n_u, n_y)
            for one in _variables(nothing, np.zeros((0, 1 + n_y + BOOKED)), n_q, n_u):
                arrays.add(one.name, one.dimensions, one.values, one.attributes, grows=True)
            return cls(arrays, lock)
        except BaseException:
            lock.release()
            raise

    @classmethod
    def opened(cls, output: Output, lock: BaseFileLock | None = None) -> SolutionFolder:
        """Open the folder of a run. ``lock`` is the lock that the caller holds to write to it, None to read only.

        Raises
        ------
        InvalidInput
            The folder has no solution, another version wrote it, or it is damaged.
        """
        arrays, remedy = arrays_of_run(output.solution), "Name a folder that `run` wrote."
        for name in ("coordinate", "velocity", *_LENGTHS.values()):
            if name not in arrays.names:
                raise InvalidInput(str(arrays.path), "must hold a solution", f"no {name!r}", remedy)
        found = cls(arrays, lock)
        for dimension, length in found._lengths.items():
            layouts = map(arrays.layout, arrays.names)
            others = {one.shape[0] for one in layouts if one.dimensions[:1] == (dimension,)} - {length}
            if others:
                rule = f"must have {length} rows in all arrays over {dimension!r}"
                raise InvalidInput(str(arrays.path), rule, sorted(others), "Results are damaged there.")
        return found

    @classmethod
    def held(cls, output: Output) -> SolutionFolder:
        """Open the folder of a run to write to it; no other process can write until :meth:`close`.

        Raises
        ------
        InvalidInput
            The folder has no solution, has a link, or another run writes to it.
        FileError
            The folder cannot be written to.
        """
        # opened first, so that a folder without a run gets no lock
        cls.opened(output)
        check_no_links(output.solution)
        lock = locked(output.solution)
        try:
            # opened again, because another run may have written before it released the lock
            return cls.opened(output, lock)
        except BaseException:
            lock.release()
            raise

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes of the run in the metadata of its folder, by name, such as "status" and "message"."""
        return self._arrays.attributes

    @property
    def place(self) -> Path:
        """The folder of the results, which contains the folder of the arrays."""
        return self._arrays.path.parent

    @property
    def status(self) -> str:
        """Status of the solution, or "unfinished"."""
        return str(self.attributes.get("status"))

    def said(self, name: str, kind: type = dict) -> Any:
        """Value of the attribute ``name``, which is stored as JSON text; it must be of the type ``kind``.

        Raises
        ------
        InvalidInput
            The attribute is missing, or of another kind.
        """
        thing = f"{self._arrays.path}: {name}"
        try:
            found = json.loads(self.attributes[name])
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise InvalidInput(thing, "must be there", None, "Name a folder that `run` wrote.") from error
        check_kind(thing, found, kind, "It is damaged.")
        return found

    def system_text(self) -> str:
        """Text of a scenario file with the system that ran; "" if a scenario file cannot hold this system."""
        return str(self._arrays.read("system"))

    def events(self) -> Events:
        """All events that are committed; each of their columns is read when it is needed."""
        lengths, arrays = dict(self._lengths), self._arrays

        def read(name: str, start: int, stop: int | None) -> NDArray[Any]:
            dimension = arrays.layout(name).dimensions[0]
            return arrays.read(name, start, lengths[dimension] if stop is None else stop)

        return stored_events(read, lengths["event"], arrays.layout("contact").shape[0])

    def stored(self) -> tuple[Events, Callable[[], Floats]]:
        """Events committed so far, and a function that reads the samples committed so far, without later ones."""
        return self.events(), partial(self.rows, self._lengths["time"])

    def rows(self, n: int | None = None) -> Floats:
        """The first ``n`` samples, by default all that are committed.

        A row has time [s], q, u, energy accounts [J], inner states of laws, and energies accounted at events [J]; shape
        [n, 1 + n_y + 4].
        """
        parts = [self._arrays.read(name, 0, self._lengths["time"] if n is None else n) for name in SAMPLES]
        return np.column_stack(parts) if len(parts[0]) else np.zeros((0, 1 + sum(p.shape[1] for p in parts[1:])))

    def state(self) -> State:
        """The state at the last commit."""
        return self._state("state", self.said("state"), (*_STATES, _LAST))

    @property
    def request(self) -> RunRequest:
        """Arguments of the run, as the folder stores them.

        Raises
        ------
        InvalidInput
            An argument is missing, or is not a number.
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
        """Wall time of the run until its last checkpoint [s]."""
        with naming_damage(f"{self._arrays.path}: checkpoint"):
            return float(self.said("checkpoint")["wall_seconds"])

    def check_cut_off(self) -> None:
        """Raise InvalidInput unless the folder holds a run that was cut off."""
        if "checkpoint" not in self.attributes:
            raise InvalidInput(
                f"{self.place}",
                "must hold a run that was cut off",
                self.status,
                "To continue it after its end, run its model from the `state` of nonsmooth.open_solution.",
            )

    def state_at_checkpoint(self) -> State:
        """State of the run at its last checkpoint. The folder does not change.

        Raises
        ------
        InvalidInput
            The folder has no checkpoint.
        """
        return self._state("checkpoint", self.said("checkpoint"), _STATES)

    def cut_to_checkpoint(self) -> None:
        """Remove the results after the last checkpoint.

        Raises
        ------
        InvalidInput
            The folder has no checkpoint.
        """
        checkpoint = self.said("checkpoint")
        for coordinate in str(self.attributes.pop(_OWN, "")).split():
            self._arrays.remove(coordinate)
        with naming_damage(f"{self._arrays.path}: checkpoint"):
            self._lengths = {one: min(max(0, int(checkpoint[one])), self._lengths[one]) for one in GROWING}
            self.attributes["state"] = json.dumps({name: checkpoint[name] for name in ("file", "checksum")})
        for dimension, length in self._lengths.items():
            self._arrays.cut(dimension, length)
        self._safe = True

    def append(self, events: Events, rows: Floats, state: State, wall: float) -> None:
        """Append the results since the last call, with the state from which the run is resumed.

        Parameters
        ----------
        events : Events
            Events since the last call.
        rows : array
            Samples since the last call, in the form of :meth:`rows`.
        state : State
            State of the run after these results, from which it is resumed.
        wall : float
            Wall time of the run [s].

        Raises
        ------
        FileError
            The results cannot be written; the earlier results are unchanged.
        """
        self._safe = True
        self.begin(events, rows, state, wall)

    def begin(self, events: Events, rows: Floats, state: State, wall: float) -> None:
        """Write the state from which a run begins or resumes. The arguments are those of :meth:`append`.

        For a new run the files are not synced to the disk: only later commits (:meth:`append`) wait for the disk. So a
        run that is shorter than the commit interval never waits.

        Raises
        ------
        FileError
            The state cannot be written.
        """
        lengths = self._write(events, rows)
        self._put_state(_STATES[self._state_file() == _STATES[0]], state)
        checkpoint = {**self.said("state"), "wall_seconds": wall, **lengths}
        self.attributes.update(status=UNFINISHED, message=MESSAGE, checkpoint=json.dumps(checkpoint))
        self._arrays.commit(safely=self._safe)
        self._lengths = lengths

    def finish(self, events: Events, rows: Floats, solution: Solution) -> None:
        """Append the last events and samples, and write how the run ended.

        Raises
        ------
        FileError
            The results cannot be written; the earlier results are unchanged.
        """
        lengths = self._write(events, rows)
        self._put_state(_LAST, solution.state)
        self.attributes.update(
            status=solution.status,
            message=solution.message,
            counters=json.dumps(vars(solution.counters) | {"limits": dict(solution.counters.limits)}),
            cause=solution.end.cause,
            verdict=json.dumps([{**vars(one), "value": value} for one, value in solution.end.verdict.items()]),
        )
        if solution.status in ("done", "suspect"):
            self.attributes.pop("checkpoint", None)
        self._arrays.commit(safely=self._safe)
        self._lengths = lengths
        self._arrays.spell_out(self._arrays.names)
        if "checkpoint" not in self.attributes:
            for name in _STATES:
                (self._arrays.path / name).unlink(missing_ok=True)

    def add_coordinates(self, coordinates: Mapping[str, Any], unit_of: Callable[[str], str]) -> None:
        """Add the scenario's own coordinates over the samples: name -> array [n_samples], and the unit of each.

        Raises
        ------
        InvalidInput
            A name cannot be the name of a folder or is taken, or the values are not numbers.
        FileError
            The coordinates cannot be written.
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
            self._arrays.add(name, ("time",), values, attributes, grows=True)
        self._arrays.commit(safely=False)
        self._arrays.spell_out(coordinates)

    def close(self) -> None:
        """Release the lock of the folder."""
        if self._lock is not None:
            self._lock.release()

    def _write(self, events: Events, rows: Floats) -> dict[str, int]:
        """Write events and samples after the committed ones; return {growing dimension: new length}."""
        lengths = dict(self._lengths)
        for one in _variables(events, rows, self._n_q, self._n_u):
            dimension = one.dimensions[0]
            self._arrays.write(one.name, self._lengths[dimension], one.values)
            lengths[dimension] = self._lengths[dimension] + len(one.values)
        return lengths

    def _put_state(self, name: str, state: State) -> None:
        """Write a state to a file, and note the file and its checksum in the attributes."""
        content = state_bytes(state)
        self._arrays.file(name, content)
        self.attributes["state"] = json.dumps({"file": name, "checksum": zlib.crc32(content)})
        self.attributes.update(t_end=state.time, **energies(state))

    def _state_file(self) -> str:
        """Name of the file of the last state, "" before the first one."""
        return str(self.said("state")["file"]) if "state" in self.attributes else ""

    def _state(self, attribute: str, entry: Mapping[str, Any], names: tuple[str, ...]) -> State:
        """State in the file that an attribute names."""
        name = entry.get("file")
        if name not in names:
            raise InvalidInput(f"{self._arrays.path}: {attribute}", "must name a state", name, "It is damaged.")
        path = self._arrays.path / str(name)
        try:
            content = content_of(path)
        except OSError as error:
            raise InvalidInput(str(path), "must be there", error.strerror, "It is damaged.") from error
        if zlib.crc32(content) != entry.get("checksum"):
            rule, remedy = (
                f"must have the checksum in {attribute!r}",
                "It is damaged: take it from a copy, or run again.",
            )
            raise InvalidInput(str(path), rule, "a file with another one", remedy)
        return state_from(content, str(path))


def _variables(events: Events, rows: Floats, n_q: int, n_u: int) -> list[LabelledArray]:
    """Events and samples as labelled arrays."""
    n_states = rows.shape[1] - 1 - n_q - n_u - N_ACCOUNTS - BOOKED
    t, q, u, *rest = np.split(rows, np.cumsum([1, n_q, n_u, N_ACCOUNTS, n_states]), axis=1)
    return [*of_samples(t[:, 0], q, u, *rest), *of_all_of_events(events)]
