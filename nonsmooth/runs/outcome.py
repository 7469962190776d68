"""Outcome of a run: its status and message, and the sentences of its message about overlaps and the energy."""

from __future__ import annotations

import contextlib
from typing import NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import REASONS, Mode, Status
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import EndCause, Engine
from nonsmooth.model.blocks import block_overrun
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.overlaps import Overlap, first_overlap
from nonsmooth.runs.diagnosis import failing_function
from nonsmooth.runs.loop import LoopEnd
from nonsmooth.runs.samples import states_at_samples
from nonsmooth.solution.end import RunStatus
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Floats, Integers

_NEGLIGIBLE = 0.1
"""Change of the energy imbalance that is left out at either end of the reported span, relative to its whole change.

Without this omission the span could be long, although most of the change occurs in a short time.
"""
_MODE_AFTER_FALLBACK = 4
"""Column of ``Events.listed_memory`` with the mode that a contact gets at the end of the time-stepping fallback.

The column has the mode "open" for a contact that is not in the fallback.
"""
_N_NAMED = 4
"""Largest number of bodies that the message names."""


def imbalance_span(solution: Solution) -> str:
    """Sentence with the span of time in which most of the energy imbalance arose, and the bodies in contact then.

    The imbalance [J] is the change of energy that no work and no loss explains, a function of time. Most of it arises
    between its least and its greatest value. If contacts are in the time-stepping fallback in this span, only their
    bodies are named: the fallback computes only mean forces, so it is the likely cause. Otherwise the bodies of all
    contacts of the events are named. The sentence is "" if the imbalance is constant or cannot be computed.
    """
    events = solution.events
    times = np.unique(np.concatenate([solution.t, events.time, [solution.t_end]]))
    try:
        imbalance = solution.history("unexplained_energy", times=times)["unexplained_energy"]
    except InvalidInput:
        # no history can be computed, because contacts were declared since the run
        return ""
    first, last = _span(imbalance)
    if first == last:
        # the imbalance is constant, so that no span contains its change
        return ""
    span = f"Most of it came about from t = {times[first]:.9g} s to {times[last]:.9g} s"
    contacts, has_fallback = _contacts_within(events, times[first], times[last])
    if len(contacts) == 0:
        return f"{span}."
    pairs = [solution.system.contacts[number] for number in np.unique(contacts).tolist()]
    # free bodies of these contacts by identity, so that each body is named once
    bodies = {id(body): body for one in pairs for body in (one.first, one.second) if body.n_u > 0}
    names = [repr(solution.system.name_of(body)) for body in bodies.values()]
    more = f" and {len(names) - _N_NAMED} more" if len(names) > _N_NAMED else ""
    where = "in the time-stepping fallback" if has_fallback else "in contacts"
    return f"{span}, {where} of {', '.join(names[:_N_NAMED])}{more}."


def _span(imbalance: Floats) -> tuple[int, int]:
    """First and last index of the span between the least and the largest value of an imbalance [J].

    The span is then shortened. It begins at the last index whose imbalance is near the value at the first end, and ends
    at the first index whose imbalance is near the value at the last end. Near means within a tenth of the whole change.
    """
    first, last = sorted((int(np.argmin(imbalance)), int(np.argmax(imbalance))))
    if first == last:
        return first, last
    within, negligible = imbalance[first : last + 1], _NEGLIGIBLE * float(np.ptp(imbalance))
    last = first + int(np.argmax(np.abs(within - within[-1]) <= negligible))
    first += int(np.flatnonzero(np.abs(within - within[0]) <= negligible)[-1])
    return first, last


