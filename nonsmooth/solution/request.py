"""RunRequest: the arguments of a run that its steps and samples depend on, apart from its start.

They are no part of a state, because a run may continue to another end time. The folder of a run keeps them, so that a
run that was cut off can be resumed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class RunRequest:
    """End and samples of a run.

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
