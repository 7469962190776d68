"""The states of every run at some times: many numbers, kept where they are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

from nonsmooth.checks import is_finite
from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.records.record import Outcome, Record, Recorder

_AXES = {"q": "coordinate", "u": "velocity"}


@final
@dataclass(frozen=True)
class Trajectory(Recorder):
    """Coordinates or velocities at times within the run.

    Parameters
    ----------
    name : str
        "q" for coordinates, "u" for velocities; the name of the record.
    times : tuple of float
        Times [s], shape [n].
    """

    name: str
    times: tuple[float, ...]

    def __post_init__(self) -> None:
        if self.name not in _AXES:
            raise UnknownName("Trajectory", self.name, _AXES)
        object.__setattr__(self, "times", tuple(self.times))
        if not self.times or not all(is_finite(time) and time >= 0.0 for time in self.times):
            rule, remedy = "must be finite numbers, none negative", "For example (0.0, 0.5, 1.0)."
            raise InvalidInput("Trajectory: times", rule, self.times, remedy)

    def record(self, look: Outcome) -> Record:
        """Return it for a system.

        Raises
        ------
        InvalidInput
            If the runs end before the last time.
        """
        if max(self.times) > look.t_end:
            rule, remedy = f"must lie within a run of {look.t_end:g} s", "Raise t_end, or leave out what is behind it."
            raise InvalidInput("Trajectory: times", rule, max(self.times), remedy)
        axis = _AXES[self.name]
        told = described(f"{axis} over time")
        return Record(self.name, self, told, {"time": list(map(float, self.times)), axis: look.along(axis)})

    def __call__(self, outcome: Outcome) -> Any:
        """Return the states of a run, shape [n, n_q] or [n, n_u]."""
        return outcome.solution.history(self.name, times=list(self.times))[self.name]
