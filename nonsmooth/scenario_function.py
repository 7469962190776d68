"""Decorator that makes a scenario from a function that builds its system."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Mapping
from types import new_class
from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

Acceptance = Callable[[Any, Solution], tuple[Criterion, ...]]
Figures = Callable[[Any, Solution], Mapping[str, Any]]


def scenario(
    *, title: str, t_end: float, acceptance: Acceptance, figures: Figures | None = None
) -> Callable[[Callable[..., System]], Any]:
    """Turn a function that returns a system into a :class:`nonsmooth.interfaces.Scenario`.

    The result is a class with the name of the function.  It is used, registered, studied and tested as any scenario.
    Its parameters are the arguments of the function and the end time ``t_end``.  The function receives ``t_end`` only
    if it has an argument of this name.

    Parameters
    ----------
    title : str
        One line of text.
    t_end : float
        End time of the run [s]; users can set another one.
    acceptance : callable
        ``acceptance(scenario, solution)`` returns the criteria of a finished run.  The parameters are attributes of
        the scenario.
    figures : callable, optional
        ``figures(scenario, solution)`` returns matplotlib figures by file name; by default the coordinates over time.

    Returns
    -------
    callable
        The decorator, whose result is the class.

    Raises
    ------
    InvalidInput
        If an argument of the function is not declared with :func:`nonsmooth.parameters.parameter`.

    Examples
    --------
    >>> @scenario(title="A ball falls", t_end=0.4, acceptance=when_it_lands)
    ... def falling_ball(height: float = parameter(0.5, doc="height of the drop", unit="m", above=0.0)) -> System:
    ...     ...
    >>> run_scenario(falling_ball(height=0.2))
    """

    def decorate(function: Callable[..., System]) -> Any:
        declared = inspect.signature(function).parameters

        def build(self: Any) -> System:
            return function(**{name: getattr(self, name) for name in declared})

        members: dict[str, Any] = {"title": title, "build": build, "acceptance": acceptance}
        members |= {"figures": figures} if figures is not None else {}
        return _class_of(function, members, _fields(function.__name__, declared, t_end))

    return decorate


def _fields(name: str, declared: Mapping[str, inspect.Parameter], t_end: float) -> dict[str, tuple[Any, Any]]:
    """Annotation and dataclass field of each parameter by name."""
    fields: dict[str, tuple[Any, Any]] = {}
    for argument in declared.values():
        if argument.name == "t_end":
            continue
        if not isinstance(argument.default, dataclasses.Field):
            remedy = f'Write {argument.name}: float = parameter(0.2, doc="what it is", unit="m").'
            raise InvalidInput(f"{name}: {argument.name}", "must be declared with parameter()", argument, remedy)
        fields[argument.name] = argument.annotation, argument.default
    return fields | {"t_end": (float, parameter(t_end, doc="end time", unit="s", above=0.0))}


def _class_of(function: Callable[..., System], members: Mapping[str, Any], fields: Mapping[str, Any]) -> Any:
    """Make the scenario class of a function, a frozen dataclass, with methods ``members`` and parameters ``fields``.

    The class has the name and the module of the function, so that pickle finds it there.
    """
    namespace: dict[str, Any] = {name: getattr(function, name) for name in ("__module__", "__qualname__", "__doc__")}
    namespace |= members
    namespace |= {name: field for name, (_, field) in fields.items()}
    namespace["__annotations__"] = {name: annotation for name, (annotation, _) in fields.items()}
    # inspect.getsource finds the text of the function, by which a study knows what it ran
    namespace["__wrapped__"] = staticmethod(function)
    made: Any = new_class(function.__name__, (Scenario,), exec_body=lambda content: content.update(namespace))
    return dataclasses.dataclass(frozen=True)(made)
