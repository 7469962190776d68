"""Records: numbers, words and arrays that a study stores of each run, chosen by name or by a user's function."""

from __future__ import annotations

import inspect
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter
from typing import Any, TypeAlias, final

import numpy as np

from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Scenario
from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
from nonsmooth.studies.provenance import digest
from nonsmooth.studies.status import ALWAYS
from nonsmooth.system.names import labels


@final
@dataclass(frozen=True, eq=False)
class RunResult:
    """A completed run, or the first steps of one.

    Attributes
    ----------
    scenario : Scenario or None
        The scenario with the parameters of the run; None if a function built the system.
    model : Model
        The model of the run.
    solution : Solution
        Its solution.
    t_end : float
        Requested end time [s].
    """

    scenario: Scenario | None
    model: Model
    solution: Solution
    t_end: float

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """Summary of the run by its scenario, computed once for all records; empty without a scenario."""
        return {} if self.scenario is None else dict(self.scenario.summarise(self.solution))

    def labels(self, axis: str) -> list[str]:
        """Return the labels along "coordinate" or "velocity", with units."""
        known = labels(self.solution.system)
        rows = {"coordinate": known.coordinates, "velocity": known.velocities}[axis]
        return [f"{label} [{unit}]" for _, label, unit in rows]


@final
@dataclass(frozen=True)
class StudyRecord:
    """A number, word or array that a study stores of each run.

    Attributes
    ----------
    name : str
        Name of the variable in the dataset of the study.
    find : callable
        Returns its value for a RunResult: a number, None for a missing one, a word of ``words``, or an array.
    attributes : mapping
        Unit and description.
    axes : mapping
        Name of each axis after the runs, and the labels along it.
    words : tuple of str
        All words that the value can be; empty for numbers.
    dtype : str
        Type of the stored values: "int8" for words, "int64" for counts, "float64" otherwise.
    how : str
        Definition of the values, such as the digest of a function, for the specification of the study.
    """

    name: str
    find: Callable[[RunResult], Any]
    attributes: Mapping[str, Any]
    axes: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    words: tuple[str, ...] = ()
    dtype: str = "float64"
    how: str = ""

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the value of one run."""
        return tuple(map(len, self.axes.values()))

    @property
    def none(self) -> float:
        """Number stored for a run without a result: nan, or -1 if the record holds counts or indices of words."""
        return np.nan if self.dtype == "float64" else -1

    def of(self, result: RunResult) -> Any:
        """Return the value of a run: numbers of shape :attr:`shape`, or the index of a word in ``words``.

        Raises
        ------
        ValueError, TypeError
            If the value has another shape or type.
        """
        found = self.find(result)
        if found is None:
            return self.none
        if self.words:
            return self.words.index(found)
        value = np.asarray(found, self.dtype)
        if value.shape != self.shape:
            raise ValueError(f"the record {self.name} has the shape {value.shape}, not {self.shape}")
        return value


class Recorder(ABC):
    """Definition of a record that needs labels or units of the system, which the first run of a study provides."""

    @abstractmethod
    def record(self, first: RunResult) -> StudyRecord:
        """Return the record, with labels and units from the first run.

        Parameters
        ----------
        first : RunResult
            The first run, up to a short time.

        Raises
        ------
        InvalidInput
            If the runs of the study cannot have this record.
        """


Function: TypeAlias = Callable[[Any, Solution], float]
"""``f(scenario, solution) -> number``; the scenario is None if a function built the system."""
Requested: TypeAlias = str | Recorder | Function
"""Request for one quantity of each run: its name, a recorder, or a function of the user."""
_LINE = re.compile(r"(?P<words>.*?)(\s*\[(?P<unit>[^]]+)\])?\.?")
"""First line of a docstring: description, and unit in brackets at its end."""


_NUMBERS: Mapping[str, tuple[Callable[[RunResult], float], str, str, str]] = {
    "impacts": (attrgetter("solution.counters.impacts"), "int64", "1", "impacts"),
    "events": (lambda result: len(result.solution.events), "int64", "1", "events, the start among them"),
    "steps": (attrgetter("solution.counters.steps"), "int64", "1", "accepted steps of the flow"),
    "t_end": (attrgetter("solution.t_end"), "float64", "s", "time reached"),
    "energy_residual": (attrgetter("solution.energy.residual"), "float64", "1", "relative error of the energy account"),
}
"""Numbers that every run has, by name: function of the result, type, unit, description."""
_STATES = {"q_end": ("coordinate", "coordinates at the end"), "u_end": ("velocity", "velocities at the end")}
_NUMBER = (int, float, np.number, np.bool_)


def _of_function(function: Function) -> StudyRecord:
    """Return a record whose values a function computes.

    Its name is that of the function.  Its description and unit are taken from the docstring, such as "Height [m].".
    """
    name = function.__name__
    line = _LINE.fullmatch((function.__doc__ or name).strip().partition("\n")[0])
    assert line is not None
    about = described(line["words"], line["unit"] or "")
    return StudyRecord(name, lambda run: function(run.scenario, run.solution), about, how=digest(function))


def _named(name: str, first: RunResult) -> StudyRecord:
    """Return the record with a name: that of a built-in number, of a state, or of an entry of the scenario's summary.

    ``first`` is the first run of the study.  It gives the labels of the states, and the entries of the summary.
    """
    if name in _NUMBERS:
        find, dtype, unit, text = _NUMBERS[name]
        return StudyRecord(name, find, described(text, unit), dtype=dtype)
    if name in _STATES:
        axis, text = _STATES[name]
        return StudyRecord(name, attrgetter(f"solution.{name}"), described(text), {axis: first.labels(axis)})
    if name not in first.summary:
        raise UnknownName("record", name, [*_NUMBERS, *_STATES, *ALWAYS, *first.summary])
    value, scenario = first.summary[name], first.scenario
    words = () if scenario is None else tuple(scenario.words.get(name, ()))
    units = {} if scenario is None else scenario.units
    parts = value if isinstance(value, (list, tuple, np.ndarray)) else (value,)
    if not (words or all(part is None or isinstance(part, _NUMBER) for part in parts)):
        remedy = "Give a function f(scenario, solution) -> number, or list the words in `words` of the scenario."
        raise InvalidInput(f"record {name}", "must be a number, a row of numbers, or a word of a list", value, remedy)
    about = described(f"{name} of the scenario", units.get(name, ""))
    axes = {} if parts is not value else {f"{name}_part": range(len(parts))}
    return StudyRecord(name, lambda result: result.summary[name], about, axes, words, "int8" if words else "float64")


def _record(requested: Requested, first: RunResult) -> StudyRecord:
    if isinstance(requested, str):
        return _named(requested, first)
    if isinstance(requested, Recorder):
        return requested.record(first)
    if (
        not inspect.isfunction(requested)
        or len(inspect.signature(requested).parameters) != 2
        or not requested.__name__.isidentifier()
    ):
        rule = "must be a name, or a function with a name and two arguments"
        remedy = "Give a name, def f(scenario, solution) that returns a number, or Trajectory(...)."
        raise InvalidInput("record", rule, requested, remedy)
    return _of_function(requested)


def records(requested: Sequence[Requested], first: RunResult) -> tuple[StudyRecord, ...]:
    """Return the records of a study.

    ``first`` is the first run of the study, up to a short time.  It provides labels, units and shapes of the records.

    Raises
    ------
    InvalidInput
        If `requested` is a string, a name is unknown or occurs twice, or a value is not a number or a listed word.
    """
    if isinstance(requested, str):
        raise InvalidInput("record", "must be a list", requested, f'For example record=["{requested}"].')
    found = tuple(_record(one, first) for one in requested if one not in ALWAYS)
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1 or name in ALWAYS:
            raise InvalidInput(f"record {name}", "must come once", names, "Rename it, or leave one out.")
    return found
