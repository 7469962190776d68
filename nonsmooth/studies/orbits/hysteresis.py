"""Bifurcation diagrams that follow a motion: each value of the parameter starts where the one before has come to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import floats
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.plot.arguments import axes_of
from nonsmooth.plot.lines import beside
from nonsmooth.progress import Display, Pace, RunsDone
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.displays import display_of
from nonsmooth.studies.orbits.choosing import chosen
from nonsmooth.studies.orbits.diagram import Diagram
from nonsmooth.studies.orbits.looks import Looks
from nonsmooth.studies.orbits.repeating import Period, period_at
from nonsmooth.studies.periods import alike

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Hysteresis:
    """What a motion comes to as a parameter rises, and as it falls again.

    Attributes
    ----------
    up, down : Diagram
        Both ways, each with its values rising.
    """

    up: Diagram
    down: Diagram

    @property
    def apart(self) -> NDArray[np.bool_]:
        """Where both ways have come to other motions, of which one repeats at least, and neither failed; shape [n]."""
        both = np.array([self.up.points, self.down.points])
        differ = np.max(np.abs(np.diff(np.sort(both, axis=2), axis=0)[0]), axis=1) > alike(both, self.up.scale)
        periodic = np.array([self.up.periods, self.down.periods]) > 0
        others = (periodic[0] != periodic[1]) | (periodic.all(axis=0) & differ)
        return np.asarray(others & np.isfinite(both).all(axis=(0, 2)))

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw both ways, told apart by marks and colours.

        Parameters
        ----------
        ax : Axes, optional
            Where; a new figure by default.

        Returns
        -------
        Axes
            The axes.
        """
        ax = self.up.draw(axes_of(ax), colour="#0072b2", mark="^", label=f"{self.up.name} rises")
        self.down.draw(ax, colour="#009e73", mark="v", label=f"{self.down.name} falls")
        failed = self.up.failed + self.down.failed
        words = f"; {failed} runs failed (dotted)" if failed else ""
        ax.set_title(f"{np.sum(self.apart)} of {len(self.up.values)} values have two motions{words}", fontsize=10)
        beside(ax)
        return ax


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
    """Follow a motion through rising values of a parameter, and through falling ones, and look once a period.

    At the first value either way the system starts as it is placed.  At each other one the motion goes on from that of
    its neighbour, where least is closed; what is closed there stays so, and what would overlap touches.  Behind a run
    that failed the next one starts as the system is placed.

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
        If a number is not valid.
    """
    row = np.unique(floats("hysteresis: values", values))

    def looks(value: float) -> Looks:
        return Looks(period_at(period, value, "hysteresis: period"), coordinate, at, settle, keep, "hysteresis")

    family = Family.of(what, EventDriven())
    _ = family[name]
    if not len(row):
        raise InvalidInput(f"values of {name}", "must be some", [], "Give at least one.")
    unit, scale = looks(family[name]).unit_and_scale(family.model())
    points, failures = np.full((2, len(row), keep), np.nan), np.full((2, len(row)), "", dtype=object)
    upwards = range(len(row))
    with Pace(display_of(display)) as pace:
        counted = RunsDone(pace, 2 * len(row))
        for way, order in enumerate((upwards, reversed(upwards))):
            before: tuple[Model, State, float] | None = None
            for i in order:
                try:
                    model = family.model(**{name: float(row[i])})
                    look = looks(float(row[i]))
                    start = model.start if before is None else _carried(model, look.period, *before)
                    points[way, i], end = look.settled(model, start)
                    before = model, end, look.period
                except (RunFailed, InvalidInput) as error:
                    failures[way, i], before = str(error), None
                counted.add(1, bool(failures[way, i]))
    up, down = (
        Diagram(
            name, family.label(name), row, coordinate, unit, points[way], tuple(map(str, failures[way].tolist())), scale
        )
        for way in (0, 1)
    )
    return Hysteresis(up, down)


def _carried(model: Model, period: float, last: Model, state: State, last_period: float) -> State:
    """Return where a motion of another model continues in a model, at the same phase of the first period."""
    there = chosen(last, state, last_period)
    there = replace(there, time=there.time % last_period * (period / last_period))
    # what flew so low that it is reached by what moves otherwise now is taken along
    reached = (model.contact_rates(there)[0] < 0.0) & (there.modes == Mode.OPEN)
    there = replace(there, modes=np.where(reached, Mode.SLIDE, there.modes))
    return Chart.at(model, there).held_in(model, there)
