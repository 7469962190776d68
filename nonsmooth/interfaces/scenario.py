"""Scenario: a parametrised system with its figures and the numbers that say what happened."""

from __future__ import annotations

import dataclasses
import re
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from nonsmooth.interfaces.criterion import Criterion
from nonsmooth.parameters import Component, Rule, rules

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution
    from nonsmooth.system.system import System

_NUMBER = re.compile(r"_\d+$")


class Scenario(Component, ABC):
    """A ready-made system.

    The contract:

    1. Parameters are dataclass fields declared with :func:`nonsmooth.parameters.parameter`.
    2. ``build`` returns a new System; ``t_end`` says how long to run it.
    3. ``summarise``, ``coordinates``, ``figures`` and ``acceptance`` only read the solution.
    4. A full run of the default parameters has at least one criterion, and fulfils all.
    5. ``units`` are those of the numbers of ``summarise``, by name; the others have none.  ``coordinate_units`` are
       those of all ``coordinates``, by name; of z_1, z_2 and so on that of z.  ``words`` are all words that a word
       of ``summarise`` can be, by name.
    """

    title: ClassVar[str]
    units: ClassVar[Mapping[str, str]] = {}
    coordinate_units: ClassVar[Mapping[str, str]] = {}
    words: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    @property
    @abstractmethod
    def t_end(self) -> float:
        """End time of the run [s]."""

    @property
    @abstractmethod
    def sample_interval(self) -> float:
        """Time between samples of the solution [s]."""

    @abstractmethod
    def build(self) -> System:
        """Return the system at its start."""

    @abstractmethod
    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters with the values that the run uses."""

    @property
    def name(self) -> str:
        """What messages call it; its class by default."""
        return type(self).__name__

    @property
    def varies(self) -> Mapping[str, Rule]:
        """What can be varied, by name, with what is known of it; all parameters by default."""
        return {name: rule for name, (_, rule) in rules(type(self)).items()}

    @property
    def values(self) -> Mapping[str, Any]:
        """The values that the run uses of what can be varied, and of what is derived from it."""
        return self.resolved()

    def varied(self, **changes: Any) -> Scenario:
        """Return the same scenario with other values; what it derives from them follows.

        Raises
        ------
        InvalidInput
            If a value breaks a rule.
        """
        return dataclasses.replace(self, **changes)  # type: ignore[type-var]

    @abstractmethod
    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the scenario's own coordinates over the samples: name -> array [n_samples]."""

    def unit_of(self, coordinate: str) -> str:
        """Return the unit of a coordinate, "" where none is declared."""
        known = self.coordinate_units
        return known.get(coordinate) or known.get(_NUMBER.sub("", coordinate), "")

    @abstractmethod
    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u} at the end in the scenario's own coordinates."""

    @abstractmethod
    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the numbers that say what happened."""

    @abstractmethod
    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the numbers by which a finished run is judged; those that hold for these parameters."""

    @abstractmethod
    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return matplotlib figures of this run by file name."""

    @classmethod
    @abstractmethod
    def gallery(cls, progress: Any) -> Mapping[str, Any]:
        """Run what the scenario's published figures need and return them all by file name."""
