"""After a failure: which law, load or body gave a number that is not finite, or raised."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from nonsmooth.binding import interpreted
from nonsmooth.binding.compile import parameter_names
from nonsmooth.binding.law_failure import REMEDY, Finding, first_without_value, law_functions, without_value
from nonsmooth.binding.source import described, raised
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import (
    GAP_UNDECIDED,
    GAP_UNEXPLAINED,
    JOINTS_APART,
    MOTION_UNEXPLAINED,
    NOT_FINITE,
    PASSED,
    QUATERNION_UNEXPLAINED,
    STEP_TOO_SMALL,
)
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import ImpactMap
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.blocks import blocks
from nonsmooth.model.immobile import REMEDY as MOVE_IT
from nonsmooth.model.immobile import held_by, immobile_contact
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.feature_searches import failed_search
from nonsmooth.runs.squeezed import squeezed
from nonsmooth.runs.failed_check import unexplained

_CHECKED = (GAP_UNDECIDED, GAP_UNEXPLAINED, JOINTS_APART, MOTION_UNEXPLAINED, PASSED, QUATERNION_UNEXPLAINED)
"""Ends of a run by its own checks."""


def failing_function(model: LaidOut, status: int) -> str:
    """Return a sentence that names the first function found to raise or to return a non-finite number.

    It raises nothing: what was computed matters more than why it ended, and functions that fail are called here.
    """
    try:
        return _failing_function(model, status)
    except (Exception, SystemExit, KeyboardInterrupt) as error:
        return f"Looking for the cause came to nothing: {error!r}."


def _failing_function(model: LaidOut, status: int) -> str:
    if status in _CHECKED:
        return unexplained(model, status)
    if found := squeezed(model, status):
        return found
    if status == NOT_FINITE and (immobile := immobile_contact(model)) is not None:
        contact, joints, _ = immobile
        return (
            f"The {contact} cannot move along its normal, as {held_by(joints)}: its force is not determined. {MOVE_IT}"
        )
    found = (_in_the_map(model) if status == NOT_FINITE else "") or failed_search(model.memory, model.system.contacts)
    found = found or _in_the_blocks(model)
    if found or status not in (NOT_FINITE, STEP_TOO_SMALL):
        return found
    found = first_without_value(_law_findings(model)) or _guard_without_value(model)
    if found:
        return found
    state = model.memory[owners.Island.y][: model.n_y]
    if not np.all(np.isfinite(state)):
        return "The state itself is not finite: check the motions and the bodies."
    return ""


def _law_findings(model: LaidOut) -> Iterator[Finding | None]:
    first_state, made = model.n_q + model.n_u + N_ACCOUNTS, owners.Contact
    for number, contact in enumerate(model.system.contacts):
        start, n = (int(model.memory.declared(one)[number]) for one in (made.inner_states, made.n_inner_states))
        state = model.memory[owners.Island.y][: model.n_y][first_state + start :][:n]
        for part in law_functions(contact.friction, contact.impact, contact.normal):
            parameters = int(model.memory.declared(getattr(owners.Contact, f"{part.name}_parameters"))[number])
            yield without_value(model.memory.floats[parameters:], part, state, str(contact))


def _in_the_blocks(model: LaidOut) -> str:
    """Evaluate bodies, loads and contacts at the last state, at its time, at the end of the step and shortly after."""
    memory = model.memory
    t = memory[owners.Island.time]
    for time in (t, t + memory[owners.Step.h], t + 10.0 * memory[owners.Tolerance.time]):
        memory[owners.Island.time] = time
        call_entry("evaluate_at", model.memory)
        memory[owners.Island.time] = t
        for block in blocks(model):
            if not np.all(np.isfinite(model.memory.floats[block.start : block.start + block.written])):
                what = interpreted.noted(block.function) or "raises or gives a number that is not finite"
                return f"{block.label()} {what} at t = {time:.9g} s. {REMEDY}"
    return ""


def _in_the_map(model: LaidOut) -> str:
    """Run the impact map, as plain Python, on the set that collided last."""
    memory = model.memory
    n = int(memory[owners.Problem.n_active])
    law = model.system.contacts[0].impact if model.system.contacts else None
    if n == 0 or not isinstance(law, ImpactMap) or np.all(np.isfinite(memory[owners.Impact.impulse][: 3 * n])):
        return ""
    names = parameter_names(law.impulses, "map")
    given = memory[owners.Impact.map_block][: n * len(names)].reshape(-1, n)
    delassus, rates, out = (
        memory[owners.Problem.matrix][: 9 * n * n],
        memory[owners.Impact.rates_before][: 3 * n],
        np.zeros(3 * n),
    )
    try:
        law.impulses(n, delassus.copy(), rates.copy(), out, **dict(zip(names, given.copy(), strict=True)))
        what = "gives impulses that are not finite"
    except Exception as error:
        what = raised(law.impulses, error)
    listed = memory[owners.Contact.declared][: int(memory[owners.Island.n_contacts])]
    among = [str(model.system.contacts[int(i)]) for i in listed[memory[owners.Problem.active][:n]]]
    before = " ".join(np.array2string(rates.reshape(n, 3), precision=6, threshold=30, separator=", ").split())
    return (
        f"{type(law).__name__}: {described(law.impulses)}, {what} for the rates {before} m/s "
        f"({n} in contact: {'; '.join(among)})."
    )


def _guard_without_value(model: LaidOut) -> str:
    """Look at the guards at the end of the step that failed."""
    memory, state = model.memory, model.memory[owners.Step.y_new]
    q, u = state[: model.n_q], state[model.n_q : model.n_q + model.n_u]
    for watched in model.system.watched:
        guard = watched.guard
        value = guard_value(guard, memory[owners.Island.time] + memory[owners.Step.h], q, u)
        if not isinstance(value, float) or not math.isfinite(value):
            what = raised(guard.value, value) if isinstance(value, Exception) else f"gives {value!r}"
            return f"{watched}: {described(guard.value)}, {what} within {memory[owners.Step.h]:g} s."
    return ""
