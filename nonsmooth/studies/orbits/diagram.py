"""Bifurcation diagrams: a coordinate, sampled once per period after the motion has settled, over a parameter.

In a hysteresis diagram the parameter rises, then falls, and each run continues the motion of the previous run.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.charts import verbatim
from nonsmooth.checks import floats
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.plot.arguments import axes_of
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.coordinates import coordinate_number, scales_of, unit
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import completed
from nonsmooth.studies.inputs import check_periods, check_phase
from nonsmooth.studies.orbits.scan import Period, check_period, period_at, scan
from nonsmooth.studies.orbits.sections import clearest_state, state_at_phase
from nonsmooth.studies.periods import alike, periods, settling
from nonsmooth.studies.plotting import BLUE, GREEN, dotted, few_ticks, finish
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
        Name of the parameter, without and with its unit.
    values : array
        Values of the parameter, shape [n].
    coordinate, unit : str
        The sampled coordinate or velocity, and its unit.
    points : array
        Samples of the coordinate in the last ``keep`` periods, shape [n, keep]; nan if a run failed.
    failures : tuple of str
        Reasons of failures, "" for a run that succeeded.
    scale : float
        Scale of the coordinate, from the size of its body, in the unit of the coordinate.
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
        """Number of periods after which the motion repeats, up to half of ``keep``, shape [n].

        It is 0 for a motion that does not repeat within these periods, and -1 for a failed run.
        """
        found = periods(self.points[:, :, np.newaxis], alike(self.points, self.scale))
        return np.where([bool(text) for text in self.failures], -1, found)

    @property
    def settling(self) -> NDArray[np.bool_]:
        """True if the motion still approaches its attractor in the last ``keep`` periods, shape [n].

        Then repeat the diagram with more periods of transient (``settle``).
        """
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
            Colour and mark of the points, as in matplotlib.
        label : str, optional
            Name of the points in a legend.
        """
        ax = axes_of(ax)
        over = np.repeat(self.values, self.points.shape[1])
        ax.plot(over, self.points.ravel(), mark, markersize=2.0, color=colour, fillstyle="none", label=label)
        ax.set_xlabel(self.label)
        few_ticks(ax)
        ax.set_ylabel(verbatim(f"{self.coordinate}, once a period [{self.unit}]"))
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
        Name of the parameter.
    values : array
        Values of the parameter, shape [n].
    period : float or callable
        Period of the drive, or a multiple [s]; ``period(value)`` if the parameter changes it.  A run fails if the drive
        has another period at its value.
    coordinate : str
        The sampled coordinate or velocity, "vz" or "ball.vz".
    at : float
        Time of the sample in each period [s], at which no velocity jumps.
    settle : int
        Number of periods of the transient, which are not sampled.
    keep : int
        Number of periods that are sampled.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If the system has no parameter or coordinate of this name.
    InvalidInput
        If an argument is not valid, or the runs at all values are refused.
    """
    row = np.atleast_1d(floats("bifurcation: values", values))
    sampling = PeriodicSampling(period, coordinate, at, settle, keep, "bifurcation")
    family = Family.of(what, EventDriven())
    blank = sampling.diagram(family, name, row)

    def points_of(model: Model, value: float) -> Array:
        return sampling.settled(model, model.start, value)[0]

    points, failures = scan(family, name, row.tolist(), points_of, np.full(keep, np.nan), display)
    return replace(blank, points=np.array(points), failures=failures)


@final
@dataclass(frozen=True)
class PeriodicSampling:
    """Samples of a coordinate, one a period, after a transient.

    Attributes
    ----------
    period : float or callable
        The period [s], or a function from the value of the parameter to the period.
    coordinate : str
        The coordinate or velocity, "vz" or "ball.vz".
    at : float
        Time of the sample in each period [s].
    settle, keep : int
        Number of periods of the transient, and of the samples.
    study : str
        Name of the study in messages of errors.

    Raises
    ------
    InvalidInput
        If a number is not valid.
    """

    period: Period
    coordinate: str
    at: float
    settle: int
    keep: int
    study: str

    def __post_init__(self) -> None:
        check_periods(self.study, settle=self.settle, keep=self.keep)

    def lasts(self, value: float) -> float:
        """Return the period of the samples at a value of the parameter [s].

        Raises
        ------
        InvalidInput
            If the period is not positive, or the time of the sample is not within it.
        """
        period = period_at(self.period, value, f"{self.study}: period")
        check_phase(f"{self.study}: at", self.at, period)
        return period

    def diagram(self, family: Family, name: str, values: Array) -> Diagram:
        """Return the diagram before the first run, without points but with labels, unit and scale of the coordinate.

        Raises
        ------
        UnknownName
            If the system has no parameter or coordinate of this name.
        InvalidInput
            If the period is not valid.
        """
        self.lasts(family[name])
        system = family.model().system
        number = coordinate_number(system, self.coordinate)
        scale, points = float(scales_of(system)[number]), np.zeros((0, self.keep))
        return Diagram(name, family.label(name), values, self.coordinate, unit(system, number), points, (), scale)

    def settled(self, model: Model, start: State, value: float) -> tuple[Array, State]:
        """Run from a start through the transient; return the samples, shape [keep], and the last state of the run.

        Raises
        ------
        RunFailed
            If a run cannot continue.
        InvalidInput
            If the period of the drive at ``value`` differs from the period of the sampling.
        """
        period = self.lasts(value)
        begin = state_at_phase(model, start, period, self.at)
        number = coordinate_number(model.system, self.coordinate)
        last = begin.time + (self.settle + self.keep) * period
        run = completed(model.run(last, start=begin, sample_interval=period))
        kept = slice(self.settle + 1, self.settle + 1 + self.keep)
        check_period(model, run.state, period, f"{self.study}: period")
        return np.concatenate([run.q, run.u], axis=1)[kept, number], run.state


@final
@dataclass(frozen=True)
class Hysteresis:
    """Bifurcation diagrams of a motion as a parameter rises, and as it falls again.

    Attributes
    ----------
    up, down : Diagram
        Diagrams for rising and for falling values; both store their values in rising order.
    """

    up: Diagram
    down: Diagram

    @property
    def apart(self) -> NDArray[np.bool_]:
        """True at each value of the parameter that has two motions, one as it rises and one as it falls; shape [n].

        At least one of the two motions must repeat: two motions that do not repeat cannot be compared point by point.
        """
        both = np.array([self.up.points, self.down.points])
        differ = np.max(np.abs(np.diff(np.sort(both, axis=2), axis=0)[0]), axis=1) > alike(both, self.up.scale)
        periodic = np.array([self.up.periods, self.down.periods]) > 0
        others = (periodic[0] != periodic[1]) | (periodic.all(axis=0) & differ)
        return np.asarray(others & np.isfinite(both).all(axis=(0, 2)))

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw the diagrams for rising and for falling values in two colours and marks, on axes or in a new figure."""
        ax = self.up.draw(axes_of(ax), colour=BLUE, mark="^", label=f"{self.up.name} rises")
        self.down.draw(ax, colour=GREEN, mark="v", label=f"{self.down.name} falls")
        failed = self.up.failed + self.down.failed
        words = f"; {failed} runs failed (dotted)" if failed else ""
        title = f"{np.sum(self.apart)} of {len(self.up.values)} values have two motions{words}"
        return finish(ax, "", "", title, grid="")


