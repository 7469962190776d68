"""How a run ended: the state, what it cost, the status, and the numbers by which the engine judges it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from nonsmooth.interfaces import Measure
from nonsmooth.solution.state import State


@dataclass(frozen=True)
class Counters:
    """What the run cost.

    Attributes
    ----------
    steps, rejected : int
        Accepted and rejected steps of the flow.
    impacts, impact_steps : int
        Impacts and the steps taken inside them.
    limits : mapping of str to int
        How many steps were limited by what (:data:`nonsmooth.engine.memory.modes.LIMITS`).
    gap_looks : int
        How often open gaps had to be looked at within a step to prove that they stay open.
    listings : int
        How often the contacts that are near each other were listed anew.
    wall_seconds : float
        Wall time of the engine [s].
    """

    steps: int
    rejected: int
    impacts: int
    impact_steps: int
    limits: Mapping[str, int]
    gap_looks: int
    listings: int
    wall_seconds: float


@final
@dataclass(frozen=True)
class End:
    """How a run ended.

    Attributes
    ----------
    state : State
        Where it ended.
    counters : Counters
        What it cost.
    status, message : str
        Why it stopped, in a word and in a sentence.
    cause : str
        Name of the cause of the engine's own for which it ended, "" if there is none.
    verdict : mapping of Measure to float
        The numbers by which the engine judges it.
    """

    state: State
    counters: Counters
    status: str
    message: str
    cause: str = ""
    verdict: Mapping[Measure, float] = field(default_factory=dict)
