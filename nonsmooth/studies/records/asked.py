"""From what is asked for to what is kept of each run."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, final

from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput
from nonsmooth.solution.solution import Solution
from nonsmooth.studies.definition import digest
from nonsmooth.studies.records.named import ALWAYS, Named
from nonsmooth.studies.records.record import Outcome, Record, Recorder

Function: TypeAlias = Callable[[Any, Solution], float]
"""``f(scenario, solution) -> number``; the scenario is None where a function built the system."""
_LINE = re.compile(r"(?P<words>.*?)(\s*\[(?P<unit>[^]]+)\])?\.?")
"""The first line of a docstring: what it is, and its unit where that comes last."""
Asked: TypeAlias = str | Recorder | Function


@final
@dataclass(frozen=True)
class Computed(Recorder):
    """What a function of the user returns."""

    function: Function

    def record(self, look: Outcome) -> Record:
        """Return it under the function's name, described by the first line of its docstring, as "Mean height [m]."."""
        name = self.function.__name__
        line = _LINE.fullmatch((self.function.__doc__ or name).strip().partition("\n")[0])
        assert line is not None
        return Record(name, self, described(line["words"], line["unit"] or ""), how=digest(self.function))

    def __call__(self, outcome: Outcome) -> float:
        """Call the function."""
        return self.function(outcome.scenario, outcome.solution)


def recorder(asked: Asked) -> Recorder:
    """Return what makes the record.

    Raises
    ------
    InvalidInput
        If it is neither a name nor a function of two arguments.
    """
    if isinstance(asked, str):
        return Named(asked)
    if isinstance(asked, Recorder):
        return asked
    if (
        not inspect.isfunction(asked)
        or len(inspect.signature(asked).parameters) != 2
        or not asked.__name__.isidentifier()
    ):
        rule = "must be a name, or a function with a name and two arguments"
        remedy = "Give a name, def f(scenario, solution) that returns a number, or Trajectory(...)."
        raise InvalidInput("record", rule, asked, remedy)
    return Computed(asked)


def records(asked: Sequence[Asked], look: Outcome) -> tuple[Record, ...]:
    """Return the records, out of a first look at a run.

    Raises
    ------
    InvalidInput
        If it is no list, or a name is unknown, comes twice, or is that of something that is no number.
    """
    if isinstance(asked, str):
        raise InvalidInput("record", "must be a list", asked, f'For example record=["{asked}"].')
    found = tuple(recorder(one).record(look) for one in asked if one not in ALWAYS)
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1 or name in ALWAYS:
            raise InvalidInput(f"record {name}", "must come once", names, "Rename it, or leave one out.")
    return found
