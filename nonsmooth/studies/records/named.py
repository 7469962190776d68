"""Records by name: numbers that every run has, and those of the scenario's summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, final

import numpy as np

from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.records.record import Outcome, Record, Recorder

ALWAYS = ("status", "reason")
"""What every study keeps."""


def _n_events(outcome: Outcome) -> int:
    return len(outcome.solution.events)


_COUNTS: Mapping[str, tuple[Callable[[Outcome], int], str]] = {
    "impacts": (attrgetter("solution.counters.impacts"), "impacts"),
    "events": (_n_events, "events, the start among them"),
    "steps": (attrgetter("solution.counters.steps"), "accepted steps of the flow"),
}
_NUMBERS: Mapping[str, tuple[Callable[[Outcome], float], str, str]] = {
    "t_end": (attrgetter("solution.t_end"), "s", "time reached"),
    "energy_residual": (attrgetter("solution.energy.residual"), "1", "relative error of the energy account"),
}
_NUMBER = (int, float, np.number, np.bool_)
_STATES = {"q_end": ("coordinate", "coordinates at the end"), "u_end": ("velocity", "velocities at the end")}


@final
@dataclass(frozen=True)
class Named(Recorder):
    """A count, number, state or class by its name."""

    name: str

    def record(self, look: Outcome) -> Record:
        """Return what every run has, or what the summary of this one has."""
        name = self.name
        if name in _COUNTS:
            count, told = _COUNTS[name]
            return Record(name, count, described(told, "1"), dtype="int64")
        if name in _NUMBERS:
            find, unit, told = _NUMBERS[name]
            return Record(name, find, described(told, unit))
        if name in _STATES:
            axis, told = _STATES[name]
            return Record(name, attrgetter(f"solution.{name}"), described(told), {axis: look.along(axis)})
        if name not in look.summary:
            raise UnknownName("record", name, [*_COUNTS, *_NUMBERS, *_STATES, *ALWAYS, *look.summary])
        return self._of_summary(look)

    def _of_summary(self, look: Outcome) -> Record:
        value, scenario = look.summary[self.name], look.scenario
        words = () if scenario is None else tuple(scenario.words.get(self.name, ()))
        units = {} if scenario is None else scenario.units
        parts = value if isinstance(value, (list, tuple, np.ndarray)) else (value,)
        if not (words or all(part is None or isinstance(part, _NUMBER) for part in parts)):
            remedy = "Give a function f(scenario, solution) -> number, or list the words in `words` of the scenario."
            rule = "must be a number, a row of numbers, or a word of a list"
            raise InvalidInput(f"record {self.name}", rule, value, remedy)
        told = described(f"{self.name} of the scenario", units.get(self.name, ""))
        axes = {} if parts is not value else {f"{self.name}_part": range(len(parts))}
        return Record(self.name, Summarised(self.name), told, axes, words, "int8" if words else "float64")


@final
@dataclass(frozen=True)
class Summarised:
    """Finds a number of the summary."""

    name: str

    def __call__(self, outcome: Outcome) -> Any:
        """Return it."""
        return outcome.summary[self.name]
