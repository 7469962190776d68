"""Where every run is once a period, the last times: a few numbers, by which motions are told apart."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.datasets import described
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.derivatives.coordinates import coordinate_number
from nonsmooth.studies.orbits.repeating import check_period
from nonsmooth.studies.records.record import Outcome, Record, Recorder

NAME = "stroboscopic"
"""The name of the record."""
_REMEDY = "If a parameter that varies changes the frequency, make a study of its own for each of its values."
_ROUND = 1e-9
"""Part of a period by which a section may lie behind the end, for round-off."""


@final
@dataclass(frozen=True)
class Stroboscope(Recorder):
    """Some coordinates and velocities at the last sections of the stroboscopic map: once a period, at one phase.

    Parameters
    ----------
    period : float
        Of the motion that drives the system, or a multiple [s].  A run whose system has another one fails, and says so.
    within : tuple of str
        Names of coordinates and velocities, "z" or "ball.vz": those that decide what becomes of a motion, without
        those that drift or turn.
    keep : int
        How many sections are kept, those at the end of the run.
    at : float
        When in each period [s]: where no velocity jumps, or points lie on either side of it.
    phase : str, optional
        Parameter of the scenario that is the phase of the driving motion at t = 0 [rad], where it is varied: ``at``
        counts from phase 0 then, else from t = 0.

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
        if not (is_finite(self.period) and self.period > 0.0):
            raise InvalidInput("Stroboscope: period", "must be positive and finite", self.period, "Give it in [s].")
        if not self.within or len(set(self.within)) < len(self.within):
            remedy = 'For example ("z", "vz").'
            raise InvalidInput("Stroboscope: within", "must be names, each once", self.within, remedy)
        if not isinstance(self.keep, int) or self.keep < 2:
            remedy = "A period of n is seen in 2 n sections."
            raise InvalidInput("Stroboscope: keep", "must be a whole number from 2 on", self.keep, remedy)
        if not (is_finite(self.at) and 0.0 <= self.at < self.period):
            raise InvalidInput("Stroboscope: at", "must be a time within a period", self.at, "Give it in [s].")

    def record(self, look: Outcome) -> Record:
        """Return it for a system, with the scales of its bodies as an attribute.

        Raises
        ------
        UnknownName
            If a coordinate or the phase has no such name.
        InvalidInput
            If the runs are too short.
        """
        system, scenario = look.solution.system, look.scenario
        places = [coordinate_number(system, name) for name in self.within]
        scales = np.concatenate([one.scales[i] for i in (0, 1) for one in system.bodies])[places]
        if self.phase is not None:
            known = {} if scenario is None else scenario.values
            if self.phase not in known:
                raise UnknownName("Stroboscope: phase", self.phase, known)
        self._times(look.t_end, self._start(look))
        names = [*look.along("coordinate"), *look.along("velocity")]
        told = described("some of the state once a period") | {"scales": scales.tolist()}
        sections: Sequence[Any] = range(1 - self.keep, 1)
        axes = {"section": sections, "within": [names[i] for i in places]}
        return Record(NAME, self, told, axes, how=repr(self))

    def __call__(self, outcome: Outcome) -> Any:
        """Return the states of a run, shape [keep, n_within].

        Raises
        ------
        InvalidInput
            If the run is too short, or what drives its system has another period.
        """
        solution = outcome.solution
        check_period(outcome.model, solution.state, self.period, "Stroboscope: period", _REMEDY)
        states = solution.at(self._times(solution.t_end, self._start(outcome)))
        places = [coordinate_number(solution.system, name) for name in self.within]
        return np.concatenate([states["q"], states["u"]], axis=1)[:, places]

    def _start(self, outcome: Outcome) -> float:
        """Return how far the driving motion is at t = 0 [periods]."""
        if self.phase is None or outcome.scenario is None:
            return 0.0
        return float(outcome.scenario.values[self.phase]) / (2.0 * math.pi)

    def _times(self, t_end: float, start: float) -> NDArray[np.float64]:
        """Return the last times of a run that ends at ``t_end`` [s], shape [keep]."""
        before = start - self.at / self.period
        last = math.floor(t_end / self.period + before + _ROUND)
        times = (np.arange(last - self.keep + 1, last + 1) - before) * self.period
        if times[0] < -_ROUND * self.period:
            rule = f"must be short enough for a run of {t_end:g} s"
            raise InvalidInput(
                "Stroboscope: keep", rule, f"{self.keep} periods of {self.period:g} s", "Raise t_end, or keep fewer."
            )
        return np.clip(times, 0.0, t_end)
