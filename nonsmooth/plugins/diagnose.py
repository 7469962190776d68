"""After a failure: which law, load or body gave a number that is not finite, or raised."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from nonsmooth.engine.kernel import call_room
from nonsmooth.engine.modes import NOT_FINITE, STEP_TOO_SMALL
from nonsmooth.interfaces import FrictionLaw, ImpactMap, ImpactProcess
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.layout import FRAME, GEOMETRY, LOAD
from nonsmooth.model.model import Model
from nonsmooth.plugins.compile import bind, evaluate, parameter_names

_PROBES = (0.0, *np.geomspace(1e-12, 1.0, 25).tolist())
_REMEDY = "It must return a finite number; with NONSMOOTH_PLAIN=1 a debugger can step through it."


def culprit(model: Model, status: int) -> str:
    """Return a sentence that names the first function found to raise or to return a non-finite number."""
    found = (_in_the_map(model) if status == NOT_FINITE else "") or _in_the_blocks(model)
    if found or status not in (NOT_FINITE, STEP_TOO_SMALL):
        return found
    slips = model.memory.array("rate", 3 * int(model.memory.scalars["n_contacts"][0])).reshape(-1, 3)[:, 1:]
    speeds = (*_PROBES, *np.linalg.norm(slips, axis=1).tolist())
    for contact in model.system.contacts:
        laws: list[tuple[Any, Callable[..., float], tuple[float, ...]]] = []
        if isinstance(contact.friction, FrictionLaw):
            laws.append((contact.friction, contact.friction.coefficient, speeds))
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


def _in_the_blocks(model: Model) -> str:
    """Evaluate bodies, loads and contacts at the last state, at its time, at the end of the step and shortly after."""
    scalars = model.memory.scalars
    t = float(scalars["t"][0])
    for time in (t, t + float(scalars["h"][0]), t + 10.0 * float(scalars["time_tolerance"][0])):
        scalars["t"] = time
        call_room("evaluate_at", model.memory)
        scalars["t"] = t
        for name, block in _blocks(model):
            if not np.all(np.isfinite(block)):
                return f"{name} raises or gives a number that is not finite at t = {time:.9g} s. {_REMEDY}"
    return ""


def _blocks(model: Model) -> Iterator[tuple[str, np.ndarray]]:
    """Yield what every body, load and listed contact wrote, with a name for it; loads first, as bodies feel them."""
    memory, system = model.memory, model.system
    for i, tie in enumerate(system.loads):
        start = int(memory.array("load_out", i + 1)[i])
        yield f"{tie.name}: {_source(tie.component.evaluator)}", memory.floats[start : start + LOAD]
    for i, body in enumerate(system.bodies):
        start = int(memory.array("body_out", i + 1)[i])
        size = FRAME if body.n_u == 0 else int(memory.array("body_tail", i + 1)[i]) - start + body.n_q + body.n_u
        yield f"{body!r}", memory.floats[start : start + size]
    n = int(memory.scalars["n_contacts"][0])
    geometry = memory.array("geometry", GEOMETRY * n).reshape(n, GEOMETRY)
    for number, block in zip(memory.array("identity", n), geometry, strict=True):
        contact = system.contacts[int(number)]
        yield f"{contact.name}: {_source(contact.kinematics.evaluator)}", block


def _source(function: Callable[..., Any]) -> str:
    code = function.__code__
    return f"{function.__qualname__} in {code.co_filename}, line {code.co_firstlineno},"


def _in_the_map(model: Model) -> str:
    """Run the impact map, as plain Python, on the set that collided last."""
    memory = model.memory
    n = int(memory.scalars["n_active"][0])
    law = model.system.contacts[0].impact if model.system.contacts else None
    if n == 0 or not isinstance(law, ImpactMap) or np.all(np.isfinite(memory.array("impulse", 3 * n))):
        return ""
    names = parameter_names(law.impulses, "map")
    given = memory.array("map_block", n * len(names)).reshape(-1, n)
    delassus, rates, out = memory.array("matrix", 9 * n * n), memory.array("impact_z0", 3 * n), np.zeros(3 * n)
    try:
        law.impulses(n, delassus.copy(), rates.copy(), out, **dict(zip(names, given.copy(), strict=True)))
        what = "gives impulses that are not finite"
    except Exception as error:
        what = f"refuses: {error}"
    among = [model.system.contacts[int(i)].name for i in memory.array("identity", n)[memory.array("active", n)]]
    return f"{type(law).__name__}: {_source(law.impulses)} {what} ({n} in contact: {'; '.join(among)})."


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
    values = {name: law.parameters()[name] for name in parameter_names(function, "scalar")}
    address, parameters = bind(function, "scalar", values, type(law).__name__)
    for x in probes:
        if not math.isfinite(evaluate(address, parameters, x)):
            what = _outcome(function, x, values)
            return f"{type(law).__name__}: {_source(function)} {what} at {x:g} with {values}. {_REMEDY}"
    return ""


def _outcome(function: Callable[..., float], x: float, values: dict[str, Any]) -> str:
    try:
        return f"returns {function(x, **values)!r}"
    except Exception as error:
        return f"raises {error!r}"
