"""StudyRecord: a number, word or array that a study keeps of each run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import Scenario
from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
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
        """The numbers of the scenario, computed once for all records."""
        return {} if self.scenario is None else dict(self.scenario.summarise(self.solution))

    def labels(self, axis: str) -> list[str]:
        """Return the labels along "coordinate" or "velocity", with units."""
        known = labels(self.solution.system)
        rows = {"coordinate": known.coordinates, "velocity": known.velocities}[axis]
        return [f"{label} [{unit}]" for _, label, unit in rows]


@final
@dataclass(frozen=True)
class StudyRecord:
    """A number, word or array that a study keeps of each run.

    Attributes
    ----------
    name : str
        Its name among the variables of the study.
    find : callable
        Returns its value for a RunResult: a number, None for a missing one, a word of ``words``, or an array.
    attributes : mapping
        Unit and description.
    axes : mapping
        Name of each axis after the runs, and the labels along it.
    words : tuple of str
        All words that a class can have; empty for numbers.
    dtype : str
        Type of its values: "int8" of a class, "int64" of a count.
    how : str
        Definition of its values besides name and axes, for the specification of the study.
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
        """Shape of a value."""
        return tuple(map(len, self.axes.values()))

    @property
    def none(self) -> float:
        """Value of a run that has none."""
        return np.nan if self.dtype == "float64" else -1

    def of(self, result: RunResult) -> Any:
        """Return the value of a run: numbers of this shape, or the number of a word.

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
    """Makes a record out of the first run of a study."""

    @abstractmethod
    def record(self, first: RunResult) -> StudyRecord:
        """Return the record.

        Parameters
        ----------
        first : RunResult
            The first run, up to a short time.

        Raises
        ------
        InvalidInput
            If the run cannot have it.
        """
