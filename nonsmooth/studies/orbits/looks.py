"""When and at what diagrams look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number, unit
from nonsmooth.studies.orbits.choosing import at_phase
from nonsmooth.studies.orbits.repeating import check_counts, check_period

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Looks:
    """When and at what a diagram looks.

    Attributes
    ----------
    period : float
        [s].
    coordinate : str
        Which coordinate or velocity, "vz" or "ball.vz".
    at : float
        When in each period [s].
    settle, keep : int
        Periods that are left out, and those that are kept.
    study : str
        What errors name.

    Raises
    ------
    InvalidInput
        If a number is not valid.
    """

    period: float
    coordinate: str
    at: float
    settle: int
    keep: int
    study: str

    def __post_init__(self) -> None:
        check_counts(self.study, settle=self.settle, keep=self.keep)
        if not (is_finite(self.at) and 0.0 <= self.at < self.period):
            remedy = f"Give it in [s]; a period has {self.period:.9g} s."
            raise InvalidInput(f"{self.study}: at", "must be a time within a period", self.at, remedy)

    def unit_and_scale(self, model: Model) -> tuple[str, float]:
        """Return the unit of what is looked at, and its scale by the size of its body.

        Raises
        ------
        UnknownName
            If there is no such coordinate.
        """
        number, bodies = coordinate_number(model.system, self.coordinate), model.system.bodies
        scales = np.concatenate([body.scales[i] for i in (0, 1) for body in bodies])
        return unit(model.system, number), float(scales[number])

    def settled(self, model: Model, start: State) -> tuple[Floats, State]:
        """Return what is looked at in the last periods, shape [keep], and where the run ended.

        Raises
        ------
        RunFailed
            If a run cannot go on.
        InvalidInput
            If the system does not have the period.
        """
        begin = at_phase(model, start, self.period, self.at)
        number = coordinate_number(model.system, self.coordinate)
        last = begin.time + (self.settle + self.keep) * self.period
        run = model.run(last, start=begin, sample_interval=self.period)
        if run.status == "interrupted":
            raise KeyboardInterrupt
        kept = slice(self.settle + 1, self.settle + 1 + self.keep)
        check_period(model, run.state, self.period, f"{self.study}: period")
        return np.concatenate([run.q, run.u], axis=1)[kept, number], run.state
