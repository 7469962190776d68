"""After a failure: which law or body gave a number that is not finite."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.engine.modes import NOT_FINITE
from nonsmooth.interfaces import ImpactProcess
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.model import Model
from nonsmooth.plugins.compile import parameter_names

_PROBES = (0.0, 1e-12, 1e-6, 1e-3, 1e-1, 1.0)


def culprit(model: Model, status: int) -> str:
    """Return a sentence that names the first function found to raise or to return a non-finite number."""
    if status != NOT_FINITE:
        return ""
    for contact in model.system.contacts:
        laws: list[tuple[Any, Callable[..., float], tuple[float, ...]]] = [
            (contact.friction, contact.friction.coefficient, _PROBES)
        ]
        if isinstance(contact.impact, ImpactProcess):
            laws.append((contact.impact, contact.impact.force, _PROBES))
            laws.append((contact.impact, contact.impact.efficiency, tuple(-p for p in _PROBES) + _PROBES))
        for law, function, probes in laws:
            found = _probe(law, function, probes)
            if found:
                return f"{found} ({contact.name})"
    found = _guard_without_value(model)
    if found:
        return found
    state = model.memory.array("y", model.n_y)
    if not np.all(np.isfinite(state)):
        return "The state itself is not finite: check the motions and the bodies."
    return ""


def _guard_without_value(model: Model) -> str:
    """Look at the guards at the end of the step that failed."""
    scalars, state = model.memory.scalars[0], model.memory.array("y_new", model.n_y)
    q, u = state[: model.n_q], state[model.n_q : model.n_q + model.n_u]
    for guard in model.system.guards:
        value = guard_value(guard, float(scalars["t"] + scalars["h"]), q, u)
        if not isinstance(value, float) or not math.isfinite(value):
            return (
                f"{type(guard).__name__}: {guard.value.__qualname__} gives {value!r} within {float(scalars['h']):g} s."
            )
    return ""


def _probe(law: Any, function: Callable[..., float], probes: tuple[float, ...]) -> str:
    names = parameter_names(function, "scalar")
    values = {name: law.parameters()[name] for name in names}
    where = f"{type(law).__name__}: {function.__qualname__} in {function.__code__.co_filename}"
    where += f", line {function.__code__.co_firstlineno}"
    for x in probes:
        try:
            result = function(x, **values)
        except Exception as error:
            return f"{where}, raises {error!r} at {x:g} with {values}."
        if not math.isfinite(result):
            return f"{where}, returns {result!r} at {x:g} with {values}."
    return ""
