"""Diagnosis of a failed run: the law, load or body that raised or gave a number that is not finite.

The engine only finds that some number is not finite. Here the functions of the model are called again, one by one, at
the last state, until one fails: first the checks of the run and the impact map, then bodies, loads and contacts, then
laws and guards.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from operator import itemgetter

import numpy as np

from nonsmooth.binding import interpreted
from nonsmooth.binding.compile import parameter_names
from nonsmooth.binding.law_failure import REMEDY, Finding, first_without_value, without_value
from nonsmooth.binding.law_functions import LawFunction, law_functions
from nonsmooth.binding.source import described, raised
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import ImpactMap
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.blocks import blocks
from nonsmooth.model.feature_searches import failed_search
from nonsmooth.model.immobile import REMEDY as IMMOBILE_REMEDY
from nonsmooth.model.immobile import held_by, immobile_contact
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.squeezed import squeezed_body
from nonsmooth.system.contact import Contact

_FAILED_CHECKS = {
    Status.GAP_UNEXPLAINED: "The {contact}: the gap is {found:.3g} m; the tolerances allow {allowed:.3g} m. ",
    Status.PASSED: (
        "The bodies {first!r} and {second!r} of the {contact} overlap by {found:.3g} m; their closed contacts allow "
        "{allowed:.3g} m. Their features missed each other: turn or shift one of them by a thousandth of its size, "
        "give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...)."
    ),
    Status.JOINTS_APART: (
        "They are apart by {found:.3g} m or rad; the tolerances allow {allowed:.3g}. Leave out a joint that repeats "
        "another one, and let no inertia be below 1e-8 of the largest one of joined bodies: round-off moves it."
    ),
    Status.MOTION_UNEXPLAINED: (
        "The body {body!r} would have to move by {found:.3g} in one of its coordinates; the tolerances allow "
        "{allowed:.3g}. What is closed around it contradicts itself."
    ),
    Status.QUATERNION_UNEXPLAINED: (
        "The body {body!r}: the length of its quaternion is off by {found:.3g} after one step; the tolerances allow "
        "{allowed:.3g}. The rates that {evaluator} gives do not keep its length. "
    ),
}
"""Message for each failed check, by the status of the engine. It names contact or body, value found and value allowed.
"""
_CHECK = "Run `nonsmooth check` on a kinematics or body of your own; report an error of nonsmooth."
"""Remedy for a contact or body whose evaluator returns numbers that contradict each other.

