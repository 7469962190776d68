"""Bifurcation diagrams: a coordinate once a period, over a parameter, after the motion has settled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import floats
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number, scales_of, unit
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import completed
from nonsmooth.studies.inputs import check_periods, check_phase
from nonsmooth.studies.orbits.scan import Period, check_period, period_at, scan
from nonsmooth.studies.orbits.sections import state_at_phase
from nonsmooth.studies.periods import alike, periods, settling
from nonsmooth.studies.plotting import axes_of, dotted, few_ticks
from nonsmooth.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@final
@dataclass(frozen=True)
class Diagram:
    """A bifurcation diagram.

    Attributes
    ----------
    name, label : str
        The parameter, and its name with its unit.
    values : array
        Its values, shape [n].
    coordinate, unit : str
        The sampled coordinate or velocity, and its unit.
    points : array
        Its samples in the last ``keep`` periods; nan if a run failed; shape [n, keep].
    failures : tuple of str
        Reasons of failures, "" for a run that succeeded.
    scale : float
        Scale of the coordinate by the size of its body, in its unit.
    """

    name: str
    label: str
    values: Array
    coordinate: str
    unit: str
    points: Array
    failures: tuple[str, ...]
    scale: float

    @property
    def periods(self) -> NDArray[np.int64]:
        """Number of periods after which the motion repeats, shape [n]; 0 if it does not, -1 if the run failed."""
        found = periods(self.points[:, :, np.newaxis], alike(self.points, self.scale))
        return np.where([bool(text) for text in self.failures], -1, found)

    @property
    def settling(self) -> NDArray[np.bool_]:
        """True if the motion still settles in the last ``keep`` periods, shape [n]; then take a larger ``settle``."""
        return settling(self.points[:, :, np.newaxis], alike(self.points, self.scale))

    @property
    def failed(self) -> int:
        """Number of failed runs."""
        return sum(bool(text) for text in self.failures)

    def draw(self, ax: Axes | None = None, *, colour: str = "black", mark: str = ".", label: str | None = None) -> Axes:
        """Draw all points over the parameter; failed runs as dotted lines, motions that still settle as grey ones.

        Parameters
        ----------
        ax : Axes, optional
            The axes, which may show a branch of orbits; of a new figure by default.
        colour, mark : str
            Of the points.
        label : str, optional
            Their name in a legend.
        """
        ax = axes_of(ax)
        over = np.repeat(self.values, self.points.shape[1])
        ax.plot(over, self.points.ravel(), mark, markersize=2.0, color=colour, fillstyle="none", label=label)
        ax.set_xlabel(self.label)
        few_ticks(ax)
        ax.set_ylabel(f"{self.coordinate}, once a period [{self.unit}]")
        dotted(ax, (value for value, text in zip(self.values.tolist(), self.failures, strict=True) if text))
        for value in self.values[self.settling].tolist():
            ax.axvline(value, color="0.8", linewidth=0.8, zorder=0)
        counts = {"runs failed (dotted)": self.failed, "still settle (grey)": int(np.sum(self.settling))}
        words = [f"{count} of {len(self.values)} {word}" for word, count in counts.items() if count]
        ax.set_title("; ".join(words), fontsize=10)
        return ax


def bifurcation(
    what: Varied,
    name: str,
    values: ArrayLike,
    period: Period,
    coordinate: str,
    *,
    at: float = 0.0,
    settle: int = 200,
    keep: int = 64,
    display: Display | None = None,
) -> Diagram:
    """Sample a motion once a period for each value of a parameter.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; each run starts as it is placed.
    name : str
        The parameter.
    values : array
        Its values, shape [n].
    period : float or callable
        Period of the drive, or a multiple [s]; ``period(value)`` if the parameter changes it.  A run fails if the drive
        has another period at its value.
    coordinate : str
        The sampled coordinate or velocity, "vz" or "ball.vz".
    at : float
        Time of the sample in each period [s], at which no velocity jumps.
    settle : int
        Periods of the transient before.
    keep : int
        Periods that are sampled.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If there is no such parameter or coordinate.
    InvalidInput
        If a number is not valid, or no value gives a system.
    """
    row = np.atleast_1d(floats("bifurcation: values", values))

    def sampling(value: float) -> PeriodicSampling:
        lasts = period_at(period, value, "bifurcation: period")
        return PeriodicSampling(lasts, coordinate, at, settle, keep, "bifurcation")

    family = Family.of(what, EventDriven())
    unit, scale = sampling(family[name]).unit_and_scale(family.model())

    def points_of(model: Model, value: float) -> Array:
        return sampling(value).settled(model, model.start)[0]

    points, failures = scan(family, name, row.tolist(), points_of, np.full(keep, np.nan), display)
    return Diagram(name, family.label(name), row, coordinate, unit, np.array(points), failures, scale)


@final
@dataclass(frozen=True)
class PeriodicSampling:
    """Samples of a coordinate, one a period, after a transient.

    Attributes
    ----------
    period : float
        The period [s].
    coordinate : str
        The coordinate or velocity, "vz" or "ball.vz".
    at : float
        Time of the sample in each period [s].
    settle, keep : int
        Periods of the transient, and of the samples.
    study : str
        Subject of errors.

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
        check_periods(self.study, settle=self.settle, keep=self.keep)
        check_phase(f"{self.study}: at", self.at, self.period)

    def unit_and_scale(self, model: Model) -> tuple[str, float]:
        """Return the unit of the coordinate, and its scale by the size of its body.

        Raises
        ------
        UnknownName
            If there is no such coordinate.
        """
        number = coordinate_number(model.system, self.coordinate)
        return unit(model.system, number), float(scales_of(model.system)[number])

    def settled(self, model: Model, start: State) -> tuple[Array, State]:
        """Return the samples, shape [keep], and the state at the end of the run.

        Raises
        ------
        RunFailed
            If a run cannot continue.
        InvalidInput
            If the system does not have the period.
        """
        begin = state_at_phase(model, start, self.period, self.at)
        number = coordinate_number(model.system, self.coordinate)
        last = begin.time + (self.settle + self.keep) * self.period
        run = completed(model.run(last, start=begin, sample_interval=self.period))
        kept = slice(self.settle + 1, self.settle + 1 + self.keep)
        check_period(model, run.state, self.period, f"{self.study}: period")
        return np.concatenate([run.q, run.u], axis=1)[kept, number], run.state