def hysteresis(
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
) -> Hysteresis:
    """Sample a motion once a period for rising, then falling values of a parameter.

    At the first value in each direction, and after a failed run, the system starts as it is placed.  At each other
    value the run continues the motion at the previous value.  It starts from the state, in the last period of this
    motion, that has the fewest closed contacts.  These contacts are also closed at the new value.  Bodies that would
    overlap at the new value are placed in contact.

    Parameters
    ----------
    what, name, values, period, coordinate, at, settle, keep
        As in :func:`bifurcation`; the values are sorted.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If the system has no parameter or coordinate of this name.
    InvalidInput
        If an argument is not valid, or the runs at all values are refused.
    """
    row = np.unique(floats("hysteresis: values", values))
    sampling = PeriodicSampling(period, coordinate, at, settle, keep, "hysteresis")
    family = Family.of(what, EventDriven())
    blank = sampling.diagram(family, name, row)
    last = dict[int, tuple[Model, State, float]]()
    """Model, last state and period of the previous run, by the index of its parameter value in ``row``."""

    def points_of(model: Model, value: float) -> Array:
        i, lasts = int(np.searchsorted(row, value)), sampling.lasts(value)
        neighbour = last.pop(i - 1, None) or last.pop(i + 1, None)
        last.clear()
        start = model.start if neighbour is None else _carried(model, lasts, *neighbour)
        points, end = sampling.settled(model, start, value)
        last[i] = model, end, lasts
        return points

    n, both_ways = len(row), [*row.tolist(), *row[::-1].tolist()]
    points, failures = scan(family, name, both_ways, points_of, np.full(keep, np.nan), display)
    return Hysteresis(
        replace(blank, points=np.array(points[:n]), failures=failures[:n]),
        replace(blank, points=np.array(points[: n - 1 : -1]), failures=failures[: n - 1 : -1]),
    )


def _carried(model: Model, period: float, last: Model, state: State, last_period: float) -> State:
    """Return the state from which ``model`` continues a motion of ``last``, the model of another parameter value.

    The phase of the drive is the same.  The closed contacts fulfil the constraints of ``model``.
    """
    there = clearest_state(last, state, last_period)
    there = replace(there, time=there.time % last_period * (period / last_period))
    # the new model may move bodies into each other, for example if a plate vibrates farther: close these open contacts
    reached = (model.contact_rates(there)[0] < 0.0) & (there.modes == Mode.OPEN)
    there = replace(there, modes=np.where(reached, Mode.SLIDE, there.modes))
    return Chart.at(model, there).held_in(model, there)
