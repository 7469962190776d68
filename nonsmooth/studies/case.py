"""Cases of a study: the system of each run, from a scenario or a function of its parameters."""

from __future__ import annotations

import dataclasses
import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files.scenario import FileScenario
from nonsmooth.interfaces import Scenario
from nonsmooth.parameters import check_number
from nonsmooth.studies.inputs import check_positive
from nonsmooth.studies.provenance import digest
from nonsmooth.studies.sampling import Sampling, Value
from nonsmooth.system.system import System


@dataclass(frozen=True)
class Case:
    """The system and the end time of one run.

    Attributes
    ----------
    scenario : Scenario or None
        The scenario with the parameters of the run; None if a function built the system.
    system : System
        The system at its start.
    t_end : float
        End time [s].
    sample_interval : float or None
        Time between samples [s]; a 2000th of the run if it is None.
    """

    scenario: Scenario | None
    system: System
    t_end: float
    sample_interval: float | None


class CaseFactory(ABC):
    """Builds the cases of a study.

    The contract:

    1. ``check`` refuses wrong names and values of parameters before anything runs.
    2. ``case`` may be called in any thread and, unpickled, in another process.
    """

    @property
    @abstractmethod
    def name(self) -> str:
        """Name of the scenario or function, for messages."""

    @abstractmethod
    def check(self, sampling: Sampling) -> None:
        """Check names and values of the varied parameters.

        Raises
        ------
        InvalidInput
            If a name is unknown, or a value breaks the rule of its parameter.
        """

    @abstractmethod
    def case(self, parameters: Mapping[str, Value]) -> Case:
        """Return the case of a run with these parameters."""

    @abstractmethod
    def attributes(self, name: str) -> dict[str, str]:
        """Return unit and description of a parameter."""

    @abstractmethod
    def described(self) -> Mapping[str, Any]:
        """Return the definition of the cases, a part of the specification of the study."""


@final
@dataclass(frozen=True)
class ScenarioCases(CaseFactory):
    """Cases of a scenario with other values of its parameters."""

    scenario: Scenario

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.name

    def check(self, sampling: Sampling) -> None:
        """Check names, and the least and greatest value of each; each run checks rules between parameters."""
        known, owner = self.scenario.varies, self.name
        for name, values in sampling.columns.items():
            if name not in known:
                raise UnknownName(f"parameter of {owner}", name, known)
            rule, thing = known[name], f"{owner}.{name}"
            if (rule.unit == "") != (values.dtype.kind == "U"):
                kind = "words" if rule.unit == "" else "numbers"
                raise InvalidInput(thing, f"must be varied over {kind}", values[0].item(), f"It is the {rule.doc}.")
            if rule.unit == "":
                for word in sorted(set(values.tolist())) if rule.choices else ():
                    if word not in rule.choices:
                        raise UnknownName(thing, word, rule.choices)
            else:
                check_number(thing, values.min().item(), rule)
                check_number(thing, values.max().item(), rule)

    def case(self, parameters: Mapping[str, Value]) -> Case:
        """Build the scenario with these parameters."""
        one = self.scenario.varied(**parameters)
        return Case(one, one.build(), one.t_end, one.sample_interval)

    def attributes(self, name: str) -> dict[str, str]:
        """Return unit and description that the scenario declares."""
        rule = self.scenario.varies[name]
        return described(rule.doc, rule.unit)

    def described(self) -> Mapping[str, Any]:
        """Return class of the scenario, digest of the source text of the class, and all parameters."""
        owner = type(self.scenario)
        values = {field.name: getattr(self.scenario, field.name) for field in dataclasses.fields(self.scenario)}  # type: ignore[arg-type]
        name = f"{owner.__module__}:{owner.__qualname__}"
        return {"scenario": name, "source_sha256": digest(owner), "parameters": values}


@final
@dataclass(frozen=True)
class FunctionCases(CaseFactory):
    """Cases of a function ``f(**parameters) -> System``, which other processes find by its name.

    Attributes
    ----------
    function : callable
        Function that is defined in a module, with arguments for the varied parameters.
    t_end : float
        End time of every run [s].
    """

    function: Callable[..., System]
    t_end: float

    def __post_init__(self) -> None:
        if not inspect.isfunction(self.function) or "<" in self.function.__qualname__:
            remedy = "Give a Scenario, or a function that is defined in a module and returns a System."
            raise InvalidInput("Study: what it runs", "must be a scenario or a function", self.function, remedy)

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.__name__

    def check(self, sampling: Sampling) -> None:
        """Check that varied parameters are arguments of the function, and that its other arguments have defaults."""
        takes = inspect.signature(self.function).parameters
        free = any(one.kind is one.VAR_KEYWORD for one in takes.values())
        named = {name: one for name, one in takes.items() if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)}
        for name in sampling.columns:
            if name not in named and not free:
                raise UnknownName(f"parameter of {self.function.__name__}", name, named)
        for name, one in named.items():
            if one.default is one.empty and name not in sampling.columns:
                thing = f"parameter {name} of {self.function.__name__}"
                raise InvalidInput(thing, "must be varied, as it has no default", None, "Add it to the sampling.")

    def case(self, parameters: Mapping[str, Value]) -> Case:
        """Build the system by calling the function with these parameters."""
        return Case(None, self.function(**parameters), self.t_end, None)

    def attributes(self, name: str) -> dict[str, str]:
        """Return the name of the parameter as its description, because a function declares no units."""
        return described(name)

    def described(self) -> Mapping[str, Any]:
        """Return name and digest of the source text of the function, and the end time [s]."""
        name = f"{self.function.__module__}:{self.function.__qualname__}"
        return {"function": name, "source_sha256": digest(self.function), "t_end": self.t_end}


def case_factory(runs: Scenario | System | Callable[..., System], t_end: float | None) -> CaseFactory:
    """Return the cases of a scenario, a system or a function; a scenario has its own end time.

    Raises
    ------
    InvalidInput
        If `runs` has another type, `t_end` [s] is missing or not positive, or `t_end` is given for a scenario.
    """
    if isinstance(runs, Scenario):
        if t_end is not None:
            remedy = "Change the end time of the scenario."
            raise InvalidInput("Study: t_end", "must be left out, as the scenario has its own", t_end, remedy)
        return ScenarioCases(runs)
    rule = "must be positive and finite for a system or a function"
    check_positive("Study: t_end", t_end, "Give Study(..., t_end=1.0) in [s].", rule)
    assert t_end is not None
    return ScenarioCases(FileScenario.of(runs, t_end)) if isinstance(runs, System) else FunctionCases(runs, t_end)
