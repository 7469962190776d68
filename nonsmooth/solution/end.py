"""Arguments of a run, and its end: state, counters, status, and the numbers by which the engine judges the run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol, final

from nonsmooth.interfaces import Measure
from nonsmooth.solution.state import State


@final
@dataclass(frozen=True)
class RunRequest:
    """Arguments on which the steps and samples of a run depend, apart from its start: end time, samples and condition.

    A state does not contain them, because a run may continue to another end time. The folder of a run stores them, so
    that a run that was cut off can be resumed.

    Attributes
    ----------
    t_end : float
        End time [s].
    sample_start : float
        Time of the first sample [s].
    sample_interval : float
        Time between samples [s].
    has_default_samples : bool
        True if the user gave no interval: no step is then shortened for the samples.
    is_conditional : bool
        True if a condition of the user may end the run. No file holds the condition.
    """

    t_end: float
    sample_start: float
    sample_interval: float
    has_default_samples: bool
    is_conditional: bool


class RunStatus(StrEnum):
    """How a run ended. A member equals its word: ``solution.status == "done"``."""

    DONE = "done"
    """The end time, a condition or a guard ended the run."""
    SUSPECT = "suspect"
    """The run reached its end, but a check failed, such as the energy account; ``message`` says which."""
    INTERRUPTED = "interrupted"
    """The user interrupted the run."""
    FAILED = "failed"
    """The run could not continue."""
    UNFINISHED = "unfinished"
    """The run in a folder of results is under way, or was cut off."""


@dataclass(frozen=True)
class Counters:
    """Numbers of steps and impacts of a run, and its wall time.

    Attributes
    ----------
    steps, rejected : int
        Accepted and rejected steps of the motion between events.
    impacts, impact_steps : int
        Impacts and the steps taken inside them.
    limits : mapping of str to int
        Number of steps by the reason that limited their length (:data:`nonsmooth.engine.memory.modes.LIMITS`).
    gap_looks : int
        Number of evaluations of gaps within a step, in search of the time at which a gap closes.
    listings : int
        Number of times that the neighbour list was made.
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


class EndSource(Protocol):
    """Source of the end of a run: the end itself, or the memory of the model after the run."""

    def read(self) -> End:
        """Return the end of the run, read from this source."""


@final
@dataclass(frozen=True)
class End:
    """End of a run.

    Attributes
    ----------
    state : State
        State at the end.
    counters : Counters
        Numbers of steps and impacts, and wall time.
    status, message : str
        Why the run ended, as a word of :class:`RunStatus` and as a sentence.
    cause : str
        Name of the cause, if it is one that the engine declares (``Engine.causes``), else "".
    verdict : mapping of Measure to float
        Value of each measure that the engine declares to judge the run.
    """

    state: State
    counters: Counters
    status: str
    message: str
    cause: str = ""
    verdict: Mapping[Measure, float] = field(default_factory=dict)

    def read(self) -> End:
        """Return this object, because an End is an :class:`EndSource` that has been read already."""
        return self

    @property
    def measured(self) -> dict[str, float]:
        """Values of the engine's verdict on the run, by the names of the measures."""
        return {measure.name: value for measure, value in self.verdict.items()}
