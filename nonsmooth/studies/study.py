"""Study: many runs of a scenario, or of a function that builds a system, over parameters; stored as they come."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

from nonsmooth.checks import check_kind, path_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.progress import Display, Pace, RunsDone
from nonsmooth.results.output import OtherVersions
from nonsmooth.studies.budget import Budgeted
from nonsmooth.studies.definition import differing
from nonsmooth.studies.displays import display_of
from nonsmooth.studies.executors import Dask, Executor, Serial, Threads
from nonsmooth.studies.extras import require_store
from nonsmooth.studies.layout import coordinates, variables
from nonsmooth.studies.opening import open_study
from nonsmooth.studies.provenance import provenance
from nonsmooth.studies.records.asked import Asked, records
from nonsmooth.studies.records.record import Outcome
from nonsmooth.studies.sampling.sampling import Sampling
from nonsmooth.studies.status import VALUED
from nonsmooth.studies.study_folder import StudyFolder, is_study
from nonsmooth.studies.target import Case, target
from nonsmooth.studies.work import Chunk, Work
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray

EXECUTORS: Mapping[str, Callable[[], Executor]] = {"serial": Serial, "threads": Threads, "dask": Dask}
_CHUNKS, _LARGEST = 40, 1000
"""By default so many chunks, with so many runs at most."""
_UNLIMITED = 1 << 62
_LOOK = 2
"""Samples of the first look at a run, which tells what there is to record."""


@final
class Study:
    """Many runs over parameters.

    Parameters
    ----------
    runs : Scenario, System or function
        A scenario, whose parameters are varied by name; a system, whose numbers are varied by the dotted keys of its
        file (:func:`save_system`), "bodies.ball.radius"; or a function of a module, ``f(**parameters) -> System``.
    sampling : Sampling
        Which parameters: :func:`grid`, :func:`random`, :func:`sobol`, :func:`latin_hypercube`, :func:`listed`,
        :func:`columns`.
    record : sequence
        What is kept of each run, besides ``status`` and ``reason``: names of numbers that every run has (``q_end``,
        ``u_end``, ``t_end``, ``impacts``, ``events``, ``steps``, ``energy_residual``), names of numbers of the
        scenario's summary, functions ``f(scenario, solution) -> number``, or a :class:`Trajectory`.
    t_end : float, optional
        End time of a system, or of those that a function builds [s]; a scenario has its own.
    engine : Engine, optional
        What integrates, with its options.
    budget : int, optional
        Steps of the flow after which a run is given up; none by default.

    Raises
    ------
    InvalidInput
        If something of it is not valid: nothing has run then.
    """

    def __init__(
        self,
        runs: Scenario | System | Callable[..., System],
        sampling: Sampling,
        record: Sequence[Asked],
        *,
        t_end: float | None = None,
        engine: Engine | None = None,
        budget: int | None = None,
    ) -> None:
        check_kind("Study: sampling", sampling, Sampling, "For example studies.grid(restitution=[0.5, 0.9]).")
        self._target = target(runs, t_end)
        self._sampling, self._points = sampling, sampling.points()
        self._target.check(self._points)
        integrates = EventDriven() if engine is None else engine
        check_kind("Study: engine", integrates, Engine, "Give nonsmooth.EventDriven(), or another one.")
        if budget is not None and (not isinstance(budget, int) or budget < 1):
            raise InvalidInput("Study: budget", "must be a positive whole number of steps", budget, "Leave it out.")
        self._work = Work(self._target, Budgeted(integrates, budget or _UNLIMITED))
        self._work = dataclasses.replace(self._work, records=records(record, self._look()))
        for name in self.records:
            if name in self._points.columns:
                rule = "must be none of what is varied, which is kept anyway"
                raise InvalidInput(f"record {name}", rule, list(self._points.columns), "Leave it out.")
        self._budget = budget

    def __len__(self) -> int:
        return len(self._points)

    def __repr__(self) -> str:
        """Return how many runs of what it is."""
        return f"Study({len(self)} runs of {self._target.name})"

    @property
    def records(self) -> tuple[str, ...]:
        """Names of what is kept of each run, besides ``status`` and ``reason``."""
        return tuple(one.name for one in self._work.records)

    def _look(self) -> Outcome:
        """Begin the first run that can be built: what cannot be is a row later."""
        last: Exception = InvalidInput("study", "must have a run", None, "Add one.")
        for run in range(min(len(self), 10)):
            try:
                case = self._target.case(self._points.at(run))
                return self._work.outcome(case, _end_of_look(case))
            except Exception as error:  # of the user, too
                last = error
        raise last

    @property
    def spec(self) -> str:
        """What is computed, as JSON: two studies with the same one have the same bits."""
        known = {
            "runs": dict(self._target.described()),
            "sampling": dict(self._sampling.described()),
            "points": self._points.digest,
            "engine": {"type": type(self._work.engine.engine).__name__, **vars(self._work.engine.engine)},
            "budget": self._budget,
            "records": [
                {"name": one.name, "dtype": one.dtype, "axes": dict(one.axes), "how": one.how}
                for one in self._work.records
            ],
        }
        return json.dumps(known, sort_keys=True, default=repr)

    def run(
        self,
        path: Path | str,
        *,
        executor: str | Executor = "threads",
        chunk: int | None = None,
        display: Display | None = None,
        request: Mapping[str, Any] | None = None,
    ) -> xarray.Dataset:
        """Run what is not stored yet, and return all.

        Parameters
        ----------
        path : Path or str
            The folder of the study, new, or one that this study has begun: it goes on.
        executor : str or Executor
            "serial", "threads", "dask", or one of these with options; all give the same bits.
        chunk : int, optional
            Runs that are stored as one, and done anew as one where they were cut off: fixed when a study begins.
        display : Display, optional
            Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.
        request : mapping, optional
            The words of the command line.

        Returns
        -------
        xarray.Dataset
            As :func:`open_study`.

        Raises
        ------
        InvalidInput
            If the folder holds something else, or another process writes there, or no scheduler answers.
        MissingPackagesError
            If the extra `studies` is not installed.
        FileError
            If it cannot be written: what was stored before is.
        """
        require_store()
        check_chunk(chunk)
        does = executor_of(executor)
        place = path_of("study", path)
        if not is_study(place):
            self._create(place, chunk, request or {})
        store = StudyFolder(place)
        self._check_same(store, chunk)
        with store.writing():
            self._run(store, does, display_of(display))
        return open_study(place)

    def _run(self, store: StudyFolder, executor: Executor, display: Display) -> None:
        done = set(store.committed())
        left = [self._chunk(store, number) for number in range(store.n_chunks) if number not in done]
        if not left:
            return
        n_done = len(self) - sum(len(one.parameters) for one in left)
        with Pace(display) as pace, contextlib.closing(executor.blocks(self._work, left)) as blocks:
            counted = RunsDone(pace, len(self), n_done)
            for block in blocks:
                store.write(block)
                ends = block.arrays["status"].tolist()
                counted.add(len(ends), sum(end not in VALUED for end in ends))

    def _chunk(self, store: StudyFolder, number: int) -> Chunk:
        runs = range(number * store.chunk, min(len(self), (number + 1) * store.chunk))
        return Chunk(number, runs.start, tuple(map(self._points.at, runs)))

    def _create(self, path: Path, chunk: int | None, request: Mapping[str, Any]) -> None:
        size = max(1, min(_LARGEST, -(-len(self) // _CHUNKS))) if chunk is None else chunk
        spec, records_of = self.spec, self._work.records
        made = variables(records_of, len(self), size)
        layout = {
            "parameters": list(self._points.columns),
            "dims": dict(self._points.dims),
            "variables": list(made),
        }
        attributes = {
            "Conventions": "CF-1.11",
            "title": f"{len(self)} runs of {self._target.name}",
            "spec": spec,
            "sha256": hashlib.sha256(spec.encode()).hexdigest(),
            "layout": json.dumps(layout),
            "provenance": json.dumps([dict(provenance())]),
            "request": json.dumps(dict(request)),
        }
        StudyFolder.create(path, made, coordinates(records_of, self._points, self._target), attributes)

    def _check_same(self, store: StudyFolder, chunk: int | None) -> None:
        """Refuse the store of another study; note that it goes on elsewhere.

        Warns
        -----
        OtherVersions
            If it goes on with other versions, so that its runs are not all of the same.
        """
        known = store.attributes
        if known["sha256"] != hashlib.sha256(self.spec.encode()).hexdigest():
            where = differing(json.loads(str(known["spec"])), json.loads(self.spec))
            remedy = "Choose another folder, or ask for what began there."
            raise InvalidInput(str(store.path), "must hold the study that goes on there", where, remedy)
        if chunk is not None and chunk != store.chunk:
            thing = f"{store.path}: chunk"
            raise InvalidInput(thing, f"must be that of the beginning, {store.chunk}", chunk, "Leave it out.")
        before, here = json.loads(str(known["provenance"])), dict(provenance())
        if here not in before:
            store.note({"provenance": json.dumps([*before, here])})
            differ = {name: here[name] for name in here if here[name] != before[0].get(name)}
            text = f"{store.path} began elsewhere or with other versions; here are {differ}: last digits may differ."
            warnings.warn(text, OtherVersions, stacklevel=3)


def check_chunk(chunk: int | None) -> None:
    """Look at how many runs are stored as one.

    Raises
    ------
    InvalidInput
        If it is no positive whole number.
    """
    if chunk is not None and (not isinstance(chunk, int) or chunk < 1):
        raise InvalidInput("chunk", "must be a positive whole number of runs", chunk, "Leave it out.")


def executor_of(executor: str | Executor) -> Executor:
    """Return an executor by its name, or as it is.

    Raises
    ------
    UnknownName
        If there is none of that name.
    """
    if isinstance(executor, Executor):
        return executor
    if executor not in EXECUTORS:
        raise UnknownName("executor", str(executor), EXECUTORS)
    return EXECUTORS[executor]()


def _end_of_look(case: Case) -> float:
    """Return when the first look ends [s]."""
    return min(case.t_end, _LOOK * (case.sample_interval or case.t_end))
