"""How far a run is in its time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.progress.pace import Pace


@final
@dataclass(frozen=True)
class TimeReached:
    """Tells the time that a run has reached.

    Attributes
    ----------
    pace : Pace
        Where it is told.
    """

    pace: Pace

    def __call__(self, t: float, t_end: float, events: int | None = None) -> None:
        """Take note of the time reached and the end time [s], and of the events so far."""
        told = "" if events is None else f"{events} events"
        self.pace.show(t / t_end, lambda _: (f"t = {t:.4g} of {t_end:.4g} s", told))
