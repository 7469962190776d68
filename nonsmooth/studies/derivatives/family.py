"""Family: systems that differ in the values of parameters, and their models."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias, final

from nonsmooth.checks import is_finite
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files.scenario import FileScenario
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.runs.model import Model
from nonsmooth.studies.plotting import with_unit
from nonsmooth.system.system import System

EXACT = EventDriven(tolerance=1e-12, impact_tolerance=1e-12, time_tolerance=1e-14)
"""Engine for derivatives: with the default tolerances, errors at events would be as large as small differences."""
_UNUSED = 1.0
"""End time [s] that :class:`FileScenario` requires; it has no effect, because studies choose the times of runs."""
_KEPT = 64
"""Largest number of cached models: more than the differences about one point need."""


@final
@dataclass(frozen=True)
class Family:
    """Systems that differ in the values of parameters.

    Attributes
    ----------
    make : callable
        ``make(**values)`` returns a new System.
    values : mapping of str to float
        The values of all parameters that may be changed.
    engine : Engine
        Integrates the systems; :data:`EXACT` by default.
    units : mapping of str to str
        Units of the parameters, as far as they are known.
    """

    make: Callable[..., System]
    values: Mapping[str, float]
    engine: Engine = EXACT
    units: Mapping[str, str] = field(default_factory=dict)
    _models: dict[tuple[float, ...], Model] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, what: Varied, engine: Engine = EXACT) -> Family:
        """Return the family of a scenario or a system; a family is returned unchanged.

        The family of a scenario varies the parameters whose values are finite numbers.  The family of a system varies
        all numbers of the file that :func:`save_system` would write.  Their names are the dotted keys of this file:
        "bodies.ball.radius", "laws.coulomb.friction".

        Raises
        ------
        InvalidInput
            If `what` has another type, or a component of the system cannot be written to a file.
        """
        if isinstance(what, Family):
            return what
        scenario = FileScenario.of(what, _UNUSED) if isinstance(what, System) else what
        if not isinstance(scenario, Scenario):
            remedy = "Give a scenario, a System, or Family(make, values) with a function that returns a System."
            raise InvalidInput("studies", "must be of a scenario, a system or a family", what, remedy)
        known = {name: float(value) for name, value in scenario.values.items() if is_finite(value)}

        def make(**values: float) -> System:
            # only changed values are given: parameters that the scenario derives from others then follow these
            return scenario.varied(**{name: x for name, x in values.items() if x != known[name]}).build()

        units = {name: rule.unit for name, rule in scenario.varies.items() if name in known}
        return cls(make, known, engine, units)

    def __getitem__(self, name: str) -> float:
        """Return the value of a parameter.

        Raises
        ------
        UnknownName
            If the family has no parameter of this name.
        """
        if name not in self.values:
            raise UnknownName("parameter", name, set(self.values))
        return float(self.values[name])

    def label(self, name: str) -> str:
        """Return the name of a parameter with its unit, for the axis of a picture."""
        return with_unit(name, self.units.get(name, ""))

    def at(self, **changed: float) -> Family:
        """Return the family with some values changed; both share the cached models."""
        for name in changed:
            _ = self[name]
        return replace(self, values={**self.values, **changed})

    def model(self, **changed: float) -> Model:
        """Return the model of the system with some values changed; it may start in any state."""
        values = self.at(**changed).values
        key = tuple(values.values())
        if key not in self._models:
            if len(self._models) >= _KEPT:
                self._models.pop(next(iter(self._models)))
            self._models[key] = Model.anywhere(self.make(**values), self.engine)
        return self._models[key]


Varied: TypeAlias = Scenario | System | Family
"""A scenario, a system or a family: its numbers can be varied."""
