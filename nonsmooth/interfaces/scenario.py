"""Scenario: a parametrised system with its figures and the numbers by which a run is judged."""

from __future__ import annotations

import dataclasses
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from nonsmooth import charts
from nonsmooth.interfaces.criterion import Criterion
from nonsmooth.parameters import Component, Rule, rules

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution
    from nonsmooth.system.system import System

Run: TypeAlias = "Callable[[Scenario], Solution]"
"""Function that simulates a scenario, as :func:`nonsmooth.run_scenario` does."""

_NUMBER = re.compile(r"_\d+$")


class Scenario(Component, ABC):
    """A ready-made system.

    A subclass gives ``title``, ``t_end``, ``build`` and ``acceptance``.  All else has a default, to be replaced by
    scenarios with coordinates, numbers or figures of their own.

    The contract:

    1. Parameters are dataclass fields declared with :func:`nonsmooth.parameters.parameter`.
    2. ``build`` returns a new System; ``t_end`` is the end time of its run.
    3. ``summarise``, ``coordinates``, ``figures`` and ``acceptance`` only read the solution.
    4. A full run of the default parameters has at least one criterion, and fulfils all.

    Attributes
    ----------
    title : str
        Title of the scenario, one line.
    samples : int
        Number of intervals between samples in a run.
    units : mapping
        Units of the numbers of ``summarise`` by name; numbers without an entry have no unit.
    coordinate_units : mapping
        Units of all ``coordinates`` by name.  The unit of z is also that of z_1, z_2 and so on.
    words : mapping
        Possible values of the words of ``summarise``, by name.
    """

    title: ClassVar[str]
    samples: ClassVar[int] = 1000
    units: ClassVar[Mapping[str, str]] = MappingProxyType({"restitution_loss": "J", "friction_loss": "J"})
    coordinate_units: ClassVar[Mapping[str, str]] = MappingProxyType({})
    words: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType({})

    @property
    @abstractmethod
    def t_end(self) -> float:
        """End time of the run [s]."""

    @abstractmethod
    def build(self) -> System:
        """Return the system at its start."""

    @abstractmethod
    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the criteria by which a finished run is judged, as far as they apply to these parameters."""

    @property
    def sample_interval(self) -> float:
        """Time between samples of the solution [s]."""
        return self.t_end / self.samples

    def resolved(self) -> Mapping[str, Any]:
        """Return the value that the run uses of each parameter, by name. By default it is the value of the field."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def name(self) -> str:
        """Name in messages; by default the name of the class."""
        return type(self).__name__

    @property
    def varies(self) -> Mapping[str, Rule]:
        """Rules of the parameters that a study can vary, by name; by default the rules of all parameters."""
        return {name: rule for name, (_, rule) in rules(type(self)).items()}

    @property
    def values(self) -> Mapping[str, Any]:
        """Values that the run uses, by name: of parameters that can be varied and of parameters derived from them."""
        return self.resolved()

    def varied(self, **changes: Any) -> Scenario:
        """Return the same scenario with other values of some parameters.

        Raises
        ------
        InvalidInput
            If a value breaks a rule.
        """
        return dataclasses.replace(self, **changes)  # type: ignore[type-var]

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the scenario's own coordinates by name, at all samples, shape [n_samples]; by default none."""
        return {}

    def unit_of(self, coordinate: str) -> str:
        """Return the unit of a coordinate, "" if none is declared."""
        known = self.coordinate_units
        return known.get(coordinate) or known.get(_NUMBER.sub("", coordinate), "")

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}, coordinates and velocities at the end; by default of all bodies of the system."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return numbers and words that describe the run; by default the number of impacts and the losses [J]."""
        account = solution.energy
        return {
            "impacts": solution.counters.impacts,
            "restitution_loss": account.restitution_loss,
            "friction_loss": account.friction_loss,
        }

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return matplotlib figures of this run by file name; by default the coordinates over time."""
        own = {f"{name} [{self.unit_of(name)}]": x for name, x in self.coordinates(solution).items()}
        system = solution.system
        bodies = zip(system.bodies, system.names.bodies, strict=True)
        labels = [charts.verbatim(f"{label} {name} [{unit}]") for body, label in bodies for name, unit in body.q_labels]
        drawn = own or dict(zip(labels, solution.q.T, strict=True))
        return {"coordinates": charts.histories({y: {"": (solution.t, x)} for y, x in drawn.items()}, self.title)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the published figures by file name, and call ``run`` for the runs that they need.

        By default it returns the figures of a run with the default parameters.
        """
        scenario = cls()
        return scenario.figures(run(scenario))
