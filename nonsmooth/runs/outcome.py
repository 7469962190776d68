"""Why a run ended."""

from __future__ import annotations

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import CONDITION_MET, DONE, PAUSED, REASONS, STOPPED, Status
from nonsmooth.interfaces import Cause, Engine
from nonsmooth.model.block_ends import BlockEnds
from nonsmooth.model.blocks import written_past
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.diagnose import culprit
from nonsmooth.runs.loop import Ending


def cause_of(engine: Engine, status: int) -> Cause | None:
    """Return the cause of an engine's own that a status stands for, None if it is no such status."""
    return next((cause for cause in engine.causes if cause.code == status), None)


def reason(model: LaidOut, ends: BlockEnds, ending: Ending, engine: Engine) -> tuple[str, str]:
    """Return the status of a run that has ended, in a word, and why it did; ``guards`` are those of the model."""
    past, status = written_past(model, ends), ending.status
    if ending.trouble:
        return "failed", f"At t = {model.memory[owners.Island.time]:.9g} s {ending.trouble}"
    cause = cause_of(engine, status)
    if cause and not past:
        said = f"At t = {model.memory[owners.Island.time]:.9g} s {cause.reason}. {cause.remedy}".strip()
        return "failed" if cause.is_failure else "done", said
    if past or status not in (DONE, STOPPED, CONDITION_MET, PAUSED):
        why = cause.reason if cause else REASONS[Status(status)]
        message = f"At t = {model.memory[owners.Island.time]:.9g} s {why}."
        return "failed", f"{message} {past or culprit(model, status) or ending.hint}".strip()
    return "interrupted" if ending.interrupted else "done", REASONS[Status(status)]