A user's component is to be checked; a fault in a component of nonsmooth is to be reported.
"""
_NAMED = 3
"""Largest number of contacts that a message names. Contacts with the same laws may share the function that failed."""
_SHIFT = "Shift or turn a body a little, or give it rounded edges."
"""Remedy for a pair of features whose gap jumps in a special pose, such as edges in line."""
_COMPLIANT = "Give it a compliant normal law such as LinearCompliant, or leave out a contact that holds the same body."
"""Remedy if closed contacts of one body require different poses of it."""


def failing_function(model: LaidOut, status: int) -> str:
    """Sentence that names the first function found to fail after a run ended with a status, or "".

    No exception leaves it, not even SystemExit of a user's function that is called here: the results of the run matter
    more than the reason of its end.
    """
    try:
        return _failing_function(model, status)
    except (Exception, SystemExit, KeyboardInterrupt) as error:
        return f"The search for the failing function failed: {error!r}."


def _failing_function(model: LaidOut, status: int) -> str:
    """The sentence of :func:`failing_function`. Diagnoses that need few calls come first.

    They call functions of the user, so this may raise.
    """
    if status in _FAILED_CHECKS:
        return _failed_check(model, Status(status))
    if found := squeezed_body(model, status):
        return found
    # a contact that joints hold has no finite force, and an impact map may give impulses that are not finite
    found = _immobile(model) or _failing_map(model) if status == Status.NOT_FINITE else ""
    found = found or failed_search(model.memory, model.system.contacts) or _failing_block(model)
    # a law without a finite value may also reject steps until they are too small
    if found or status not in (Status.NOT_FINITE, Status.STEP_TOO_SMALL):
        return found
    if found := first_without_value(_law_findings(model)) or _failing_guard(model):
        return found
    if not np.all(np.isfinite(model.memory[owners.Island.y])):
        return "The state itself is not finite: check the motions and the bodies."
    return ""


def _failed_check(model: LaidOut, status: Status) -> str:
    """Sentences about a check that a run failed. The engine has stored the value found and the largest one allowed."""
    run, memory = owners.Run, model.memory
    found, allowed, number = (memory[one] for one in (run.found, run.allowed, run.failed_number))
    # depending on the status, ``number`` counts active contacts, declared contacts or bodies
    is_of_body = status in (Status.MOTION_UNEXPLAINED, Status.QUATERNION_UNEXPLAINED)
    things = {"found": found, "allowed": allowed}
    if is_of_body:
        things |= {"body": model.system.names.bodies[number]}
        things |= {"evaluator": described(model.system.bodies[number].evaluator)}
    elif status != Status.JOINTS_APART:
        contact = model.system.contacts[number if status == Status.PASSED else model.active[number]]
        first, second = map(model.system.name_of, (contact.first, contact.second))
        things |= {"contact": contact, "first": first, "second": second}
    text = _FAILED_CHECKS[status].format(**things)
    if status == Status.GAP_UNEXPLAINED:
        # a closed contact has a gap if other closed contacts require another pose of its bodies. In any other case the
        # gap that the evaluator of its kinematics returns has a jump
        if memory[owners.ContactRecord.mode][number] != Mode.OPEN and (others := _other_closed(model, contact)):
            return f"{text}It is closed, and {others} hold its bodies in another position. {_COMPLIANT}"
        return f"{text}It jumps in {described(contact.kinematics.evaluator)}. {_CHECK} {_SHIFT}"
    return f"{text}{_CHECK}" if status == Status.QUATERNION_UNEXPLAINED else text


def _other_closed(model: LaidOut, contact: Contact) -> str:
    """Names of the other closed contacts that share a free body with ``contact``; "" if there are none.

    Contacts between the same two bodies as ``contact`` are omitted. For every other pair of bodies only the first
    contact is named.
    """
    modes = model.memory[owners.ContactRecord.mode][: len(model.active)]
    # only free bodies count: contacts cannot change the pose of a driven body, which has no velocities (n_u = 0)
    free = {id(body) for body in (contact.first, contact.second) if body.n_u > 0}
    pairs = dict[tuple[int, int], str]()
    for number in model.active[modes != Mode.OPEN].tolist():
        other = model.system.contacts[number]
        bodies = id(other.first), id(other.second)
        if free & {*bodies} and {*bodies} != {id(contact.first), id(contact.second)}:
            pairs.setdefault(bodies, f"the {other}")
    return ", ".join(pairs.values())


def _immobile(model: LaidOut) -> str:
    """Sentence that names a contact that joints prevent from moving along its normal, or ""."""
    found = immobile_contact(model)
    if found is None:
        return ""
    return (
        f"The {found.contact} cannot move along its normal, as {held_by(found.joints)}: its force is not determined. "
        f"{IMMOBILE_REMEDY}"
    )


def _law_findings(model: LaidOut) -> Iterator[Finding | None]:
    """For each function of the laws of active contacts: a sentence on the last input without a finite value, or None.

    The engine has stored this input in front of the parameters of the function, which begin the slice of floats. The
    function is called again with the inner states of the last state. Contacts that share their parameters are named
    together.
    """
    memory, contact = model.memory, owners.ContactRecord
    states = memory[owners.Island.y][model.n_q + model.n_u + N_ACCOUNTS :]
    # by offset of the parameters: the function, the inner states, and the contacts
    found: dict[int, tuple[LawFunction, np.ndarray, list[Contact]]] = {}
    for index, number in sorted(enumerate(model.active.tolist()), key=itemgetter(1)):
        declared = model.system.contacts[number]
        start, n = (int(memory[one][index]) for one in (contact.inner_states, contact.n_inner_states))
        for part in law_functions(declared.friction, declared.impact, declared.normal):
            parameters = int(memory[part.parameters][index])
            found.setdefault(parameters, (part, states[start:][:n], []))[2].append(declared)
    for parameters, (part, state, contacts) in found.items():
        names = ", ".join(map(str, contacts[:_NAMED])) + (", ..." if len(contacts) > _NAMED else "")
        yield without_value(memory.floats[parameters:], part, state, names)


def _failing_block(model: LaidOut) -> str:
    """Sentence that names a body, load or contact whose function gives no finite numbers, or "".

    They are evaluated at the last state, at its time, at the end of the failed step and shortly after: functions of
    time may fail between two steps. The time in the memory is changed for the evaluation only.
    """
    memory = model.memory
    t = memory[owners.Island.time]
    # ten time tolerances after an event at t: a function of time that switches there has switched
    for time in (t, t + memory[owners.Step.h], t + 10.0 * memory[owners.Tolerance.time]):
        memory[owners.Island.time] = time
        call_entry("evaluate_at", memory)
        memory[owners.Island.time] = t
        for block in blocks(model):
            if not np.all(np.isfinite(memory.floats[block.start : block.start + block.n_written])):
                fault = interpreted.noted(block.function) or "raises or gives a number that is not finite"
                return f"{block.label()} {fault} at t = {time:.9g} s. {REMEDY}"
    return ""


def _failing_map(model: LaidOut) -> str:
    """Sentence about the impact map if its last impulses are not finite, or "".

    An impact map is a law for all contacts of a system at once. It is called again as plain Python, with copies of the
    numbers that the engine gave it, because it may change its arguments.
    """
    memory = model.memory
    # contacts of the last impact. Rates, impulses and Delassus matrix have three components for each
    n = int(memory[owners.Problem.n_active])
    law = model.system.contacts[0].impact if model.system.contacts else None
    if n == 0 or not isinstance(law, ImpactMap) or np.all(np.isfinite(memory[owners.Impact.impulse][: 3 * n])):
        return ""
    names = parameter_names(law.impulses, "map")
    # a row for each parameter, with a column for each contact
    parameters = memory[owners.Impact.map_block][: n * len(names)].reshape(-1, n)
    delassus = memory[owners.Problem.matrix][: 9 * n * n].copy()
    rates = memory[owners.Impact.rates_before][: 3 * n]
    impulses = np.zeros(3 * n)
    try:
        law.impulses(n, delassus, rates.copy(), impulses, **dict(zip(names, parameters.copy(), strict=True)))
        fault = "gives impulses that are not finite"
    except Exception as error:
        fault = raised(law.impulses, error)
    contacts = [str(model.system.contacts[i]) for i in model.active[memory[owners.Problem.active][:n]]]
    # without line breaks
    before = " ".join(np.array2string(rates.reshape(n, 3), precision=6, threshold=30, separator=", ").split())
    return (
        f"{type(law).__name__}: {described(law.impulses)}, {fault} for the rates {before} m/s "
        f"({n} in contact: {'; '.join(contacts)})."
    )


def _failing_guard(model: LaidOut) -> str:
    """Sentence that names a guard of the user without a finite value at the end of the failed step, or "".

    A guard is a function of time and state whose zeros are events.
    """
    state, h = model.memory[owners.Step.y_new], model.memory[owners.Step.h]
    q, u = state[: model.n_q], state[model.n_q : model.n_q + model.n_u]
    for watched in model.system.watched:
        guard = watched.guard
        value = guard_value(guard, model.memory[owners.Island.time] + h, q, u)
        if not isinstance(value, float) or not math.isfinite(value):
            fault = raised(guard.value, value) if isinstance(value, Exception) else f"gives {value!r}"
            return f"{watched}: {described(guard.value)}, {fault} within {h:g} s."
    return ""
