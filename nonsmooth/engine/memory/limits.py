"""What may limit a step of the flow: codes and their words."""

from __future__ import annotations

(
    NO_STEP,
    BY_ERROR,
    BY_LARGEST,
    BY_LIST,
    BY_SAMPLES,
    BY_FIRST,
    BY_CLOSING,
    BY_SINGULARITY,
    BY_STOP,
    BY_EVENT,
    BY_CROWD,
    BY_END,
    BY_AVERAGING,
    BY_TURN,
) = range(14)

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
"""Their words; without a step are the events that begin where another ended, and new lists of near contacts."""