def _contacts_within(events: Events, begin: float, end: float) -> tuple[Integers, bool]:
    """Numbers of the contacts of the events from ``begin`` to ``end`` [s]; True if these contacts are in the fallback.

    If some of the contacts are in the time-stepping fallback, which solves for mean forces, only these are returned.
    """
    # the last event before the span shows the contacts at its beginning
    first = max(0, int(np.searchsorted(events.time, begin, side="right")) - 1)
    last = int(np.searchsorted(events.time, end, side="right"))
    # event i has the entries events.first[i] to events.first[i + 1] of the list of contacts. The range is empty without
    # events
    entries = slice(*events.first[[first, max(first, last)]].tolist()) if len(events) else slice(0)
    contacts = events.listed[entries]
    in_fallback = contacts[events.listed_memory[entries, _MODE_AFTER_FALLBACK] != Mode.OPEN]
    return (in_fallback, True) if len(in_fallback) else (contacts, False)


class RunOutcome(NamedTuple):
    """How a run ended, and why.

    Attributes
    ----------
    status : RunStatus
        How it ended.
    message : str
        The reason, as a sentence.
    """

    status: RunStatus
    message: str


def cause_of(engine: Engine, status: int) -> EndCause | None:
    """The cause, among those that an engine declares itself, whose code is a status; None for a common status."""
    return next((cause for cause in engine.causes if cause.code == status), None)


def outcome(model: LaidOut, ending: LoopEnd, engine: Engine) -> RunOutcome:
    """Status and message of a run of an engine that has ended.

    The first that holds is the reason: lost results, a function that wrote past its block, a cause that the engine
    declares, a failure, the end time or a condition.
    """
    # check first if a function wrote past its block of the memory: it may have changed any number, also the status
    overrun, status = block_overrun(model), ending.status
    at = f"At t = {model.memory[owners.Island.time]:.9g} s"
    if ending.output_error:
        return RunOutcome(RunStatus.FAILED, f"{at} {ending.output_error}")
    cause = cause_of(engine, status)
    if cause and not overrun:
        message = f"{at} {cause.reason}. {cause.remedy}".strip()
        return RunOutcome(RunStatus.FAILED if cause.is_failure else RunStatus.DONE, message)
    # PAUSED is the status of a run that the user interrupted
    if overrun or status not in (Status.DONE, Status.STOPPED, Status.CONDITION_MET, Status.PAUSED):
        reason = cause.reason if cause else REASONS[Status(status)]
        details = overrun or failing_function(model, status) or ending.hint
        return RunOutcome(RunStatus.FAILED, f"{at} {reason}. {details}".strip())
    end = RunStatus.INTERRUPTED if ending.is_interrupted else RunStatus.DONE
    return RunOutcome(end, REASONS[Status(status)])


_MOVED = 0.01
"""Least motion since the last checked sample after which a sample is checked, relative to the smallest body.

The check is for overlap of bodies: a smaller motion hides no deeper overlap.
"""


def interpenetration(model: LaidOut, rows: Floats) -> str:
    """Sentences about the first sample at which bodies of contacts overlap more than is allowed, or "".

    Parameters
    ----------
    model : LaidOut
        The model that ran.
    rows : Floats
        Samples of the run, shape [n, m]: columns are t [s], q, u and more.
    """
    contacts, numbers = model.system.contacts, model.contacts_without_parts
    # no contact has to be checked here: the engine has checked all of them during the run
    if not numbers:
        return ""
    least_move = _MOVED * min(contacts[i].size for i in numbers)
    with contextlib.closing(states_at_samples(model, rows, least_move)) as times:
        for t in times:
            model.list_contacts()
            model.evaluate()
            if found := first_overlap(model, numbers):
                return _sentences(model, t, found)
    return ""


def _sentences(model: LaidOut, t: float, overlap: Overlap) -> str:
    """Sentences about an overlap at time t [s]."""
    contact = overlap.contact
    first, second = (model.system.name_of(body) for body in (contact.first, contact.second))
    return (
        f"bodies passed into each other. At t = {t:.9g} s {first!r} and {second!r} of the "
        f"{contact} overlap by at least {overlap.depth:.3g} m. Turn or shift one of them by a thousandth of its "
        "size, or give its body convex pieces: MeshBody(..., decomposition=Decomposition())."
    )
