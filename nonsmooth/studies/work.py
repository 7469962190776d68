"""The runs of a study and of its chunks, as all executors compute them, in any thread or process."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import REASONS, Status
from nonsmooth.errors import RunFailed
from nonsmooth.interfaces import Engine
from nonsmooth.runs.simulate import assemble
from nonsmooth.studies.case import Case, CaseFactory
from nonsmooth.studies.records import RunResult, StudyRecord
from nonsmooth.studies.sampling import Value
from nonsmooth.studies.status import RAISED, WORKER_DIED, CaseStatus, reason_of


@final
@dataclass(frozen=True)
class Chunk:
    """Runs that are computed and stored together.

    Attributes
    ----------
    first : int
        Number of its first run.
    parameters : tuple of dict
        Parameters of each run.
    """

    first: int
    parameters: tuple[dict[str, Value], ...]

    def runs(self) -> list[Chunk]:
        """Return the runs, each as a chunk of one run."""
        return [Chunk(self.first + i, (one,)) for i, one in enumerate(self.parameters)]


@final
@dataclass(frozen=True, eq=False)
class ChunkResult:
    """Records of the runs of a chunk.

    Attributes
    ----------
    chunk : Chunk
        The chunk.
    arrays : mapping
        Values of all runs, for each record, the status and the reason.
    texts : mapping
        Reason in words of each run without records, by the number of the run.
    """

    chunk: Chunk
    arrays: Mapping[str, NDArray[Any]]
    texts: Mapping[int, str]

    @classmethod
    def joined(cls, parts: Sequence[ChunkResult]) -> ChunkResult:
        """Return the results of successive parts of a chunk as one."""
        chunk = Chunk(parts[0].chunk.first, tuple(one for part in parts for one in part.chunk.parameters))
        arrays = {name: np.concatenate([part.arrays[name] for part in parts]) for name in parts[0].arrays}
        return cls(chunk, arrays, {run: text for part in parts for run, text in part.texts.items()})


class RunRow(NamedTuple):
    """Result of a run: status, code of the reason, message if the run has no records, and values by name of record."""

    status: CaseStatus
    reason: int
    text: str = ""
    values: Mapping[str, Any] = {}


@final
@dataclass(frozen=True)
class Work:
    """Builds, integrates and records the runs of a study.

    Attributes
    ----------
    cases : CaseFactory
        Builds the runs.
    engine : Engine
        Integrates them.
    budget : int or None
        Largest number of steps of a run.
    records : tuple of StudyRecord
        The records of each run.
    """

    cases: CaseFactory
    engine: Engine
    budget: int | None
    records: tuple[StudyRecord, ...] = field(default=())

    def chunk(self, chunk: Chunk, before_each: Callable[[], object] = lambda: None) -> ChunkResult:
        """Return the result of a chunk; an exception that ``before_each`` raises ends the work."""
        rows = []
        for parameters in chunk.parameters:
            before_each()
            rows.append(self.row(parameters))
        return self._result(chunk, rows)

    def crashed(self, chunk: Chunk, text: str) -> ChunkResult:
        """Return the result of runs whose process died."""
        return self._result(chunk, [RunRow(CaseStatus.CRASHED, WORKER_DIED, text) for _ in chunk.parameters])

    def row(self, parameters: Mapping[str, Value]) -> RunRow:
        """Return the row of a run; an exception gives a row with status "failed".

        Raises
        ------
        KeyboardInterrupt
            After Ctrl-C.
        """
        try:
            case = self.cases.case(parameters)
            result = self.result(case, case.t_end)
        except RunFailed as error:
            return RunRow(CaseStatus.FAILED, reason_of(str(error)), str(error))
        except Exception as error:
            return RunRow(CaseStatus.FAILED, RAISED, f"{type(error).__name__}: {error}")
        solution, values = result.solution, dict[str, Any]()
        if solution.status == "interrupted":
            raise KeyboardInterrupt
        reason = reason_of(solution.message)
        # a run of a study has one end condition, its largest number of steps: "condition met" means that it is reached
        if solution.message == REASONS[Status.CONDITION_MET]:
            text = f"At t = {solution.t_end:.9g} s its {self.budget} steps were used up."
            return RunRow(CaseStatus.BUDGET, reason, text)
        for record in self.records:
            try:
                values[record.name] = record.of(result)
            except Exception as error:
                return RunRow(CaseStatus.FAILED, RAISED, f"record {record.name}: {type(error).__name__}: {error}")
        status = CaseStatus.SUSPECT if solution.status == "suspect" else CaseStatus.DONE
        return RunRow(status, reason, "", values)

    def result(self, case: Case, t_end: float) -> RunResult:
        """Simulate a case up to a time [s]."""
        model = assemble(case.system, self.engine)
        solution = model.run(t_end, sample_interval=case.sample_interval, most_steps=self.budget)
        return RunResult(case.scenario, model, solution, case.t_end)

    def _result(self, chunk: Chunk, rows: list[RunRow]) -> ChunkResult:
        n = len(rows)
        arrays = {one.name: np.full((n, *one.shape), one.none, one.dtype) for one in self.records}
        for place, row in enumerate(rows):
            for name, value in row.values.items():
                arrays[name][place] = value
        arrays["status"] = np.array([row.status.code for row in rows], "int8")
        arrays["reason"] = np.array([row.reason for row in rows], "int8")
        return ChunkResult(chunk, arrays, {chunk.first + at: row.text for at, row in enumerate(rows) if row.text})
