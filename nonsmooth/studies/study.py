"""Study: many runs over parameters, stored while they are computed."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

from nonsmooth.checks import check_count, check_kind, path_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.notices import warn
from nonsmooth.progress import Display, RunsDone
from nonsmooth.results.output import OtherVersions
from nonsmooth.studies.case import case_factory
from nonsmooth.studies.dask import Dask
from nonsmooth.studies.executors import Executor, Serial, Threads
from nonsmooth.studies.inputs import meter, require
from nonsmooth.studies.provenance import differing, provenance
from nonsmooth.studies.records import Requested, RunResult, records
from nonsmooth.studies.sampling import Sampling
from nonsmooth.studies.status import VALUED
from nonsmooth.studies.study_folder import StudyFolder, is_study, open_study
from nonsmooth.studies.work import Chunk, Work
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray

EXECUTORS: Mapping[str, Callable[[], Executor]] = {"serial": Serial, "threads": Threads, "dask": Dask}
_CHUNKS, _LARGEST = 40, 1000
"""Default number of chunks of a study, and largest number of runs in such a chunk.

A study of more than 40000 runs has more chunks.
"""
_FIRST_SAMPLES = 2
"""Length of a short first run, in sample intervals.  It only provides labels, units and shapes for the records, so two
intervals are enough."""


@final
class Study:
    """Many runs of a system over its parameters, stored while they are computed.

    Parameters
    ----------
    runs : Scenario, System or function
        A scenario, whose parameters are varied by name; a system, whose numbers are varied by the dotted keys of its
        file (:func:`save_system`), "bodies.ball.radius"; or a function of a module, ``f(**parameters) -> System``.
    sampling : Sampling
        Parameters of the runs: :func:`grid`, :func:`random`, :func:`sobol`, :func:`latin_hypercube`, :func:`listed`,
        :func:`columns`.
    record : sequence
        Records of each run, in addition to ``status`` and ``reason``: q_end, u_end, t_end, impacts, events, steps,
        energy_residual, a name of the scenario's summary, a function ``f(scenario, solution) -> number``, or a
        :class:`Trajectory`.
    t_end : float, optional
        End time of a system or function [s]; a scenario has its own.
    engine : Engine, optional
        Engine of all runs, with its options.
    budget : int, optional
        Largest number of steps of a run; a run that needs more ends with the status "budget" and has no records.

    Raises
    ------
    InvalidInput
        If an argument is not valid; nothing has run then.
    """

    def __init__(
        self,
        runs: Scenario | System | Callable[..., System],
        sampling: Sampling,
        record: Sequence[Requested],
        *,
        t_end: float | None = None,
        engine: Engine | None = None,
        budget: int | None = None,
    ) -> None:
        check_kind("Study: sampling", sampling, Sampling, "For example studies.grid(restitution=[0.5, 0.9]).")
        self._cases = case_factory(runs, t_end)
        self._sampling = sampling
        self._cases.check(self._sampling)
        integrates = EventDriven() if engine is None else engine
        check_kind("Study: engine", integrates, Engine, "Give nonsmooth.EventDriven(), or another one.")
        if budget is not None:
            check_count("Study: budget", budget, "must be a positive whole number of steps", "Leave it out.")
        self._work = Work(self._cases, integrates, budget)
        self._work = dataclasses.replace(self._work, records=records(record, self._first()))
        for name in self.records:
            if name in self._sampling.columns:
                rule = "must not be a varied parameter, which is kept anyway"
                raise InvalidInput(f"record {name}", rule, list(self._sampling.columns), "Leave it out.")

    def __len__(self) -> int:
        return len(self._sampling)

    def __repr__(self) -> str:
        """Return the number of runs, and the name of the scenario."""
        return f"Study({len(self)} runs of {self._cases.name})"

    @property
    def records(self) -> tuple[str, ...]:
        """Names of the records of each run, in addition to ``status`` and ``reason``."""
        return tuple(one.name for one in self._work.records)

    def _first(self) -> RunResult:
        """Return a short run of the first case that succeeds, which gives labels, units and shapes of the records.

        At most ten cases are tried.  Their failures are not stored, because the cases fail again in the study.
        """
        last: Exception = InvalidInput("study", "must have a run", None, "Add one.")
        for run in range(min(len(self), 10)):
            try:
                case = self._cases.case(self._sampling.at(run))
                t_end = min(case.t_end, _FIRST_SAMPLES * (case.sample_interval or case.t_end))
                return self._work.result(case, t_end)
            except Exception as error:  # a function of the user may raise anything
                last = error
        raise last

    @property
    def spec(self) -> str:
        """Definition of the study as JSON.  Studies with equal definitions give results that are equal bit by bit."""
        known = {
            "runs": dict(self._cases.described()),
            "sampling": dict(self._sampling.description),
            "points": self._sampling.digest,
            "engine": {"type": type(self._work.engine).__name__, **vars(self._work.engine)},
            "budget": self._work.budget,
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
        """Compute all runs that are not stored yet, and return all records.

        Parameters
        ----------
        path : Path or str
            Folder of the study: a new or empty folder, or the folder of this study, which then continues.
        executor : str or Executor
            Computes the runs: serial, threads or dask; all give the same bits.
        chunk : int, optional
            Number of runs that are stored together; fixed when a study begins.
        display : Display, optional
            Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.
        request : mapping, optional
            Request of the command line, which is stored with the study.

        Returns
        -------
        xarray.Dataset
            The result of :func:`open_study`.

        Raises
        ------
        InvalidInput
            If the folder contains something else, or another process writes there, or no scheduler answers.
        MissingPackagesError
            If the extra `studies` is not installed.
        FileError
            If the folder cannot be written to; complete chunks are kept.
        """
        require("a study", "xarray")
        check_chunk(chunk)
        does = executor_of(executor)
        place = path_of("study", path)
        if not is_study(place):
            self._create(place, chunk, request or {})
        store = StudyFolder(place)
        self._check_same(store, chunk)
        with store.writing():
            self._run(store, does, display)
        return open_study(place)

    def _run(self, store: StudyFolder, executor: Executor, display: Display | None) -> None:
        done = set(store.committed())
        left = [self._chunk(store, number) for number in range(store.n_chunks) if number not in done]
        if not left:
            return
        n_done = len(self) - sum(len(one.parameters) for one in left)
        with meter(display) as shown, contextlib.closing(executor.results(self._work, left)) as results:
            counted = RunsDone(shown, len(self), n_done)
            for block in results:
                store.write(block)
                ends = block.arrays["status"].tolist()
                counted.add(len(ends), sum(end not in VALUED for end in ends))

    def _chunk(self, store: StudyFolder, number: int) -> Chunk:
        runs = range(number * store.chunk, min(len(self), (number + 1) * store.chunk))
        return Chunk(runs.start, tuple(map(self._sampling.at, runs)))

    def _create(self, path: Path, chunk: int | None, request: Mapping[str, Any]) -> None:
        size = max(1, min(_LARGEST, -(-len(self) // _CHUNKS))) if chunk is None else chunk
        spec = self.spec
        attributes = {
            "Conventions": "CF-1.11",
            "title": f"{len(self)} runs of {self._cases.name}",
            "spec": spec,
            "sha256": hashlib.sha256(spec.encode()).hexdigest(),
            "provenance": json.dumps([dict(provenance())]),
            "request": json.dumps(dict(request)),
        }
        StudyFolder.create(path, self._work.records, self._sampling, self._cases, size, attributes)

    def _check_same(self, store: StudyFolder, chunk: int | None) -> None:
        """Raise InvalidInput if the folder belongs to another study; add versions and processor to its provenance.

        Warns
        -----
        OtherVersions
            If the study continues with other versions or on another processor.
        """
        known = store.attributes
        if known["sha256"] != hashlib.sha256(self.spec.encode()).hexdigest():
            where = differing(json.loads(str(known["spec"])), json.loads(self.spec))
            remedy = "Choose another folder, or give the arguments with which it began."
            raise InvalidInput(str(store.path), "must hold the study that continues there", where, remedy)
        if chunk is not None and chunk != store.chunk:
            thing = f"{store.path}: chunk"
            raise InvalidInput(thing, f"must be that of the beginning, {store.chunk}", chunk, "Leave it out.")
        before, here = json.loads(str(known["provenance"])), dict(provenance())
        if here not in before:
            store.note({"provenance": json.dumps([*before, here])})
            differ = {name: here[name] for name in here if here[name] != before[0].get(name)}
            text = f"{store.path} began elsewhere or with other versions; here are {differ}: last digits may differ."
            warn(text, OtherVersions)


def check_chunk(chunk: int | None) -> None:
    """Raise InvalidInput unless a size of chunks is a positive whole number."""
    if chunk is not None:
        check_count("chunk", chunk, "must be a positive whole number of runs", "Leave it out.")


def executor_of(executor: str | Executor) -> Executor:
    """Return the executor of a name; an executor is returned unchanged.

    Raises
    ------
    UnknownName
        If no executor has this name.
    """
    if isinstance(executor, Executor):
        return executor
    if executor not in EXECUTORS:
        raise UnknownName("executor", str(executor), EXECUTORS)
    return EXECUTORS[executor]()
