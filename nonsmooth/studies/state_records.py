"""Records of the states of a run: at given times, or once a period in the last periods, to distinguish attractors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.checks import check_count, is_finite
from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.derivatives.coordinates import coordinate_number, scales_of
from nonsmooth.studies.inputs import check_phase, check_positive
from nonsmooth.studies.orbits.scan import check_period, drive_periods
from nonsmooth.studies.records import Recorder, RunResult, StudyRecord
from nonsmooth.types import Array

NAME = "stroboscopic"
"""Name of the record of a :class:`Stroboscope`."""
_AXES = {"q": "coordinate", "u": "velocity"}
_REMEDY = "If a parameter that varies changes the frequency, make a study of its own for each of its values."
_ROUND = 1e-9
"""A state that is due after the end of the run by up to this part of a period is recorded at the end.

Such a delay is round-off.
"""


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

    def record(self, first: RunResult) -> StudyRecord:
        """Return the record; InvalidInput if the runs end before the last of ``times``."""
        if max(self.times) > first.t_end:
            rule, remedy = f"must lie within a run of {first.t_end:g} s", "Raise t_end, or leave out later times."
            raise InvalidInput("Trajectory: times", rule, max(self.times), remedy)
        axis = _AXES[self.name]
        text = described(f"{axis} over time")
        return StudyRecord(self.name, self, text, {"time": list(map(float, self.times)), axis: first.labels(axis)})

    def __call__(self, result: RunResult) -> Any:
        """Return the coordinates or velocities of a run at the times, shape [n, n_q] or [n, n_u]."""
        return result.solution.history(self.name, times=list(self.times))[self.name]


@final
@dataclass(frozen=True)
class Stroboscope(Recorder):
    """Coordinates and velocities at one time in each period of the drive, for the last periods of the run.

    Parameters
    ----------
    period : float
        Time between two recorded states [s]: the period of the drive, or a multiple of it.  A run fails if its drive
        does not repeat after this time.
    within : tuple of str
        Names of the coordinates and velocities that determine the motion, "z" or "ball.vz"; no coordinate that drifts.
    keep : int
        Number of states that are recorded, one per period, up to the end of the run.
    at : float
        Time of the recorded state in each period [s], at which no velocity jumps.
    phase : str, optional
        Parameter of the scenario that is the phase of the drive at t = 0 [rad], if the study varies it.  Then ``at``
        counts from the time at which the phase of the drive is 0; by default it counts from t = 0.  If driven
        bodies have different periods, or do not tell them, ``period`` must then be that of this phase, no multiple.

    Raises
    ------
    InvalidInput
        If a number is not valid.
    """

    period: float
    within: tuple[str, ...]
    keep: int = 32
    at: float = 0.0
    phase: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "within", tuple(self.within))
        check_positive("Stroboscope: period", self.period, "Give it in [s].")
        if not self.within or len(set(self.within)) < len(self.within):
            remedy = 'For example ("z", "vz").'
            raise InvalidInput("Stroboscope: within", "must be names, each once", self.within, remedy)
        remedy = "A period of n is seen in 2 n sections."
        check_count("Stroboscope: keep", self.keep, "must be a whole number from 2 on", remedy, least=2)
        check_phase("Stroboscope: at", self.at, self.period)

    def record(self, first: RunResult) -> StudyRecord:
        """Return the record, with the scales of the coordinates as an attribute.

        Raises
        ------
        UnknownName
            If no coordinate, velocity or parameter has the given name.
        InvalidInput
            If the runs are too short.
        """
        system, scenario = first.solution.system, first.scenario
        places = [coordinate_number(system, name) for name in self.within]
        scales = scales_of(system)[places]
        if self.phase is not None:
            known = {} if scenario is None else scenario.values
            if self.phase not in known:
                raise UnknownName("Stroboscope: phase", self.phase, known)
        self._times(first.t_end, self._start(first))
        names = [*first.labels("coordinate"), *first.labels("velocity")]
        text = described("some of the state once a period") | {"scales": scales.tolist()}
        sections: Sequence[Any] = range(1 - self.keep, 1)
        axes = {"section": sections, "within": [names[i] for i in places]}
        return StudyRecord(NAME, self, text, axes, how=repr(self))

    def __call__(self, result: RunResult) -> Any:
        """Return the coordinates and velocities of a run once a period, in its last periods, shape [keep, n_within].

        Raises
        ------
        InvalidInput
            If the run is too short, or its drive does not repeat after ``period``.
        """
        solution = result.solution
        check_period(result.model, solution.state, self.period, "Stroboscope: period", _REMEDY)
        states = solution.at(self._times(solution.t_end, self._start(result)))
        places = [coordinate_number(solution.system, name) for name in self.within]
        return np.concatenate([states["q"], states["u"]], axis=1)[:, places]

    def _start(self, result: RunResult) -> float:
        """Return the phase of the drive at t = 0, in units of ``period``."""
        if self.phase is None or result.scenario is None:
            return 0.0
        known = drive_periods(result.solution.system)
        # ``period`` may hold several periods of the drive
        cycles = max(1, round(self.period / known.pop())) if len(known) == 1 else 1
        return float(result.scenario.values[self.phase]) / (2.0 * math.pi * cycles)

    def _times(self, t_end: float, start: float) -> Array:
        """Return the times of the last recorded states of a run that ends at ``t_end`` [s], shape [keep]."""
        before = start - self.at / self.period
        last = math.floor(t_end / self.period + before + _ROUND)
        times = (np.arange(last - self.keep + 1, last + 1) - before) * self.period
        if times[0] < -_ROUND * self.period:
            rule = f"must be short enough for a run of {t_end:g} s"
            kept = f"{self.keep} periods of {self.period:g} s"
            raise InvalidInput("Stroboscope: keep", rule, kept, "Raise t_end, or keep fewer.")
        return np.clip(times, 0.0, t_end)
