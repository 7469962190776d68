"""The causes that limit the length of a step."""

from __future__ import annotations

from enum import IntEnum


class Limit(IntEnum):
    """Cause that limited the length of a step."""

    NO_STEP = 0
    """No step was taken: an event began where another one ended, or the neighbour list was made again."""
    ERROR = 1
    """The estimated error."""
    LARGEST_STEP = 2
    """The largest step of the engine."""
    NEIGHBOUR_LIST = 3
    """The neighbour list is valid for no longer."""
    SAMPLES = 4
    """The buffer of samples is full."""
    FIRST_STEP = 5
    """The first step after an event is short."""
    CLOSING_GAP = 6
    """A gap is about to close."""
    SINGULARITY = 7
    """Sliding comes near Painleve's singularity."""
    STOPPING_SLIP = 8
    """A slip is about to stop."""
    EVENT = 9
    """An event."""
    CROWDED_EVENTS = 10
    """Too many guards fire in it."""
    END = 11
    """The end of the run."""
    AVERAGING = 12
    """The end of the averaging of forces."""
    TURN = 13
    """Bodies turn too far in ballistic motion."""


LIMITS = (
    "no step",
    "error",
    "largest step",
    "list of near contacts",
    "samples",
    "first step in contact",
    "gap about to close",
    "Painleve singularity",
    "slip that stops",
    "event",
    "crowded events",
    "end of the run",
    "averaging of forces",
    "turning in flight",
)
"""The limits in words, by number."""
