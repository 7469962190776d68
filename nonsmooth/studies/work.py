"""One run of a study, and a chunk of them: what every executor does, in whichever thread or process."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import RunFailed
from nonsmooth.runs.simulate import assemble
from nonsmooth.studies.budget import Budgeted
from nonsmooth.studies.records.record import Outcome, Record
from nonsmooth.studies.sampling.points import Value
from nonsmooth.studies.status import BUDGET, CRASHED, DONE, FAILED, RAISED, SUSPECT, WORKER_DIED, reason_of
from nonsmooth.studies.target import Case, Target


@final
@dataclass(frozen=True)
class Chunk:
    """Runs that are done, and stored, as one.

    Attributes
    ----------
    number : int
        Number of the chunk.
    first : int
        Number of its first run.
    parameters : tuple of dict
        Of each of its runs.
    """

    number: int
    first: int
    parameters: tuple[dict[str, Value], ...]

    def halves(self) -> tuple[Chunk, Chunk]:
        """Return its two halves, under the same number."""
        middle = len(self.parameters) // 2
        one, other = self.parameters[:middle], self.parameters[middle:]
        return Chunk(self.number, self.first, one), Chunk(self.number, self.first + middle, other)


@final
@dataclass(frozen=True, eq=False)
class Block:
    """What came of a chunk.

    Attributes
    ----------
    chunk : Chunk
        The chunk.
    arrays : mapping
        Of each record, of the status and of the reason, the values of all runs of the chunk.
    texts : mapping
        Of each run that has no records the sentence that says why.
    """

    chunk: Chunk
    arrays: Mapping[str, NDArray[Any]]
    texts: Mapping[int, str]

    def joined(self, other: Block) -> Block:
        """Return this one and the one behind it as one."""
        chunk = Chunk(self.chunk.number, self.chunk.first, self.chunk.parameters + other.chunk.parameters)
        arrays = {name: np.concatenate([values, other.arrays[name]]) for name, values in self.arrays.items()}
        return Block(chunk, arrays, {**self.texts, **other.texts})


class Row(NamedTuple):
    """What came of a run: status, reason, the sentence of one without records, values by record."""

    status: int
    reason: int
    text: str = ""
    values: Mapping[str, Any] = {}


def _nothing() -> None:
    """Go on."""


@final
@dataclass(frozen=True)
class Work:
    """What is done with each run.

    Attributes
    ----------
    target : Target
        What is run.
    engine : Budgeted
        What integrates it, and for how many steps.
    records : tuple of Record
        What is kept.
    """

    target: Target
    engine: Budgeted
    records: tuple[Record, ...] = field(default=())

    def block(self, chunk: Chunk, before_each: Callable[[], None] = _nothing) -> Block:
        """Return what came of a chunk; what ``before_each`` raises ends it."""
        rows = []
        for parameters in chunk.parameters:
            before_each()
            rows.append(self.row(parameters))
        return self._block(chunk, rows)

    def crashed(self, chunk: Chunk, text: str) -> Block:
        """Return the block of runs that cost their process its life."""
        return self._block(chunk, [Row(CRASHED, WORKER_DIED, text) for _ in chunk.parameters])

    def row(self, parameters: Mapping[str, Value]) -> Row:
        """Return what came of a run, whatever it raises.

        Raises
        ------
        KeyboardInterrupt
            After Ctrl-C.
        """
        try:
            case = self.target.case(parameters)
            outcome = self.outcome(case, case.t_end)
        except RunFailed as error:
            return Row(FAILED, reason_of(str(error)), str(error))
        except Exception as error:
            return Row(FAILED, RAISED, f"{type(error).__name__}: {error}")
        solution, values = outcome.solution, dict[str, Any]()
        if solution.status == "interrupted":
            raise KeyboardInterrupt
        reason = reason_of(solution.message)
        if self.engine.spent(solution):
            text = f"At t = {solution.t_end:.9g} s its {self.engine.steps} steps were used up."
            return Row(BUDGET, reason, text)
        for record in self.records:
            try:
                values[record.name] = record.of(outcome)
            except Exception as error:
                return Row(FAILED, RAISED, f"record {record.name}: {type(error).__name__}: {error}")
        return Row(SUSPECT if solution.status == "suspect" else DONE, reason, "", values)

    def outcome(self, case: Case, t_end: float) -> Outcome:
        """Simulate a case up to a time [s]; raises what the run raises."""
        model = assemble(case.system, self.engine)
        solution = model.run(t_end, sample_interval=case.sample_interval)
        return Outcome(case.scenario, model, solution, case.t_end)

    def _block(self, chunk: Chunk, rows: list[Row]) -> Block:
        n = len(rows)
        arrays = {one.name: np.full((n, *one.shape), one.none, one.dtype) for one in self.records}
        for place, row in enumerate(rows):
            for name, value in row.values.items():
                arrays[name][place] = value
        for name in ("status", "reason"):
            arrays[name] = np.array([getattr(row, name) for row in rows], "int8")
        return Block(chunk, arrays, {chunk.first + at: row.text for at, row in enumerate(rows) if row.text})
