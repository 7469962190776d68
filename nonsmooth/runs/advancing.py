"""Calls of an engine's ``advance``, which must keep its contract: a status that there is, and a run that gets on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import CONDITION_MET, DONE, PAUSED, REASONS
from nonsmooth.engine.memory.tables import places
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut

_STATUSES = tuple(status for status in REASONS if status != CONDITION_MET)
_WATCH = places("request.n_work", "request.work_budget", "run.n_calls")
"""What changes although nothing is done."""
(_CALLS,) = places("run.n_calls").tolist()


@final
class Advancing:
    """Calls an engine on a model.

    Parameters
    ----------
    engine : Engine
        The engine.
    model : LaidOut
        What runs.
    call : callable
        What ``advance`` gets to call entry points with.
    """

    def __init__(self, engine: Engine, model: LaidOut, call: Callable[..., Any]) -> None:
        self._engine, self._memory, self._call = engine, model.memory, call
        self._statuses = {*_STATUSES, *(cause.code for cause in engine.causes)}

    def advance(self, most_steps: int, wary: bool) -> int:
        """Let the engine go on; return the status.

        Raises
        ------
        InvalidInput
            If it breaks its contract; the message names it and the rule.
        """
        thing = f"{type(self._engine).__name__}.advance"
        # what is recorded is taken out of the buffers once for each call
        self._memory.cells[1][_CALLS] += 1
        try:
            status = self._engine.advance(self._call, self._memory, most_steps, wary)
        except UnknownName as error:
            raise InvalidInput(f"{thing}: {error.thing}", error.rule, error.value, error.remedy) from error
        if status not in self._statuses:
            names = "DONE, PAUSED, STOPPED, a failure of nonsmooth.engine.memory.modes or a code of its causes"
            raise InvalidInput(f"{thing}: its status", f"must be {names}", status, "Return PAUSED to be called again.")
        t, t_end = (self._memory[one] for one in (owners.Island.time, owners.Request.t_end))
        if status == DONE and t != t_end:
            rule = f"must be at the end time {t_end:.9g} s where it is DONE"
            remedy = "Return PAUSED to be called again, or set it to ws.request.t_end."
            raise InvalidInput(f"{thing}: ws.island.time", rule, t, remedy)
        return int(status)

    def get_on(self, most_steps: int, before: Checkpoint) -> int:
        """Let the engine go on that need not be wary, with empty buffers, from a checkpoint that the memory has.

        Errors are those of :meth:`advance`.
        """
        status = self.advance(most_steps, False)
        if status == PAUSED and self._is_as(before):
            raise InvalidInput(
                f"{type(self._engine).__name__}.advance",
                "must do a step where it need not be wary and the buffers are empty",
                f"nothing done at t = {self._memory[owners.Island.time]:.9g} s",
                "Return DONE at ws.request.t_end; where time stops passing, STALLED.",
            )
        return status

    def _is_as(self, checkpoint: Checkpoint) -> bool:
        if self._memory[owners.Island.time] != checkpoint[owners.Island.time]:
            return False
        (now, *others), (then, *kept) = self._memory.kept, checkpoint.parts
        differ = now != then
        differ[_WATCH] = False
        return not differ.any() and all(map(np.array_equal, others, kept))
