"""Records by name: numbers that every run has, numbers of the scenario's summary, functions of the user."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, TypeAlias, final

import numpy as np

from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.solution.solution import Solution
from nonsmooth.studies.provenance import digest
from nonsmooth.studies.records.record import Recorder, RunResult, StudyRecord
from nonsmooth.studies.status import ALWAYS

Function: TypeAlias = Callable[[Any, Solution], float]
"""``f(scenario, solution) -> number``; the scenario is None if a function built the system."""
Requested: TypeAlias = str | Recorder | Function
"""A name, a recorder, or a function of the user."""
_LINE = re.compile(r"(?P<words>.*?)(\s*\[(?P<unit>[^]]+)\])?\.?")
"""First line of a docstring: description, and unit in brackets at its end."""


def _n_events(result: RunResult) -> int:
    return len(result.solution.events)


_NUMBERS: Mapping[str, tuple[Callable[[RunResult], float], str, str, str]] = {
    "impacts": (attrgetter("solution.counters.impacts"), "int64", "1", "impacts"),
    "events": (_n_events, "int64", "1", "events, the start among them"),
    "steps": (attrgetter("solution.counters.steps"), "int64", "1", "accepted steps of the flow"),
    "t_end": (attrgetter("solution.t_end"), "float64", "s", "time reached"),
    "energy_residual": (
        attrgetter("solution.energy.residual"),
        "float64",
        "1",
        "relative error of the energy account",
    ),
}
"""Numbers that every run has: how they are found, type, unit, description."""
_STATES = {"q_end": ("coordinate", "coordinates at the end"), "u_end": ("velocity", "velocities at the end")}
_NUMBER = (int, float, np.number, np.bool_)


@final
@dataclass(frozen=True)
class FunctionRecorder(Recorder):
    """Records the number that a function of the user returns."""

    function: Function

    def record(self, first: RunResult) -> StudyRecord:
        """Return the record: name of the function, description and unit of its docstring, such as "Height [m]."."""
        name = self.function.__name__
        line = _LINE.fullmatch((self.function.__doc__ or name).strip().partition("\n")[0])
        assert line is not None
        return StudyRecord(name, self, described(line["words"], line["unit"] or ""), how=digest(self.function))

    def __call__(self, result: RunResult) -> float:
        """Call the function."""
        return self.function(result.scenario, result.solution)


@final
@dataclass(frozen=True)
class NamedRecorder(Recorder):
    """Records a number, state or class by its name."""

    name: str

    def record(self, first: RunResult) -> StudyRecord:
        """Return the record of a name that every run has, or that the summary of the first one has."""
        name = self.name
        if name in _NUMBERS:
            find, dtype, unit, text = _NUMBERS[name]
            return StudyRecord(name, find, described(text, unit), dtype=dtype)
        if name in _STATES:
            axis, text = _STATES[name]
            return StudyRecord(name, attrgetter(f"solution.{name}"), described(text), {axis: first.labels(axis)})
        if name not in first.summary:
            raise UnknownName("record", name, [*_NUMBERS, *_STATES, *ALWAYS, *first.summary])
        return self._of_summary(first)

    def _of_summary(self, first: RunResult) -> StudyRecord:
        value, scenario = first.summary[self.name], first.scenario
        words = () if scenario is None else tuple(scenario.words.get(self.name, ()))
        units = {} if scenario is None else scenario.units
        parts = value if isinstance(value, (list, tuple, np.ndarray)) else (value,)
        if not (words or all(part is None or isinstance(part, _NUMBER) for part in parts)):
            remedy = "Give a function f(scenario, solution) -> number, or list the words in `words` of the scenario."
            rule = "must be a number, a row of numbers, or a word of a list"
            raise InvalidInput(f"record {self.name}", rule, value, remedy)
        text = described(f"{self.name} of the scenario", units.get(self.name, ""))
        axes = {} if parts is not value else {f"{self.name}_part": range(len(parts))}
        return StudyRecord(self.name, _OfSummary(self.name), text, axes, words, "int8" if words else "float64")


@final
@dataclass(frozen=True)
class _OfSummary:
    """Finds a number of the summary."""

    name: str

    def __call__(self, result: RunResult) -> Any:
        return result.summary[self.name]


def _recorder(requested: Requested) -> Recorder:
    if isinstance(requested, str):
        return NamedRecorder(requested)
    if isinstance(requested, Recorder):
        return requested
    if (
        not inspect.isfunction(requested)
        or len(inspect.signature(requested).parameters) != 2
        or not requested.__name__.isidentifier()
    ):
        rule = "must be a name, or a function with a name and two arguments"
        remedy = "Give a name, def f(scenario, solution) that returns a number, or Trajectory(...)."
        raise InvalidInput("record", rule, requested, remedy)
    return FunctionRecorder(requested)


def records(requested: Sequence[Requested], first: RunResult) -> tuple[StudyRecord, ...]:
    """Return the records of a study, given its first run up to a short time.

    Raises
    ------
    InvalidInput
        If they are not a list, or a name is unknown, comes twice, or belongs to something that is no number.
    """
    if isinstance(requested, str):
        raise InvalidInput("record", "must be a list", requested, f'For example record=["{requested}"].')
    found = tuple(_recorder(one).record(first) for one in requested if one not in ALWAYS)
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1 or name in ALWAYS:
            raise InvalidInput(f"record {name}", "must come once", names, "Rename it, or leave one out.")
    return found
