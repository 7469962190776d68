"""Hysteresis: bifurcation diagrams with rising and with falling values, each run starting from the one before."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import floats
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.orbits.diagram import Diagram, PeriodicSampling
from nonsmooth.studies.orbits.scan import Period, period_at, scan
from nonsmooth.studies.orbits.sections import clearest_state
from nonsmooth.studies.periods import alike
from nonsmooth.studies.plotting import BLUE, GREEN, axes_of, finish
from nonsmooth.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@final
@dataclass(frozen=True)
class Hysteresis:
    """Bifurcation diagrams of a motion as a parameter rises, and as it falls again.

    Attributes
    ----------
    up, down : Diagram
        Both ways, each with its values rising.
    """

    up: Diagram
    down: Diagram

    @property
    def apart(self) -> NDArray[np.bool_]:
        """True if both ways lead to different motions, of which at least one repeats; shape [n]."""
        both = np.array([self.up.points, self.down.points])
        differ = np.max(np.abs(np.diff(np.sort(both, axis=2), axis=0)[0]), axis=1) > alike(both, self.up.scale)
        periodic = np.array([self.up.periods, self.down.periods]) > 0
        others = (periodic[0] != periodic[1]) | (periodic.all(axis=0) & differ)
        return np.asarray(others & np.isfinite(both).all(axis=(0, 2)))

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw both ways with their own marks and colours, on axes or in a new figure."""
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

    At the first value either way, and after a failed run, the system starts as it is placed.  At each other value the
    motion continues from a state of its neighbour with few closed contacts.  Closed contacts stay closed, and bodies
    that would overlap touch.

    Parameters
    ----------
    what, name, values, period, coordinate, at, settle, keep
        As of :func:`bifurcation`; the values are sorted.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If there is no such parameter or coordinate.
    InvalidInput
        If a number is not valid, or no value gives a system.
    """
    row = np.unique(floats("hysteresis: values", values))
    n = len(row)

    def sampling(value: float) -> PeriodicSampling:
        lasts = period_at(period, value, "hysteresis: period")
        return PeriodicSampling(lasts, coordinate, at, settle, keep, "hysteresis")

    family = Family.of(what, EventDriven())
    unit, scale = sampling(family[name]).unit_and_scale(family.model())
    last = dict[int, tuple[Model, State, float]]()
    """Model, last state and period of the run before, by the place of its value."""

    def points_of(model: Model, value: float) -> Array:
        i, one = int(np.searchsorted(row, value)), sampling(value)
        neighbour = last.pop(i - 1, None) or last.pop(i + 1, None)
        last.clear()
        start = model.start if neighbour is None else _carried(model, one.period, *neighbour)
        points, end = one.settled(model, start)
        last[i] = model, end, one.period
        return points

    found, failures = scan(
        family, name, [*row.tolist(), *row[::-1].tolist()], points_of, np.full(keep, np.nan), display
    )
    ways = [(found[:n], failures[:n]), (found[: n - 1 : -1], failures[: n - 1 : -1])]
    up, down = (
        Diagram(name, family.label(name), row, coordinate, unit, np.array(points), texts, scale)
        for points, texts in ways
    )
    return Hysteresis(up, down)


def _carried(model: Model, period: float, last: Model, state: State, last_period: float) -> State:
    """Return the state in which a motion of another model continues in a model, at the same phase of the drive."""
    there = clearest_state(last, state, last_period)
    there = replace(there, time=there.time % last_period * (period / last_period))
    # a body in low flight that a faster plate would reach is placed on it
    reached = (model.contact_rates(there)[0] < 0.0) & (there.modes == Mode.OPEN)
    there = replace(there, modes=np.where(reached, Mode.SLIDE, there.modes))
    return Chart.at(model, there).held_in(model, there)
