"""Outcome of a run: the status and the message of a run, by the status of the engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import REASONS, Status
from nonsmooth.interfaces import EndCause, Engine
from nonsmooth.model.blocks import block_overrun
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.overlaps import Overlap, first_overlap
from nonsmooth.runs.diagnosis import failing_function
from nonsmooth.runs.loop import Ending
from nonsmooth.solution.end import RunStatus
from nonsmooth.solution.state import Floats


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


def outcome(model: LaidOut, ending: Ending, engine: Engine) -> RunOutcome:
    """Status and message of a run of an engine that has ended.

    The first that holds is the reason: lost results, a function that wrote past its block, a cause that the engine
    declares, a failure, the end time or a condition.
    """
    # what a function wrote past its block may have changed anything, also the status
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
"""Displacement between two compared samples, relative to the smallest body. A deeper overlap is not missed."""


def interpenetration(model: LaidOut, rows: Floats) -> str:
    """Sentences about the first sample at which bodies of contacts overlap more than is allowed, or "".

    Each sample that moved is written to the memory in turn. At the end the memory has its former content again.

    Parameters
    ----------
    model : LaidOut
        The model that ran.
    rows : Floats
        Its samples, shape [n, m]: columns are t [s], q, u and more.
    """
    contacts, numbers = model.system.contacts, model.contacts_without_parts
    # the engine has compared all others during the run
    if not numbers:
        return ""
    before = Checkpoint.of(model.memory)
    least_move = _MOVED * min(contacts[i].size for i in numbers)
    try:
        for row in rows[_moved_samples(rows[:, 1 : 1 + model.n_q], least_move)]:
            model.memory[owners.Island.time] = row[0]
            model.memory[owners.Island.y] = row[1 : 1 + model.n_y]
            model.list_contacts()
            model.evaluate()
            if found := first_overlap(model, numbers):
                return _sentences(model, row[0], found)
    finally:
        before.put(model.memory)
        # a checkpoint has no results of evaluations
        model.evaluate()
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


def _moved_samples(q: Floats, least_move: float) -> list[int]:
    """Numbers of the samples that are compared: the first, the last, and between them each that moved enough.

    That is one of which a coordinate has changed by more than ``least_move`` [m or rad] since the last chosen sample.
    """
    chosen = [0]
    for i in range(1, len(q)):
        if np.max(np.abs(q[i] - q[chosen[-1]]), initial=0.0) > least_move:
            chosen.append(i)
    return sorted({*chosen, len(q) - 1})
