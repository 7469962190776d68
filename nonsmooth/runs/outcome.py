"""Outcome: the status and the message of a run, by the status of the engine."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import REASONS, Status
from nonsmooth.interfaces import Cause, Engine
from nonsmooth.model.blocks import block_overrun
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.diagnosis import failing_function
from nonsmooth.runs.loop import Ending


class Outcome(NamedTuple):
    """How a run ended, for its user.

    Attributes
    ----------
    status : str
        "done", "suspect", "interrupted" or "failed".
    message : str
        The reason, as a sentence.
    """

    status: str
    message: str


def cause_of(engine: Engine, status: int) -> Cause | None:
    """The cause, among those that an engine declares itself, whose code is a status; None for a common status."""
    return next((cause for cause in engine.causes if cause.code == status), None)


def outcome(model: LaidOut, ending: Ending, engine: Engine) -> Outcome:
    """Status and message of a run of an engine that has ended.

    The first that holds is the reason: lost results, a function that wrote past its block, a cause that the engine
    declares, a failure, the end time or a condition.
    """
    # what a function wrote past its block may have changed anything, also the status
    overrun, status = block_overrun(model), ending.status
    at = f"At t = {model.memory[owners.Island.time]:.9g} s"
    if ending.output_error:
        return Outcome("failed", f"{at} {ending.output_error}")
    cause = cause_of(engine, status)
    if cause and not overrun:
        message = f"{at} {cause.reason}. {cause.remedy}".strip()
        return Outcome("failed" if cause.is_failure else "done", message)
    # PAUSED is the status of a run that the user interrupted
    if overrun or status not in (Status.DONE, Status.STOPPED, Status.CONDITION_MET, Status.PAUSED):
        reason = cause.reason if cause else REASONS[Status(status)]
        details = overrun or failing_function(model, status) or ending.hint
        return Outcome("failed", f"{at} {reason}. {details}".strip())
    return Outcome("interrupted" if ending.is_interrupted else "done", REASONS[Status(status)])
