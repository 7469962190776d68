"""EngineDriver: calls of an engine's ``advance``, checked against its contract.

An engine may be a plug-in. An engine that returns an unknown status would end a run without a reason, and an engine
that does nothing would be called for ever. Both faults are found at the call, and the message names the rule.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import REASONS, Status
from nonsmooth.engine.memory.tables import places
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut

_STATUSES = tuple(status for status in REASONS if status != Status.CONDITION_MET)
_CALL_COUNTERS = places("request.n_work", "request.work_budget", "run.n_calls")
"""Scalars that a call changes even if the engine does nothing."""
(_N_CALLS,) = places("run.n_calls").tolist()
UNLIMITED = 1 << 62
"""Largest number of steps of a run that has no limit."""


@final
class EngineDriver:
    """Calls an engine on a model, and checks each call.

    Parameters
    ----------
    engine : Engine
        The engine.
    model : LaidOut
        The model that runs.
    call : callable
        Calls an entry point of the compiled code by name; it is an argument of the engine's ``advance``.
    most_steps : int
        Number of steps after which the run is stopped.
    """

    def __init__(self, engine: Engine, model: LaidOut, call: Callable[..., Any], most_steps: int = UNLIMITED) -> None:
        """Drive an engine on the memory of a model. ``call`` calls an entry point of the compiled code by name.

        The engine may return the common statuses and the codes of its own causes.
        """
        self._engine, self._model, self._call, self._most_steps = engine, model, call, most_steps
        self._memory = model.memory
        self._name = f"{type(engine).__name__}.advance"
        self._statuses = {*_STATUSES, *(cause.code for cause in engine.causes)}

    def advance(self, most_steps: int, pauses_before_end: bool) -> int:
        """Advance the run by at most ``most_steps`` steps; the result is the status.

        With ``pauses_before_end`` the engine pauses before a step whose length depends on the end time, so that a
        checkpoint there is valid for any end time. It does nothing if the next step is such a step.

        Raises
        ------
        InvalidInput
            If the engine breaks its contract.
        """
        # the scalars as integers; records are filed under the number of the call
        self._memory.cells[1][_N_CALLS] += 1
        left = self._most_steps - int(self._memory[owners.Totals.n_steps])
        try:
            status = self._engine.advance(self._call, self._memory, min(most_steps, left), pauses_before_end)
            while status == Status.LIST_FULL:
                # the memory grows, the list is made there, and the run continues
                self._model.list_contacts(of_all=False)
                status = self._engine.advance(self._call, self._memory, min(most_steps, left), pauses_before_end)
        except UnknownName as error:
            # the engine called an entry point that does not exist: the message shall name the engine
            raise error.within(self._name) from error
        if status not in self._statuses:
            names = "DONE, PAUSED, STOPPED, a failure of nonsmooth.engine.memory.modes or a code of its causes"
            remedy = "Return PAUSED to be called again."
            raise InvalidInput(f"{self._name}: its status", f"must be {names}", status, remedy)
        # a run that is done has ended at the time that was requested, to the last bit
        t, t_end = self._memory[owners.Island.time], self._memory[owners.Request.t_end]
        if status == Status.DONE and t != t_end:
            rule = f"must be the end time {t_end:.9g} s if the status is DONE"
            remedy = "Return PAUSED to be called again, or set it to ws.request.t_end."
            raise InvalidInput(f"{self._name}: ws.island.time", rule, t, remedy)
        is_spent = status == Status.PAUSED and int(self._memory[owners.Totals.n_steps]) >= self._most_steps
        return int(Status.CONDITION_MET if is_spent else status)

    def advance_past(self, checkpoint: Checkpoint, most_steps: int) -> int:
        """Advance a run past a checkpoint that its memory holds now, with empty buffers; the result is the status.

        The engine need not pause before steps that the end time shortens, so it must take one step at least.

        Raises
        ------
        InvalidInput
            If the engine breaks its contract.
        """
        status = self.advance(most_steps, pauses_before_end=False)
        if status == Status.PAUSED and self._holds(checkpoint):
            raise InvalidInput(
                self._name,
                "must do a step if it need not pause before the end and the buffers are empty",
                f"nothing done at t = {self._memory[owners.Island.time]:.9g} s",
                "Return DONE at ws.request.t_end; if time stops passing, STALLED.",
            )
        return status

    def _holds(self, checkpoint: Checkpoint) -> bool:
        """True if the memory holds a checkpoint, apart from counters of calls: the engine has done nothing since."""
        # the cheapest test, and it decides most cases
        if self._memory[owners.Island.time] != checkpoint[owners.Island.time]:
            return False
        # integers of the same bits as the numbers
        (scalars, *arrays), (old_scalars, *old_arrays) = self._memory.kept, checkpoint.parts
        differs = scalars != old_scalars
        differs[_CALL_COUNTERS] = False
        return not differs.any() and all(map(np.array_equal, arrays, old_arrays))
