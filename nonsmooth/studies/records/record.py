"""Record: one thing that is kept of every run."""

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
from nonsmooth.system.lookup import labels


@final
@dataclass(frozen=True, eq=False)
class Outcome:
    """A run that came to its end.

    Attributes
    ----------
    scenario : Scenario or None
        The scenario with the parameters of the run; None where a function built the system.
    model : Model
        What ran.
    solution : Solution
        What it computed; of a first look only its beginning.
    t_end : float
        When it was to end [s].
    """

    scenario: Scenario | None
    model: Model
    solution: Solution
    t_end: float

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """The numbers of the scenario, found once for all records."""
        return {} if self.scenario is None else dict(self.scenario.summarise(self.solution))

    def along(self, axis: str) -> list[str]:
        """Return the labels along "coordinate" or "velocity", with units."""
        known = labels(self.solution.system)
        rows = {"coordinate": known.coordinates, "velocity": known.velocities}[axis]
        return [f"{label} [{unit}]" for _, label, unit in rows]


@final
@dataclass(frozen=True)
class Record:
    """One thing that is kept of every run.

    Attributes
    ----------
    name : str
        Its name among the variables of the study.
    find : callable
        Returns its value: a number, None for none, a word of ``words``, or an array.
    attributes : mapping
        Unit and description.
    axes : mapping
        Of each axis behind that of the runs its name and the labels along it.
    words : tuple of str
        Of a class all names that it can have; empty for numbers.
    dtype : str
        Of the values: "int8" of a class, "int64" of a count.
    how : str
        What decides its values besides its name and axes, for the record.
    """

    name: str
    find: Callable[[Outcome], Any]
    attributes: Mapping[str, Any]
    axes: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    words: tuple[str, ...] = ()
    dtype: str = "float64"
    how: str = ""

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of one value."""
        return tuple(map(len, self.axes.values()))

    @property
    def none(self) -> float:
        """What stands where there is no value."""
        return np.nan if self.dtype == "float64" else -1

    def of(self, outcome: Outcome) -> Any:
        """Return the value of a run: numbers of this shape, or the number of a word.

        Raises
        ------
        ValueError, TypeError
            If what was found is none.
        """
        found = self.find(outcome)
        if found is None:
            return self.none
        if self.words:
            return self.words.index(found)
        value = np.asarray(found, self.dtype)
        if value.shape != self.shape:
            raise ValueError(f"the record {self.name} has the shape {value.shape}, not {self.shape}")
        return value


class Recorder(ABC):
    """Makes a record out of a first look at a run."""

    @abstractmethod
    def record(self, look: Outcome) -> Record:
        """Return the record.

        Raises
        ------
        InvalidInput
            If there can be none.
        """
