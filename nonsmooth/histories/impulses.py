"""Impulses of contacts in the events of a run, with their points and directions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import NORMAL, POINT_A
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.replay import check_recorded
from nonsmooth.histories.request import HistoryRequest


@final
@dataclass(frozen=True)
class Impulses:
    """Impulses of all events, one entry for each contact that an event lists, in the order of ``events.listed``.

    Impulses act on the second body of the contact, in world axes.  The first body has the opposite impulse.

    Attributes
    ----------
    time : array
        Time of the event [s], shape [m].
    impulse_event, impulse_contact : array
        Numbers of the event and of the contact, shape [m].
    impulse_point : array
        Contact points on the first and the second body [m], NaN if the bodies are far apart; shape [m, 2, 3].
    impulse_normal : array
        Unit normal from the first to the second body, shape [m, 3].
    normal_impulse : array
        Normal impulse [N s], shape [m].
    friction_impulse : array
        Friction impulse [N s], shape [m, 3].
    """

    time: Floats
    impulse_event: Integers
    impulse_contact: Integers
    impulse_point: Floats
    impulse_normal: Floats
    normal_impulse: Floats
    friction_impulse: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> Impulses:
        """Impulses of a run.

        Raises
        ------
        InvalidInput
            The engine of the run records no impulses.
        """
        check_recorded("Solution.history", "impulses", request.solution.system, request.solution.recorded.engine)
        return cls.recorded(request)

    @classmethod
    def recorded(cls, request: HistoryRequest) -> Impulses:
        """Impulses that the engine recorded; no entries if the engine records no contacts."""
        events, replay = request.solution.events, request.replay
        n, memory = len(events.listed), replay.laid.memory
        points, axes = np.full((n, 2, 3), np.nan), np.full((n, 3, 3), np.nan)
        # evaluate the contact points once for each instant, because all events of an instant have the same points
        instants, begins = np.unique(events.time, return_index=True)
        ends = np.append(begins[1:], len(events))

        def keep(i: int) -> None:
            slots = int(memory[owners.Island.n_contacts])
            blocks = memory[owners.ContactRecord.geometry][:slots]
            directions = memory[owners.ContactRecord.axes][:slots].reshape(slots, 3, 3)
            slot = np.full(events.n_contacts, -1)
            slot[memory[owners.ContactRecord.declared][:slots]] = np.arange(slots)
            entries = np.arange(events.first[begins[i]], events.first[ends[i]])
            found = slot[events.listed[entries]]
            entries, found = entries[found >= 0], found[found >= 0]
            points[entries] = blocks[found, POINT_A : POINT_A + 6].reshape(-1, 2, 3)
            axes[entries] = directions[found]
            axes[entries, 0] = blocks[found, NORMAL : NORMAL + 3]

        replay.visit_near(instants, replay.states(instants), keep)
        event = np.repeat(np.arange(len(events)), np.diff(events.first))
        impulse = events.listed_impulse
        friction = np.einsum("ir,irx->ix", impulse[:, 1:], axes[:, 1:])
        return cls(events.time[event], event, events.listed, points, axes[:, 0], impulse[:, 0], friction)
