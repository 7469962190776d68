"""Bifurcation diagrams: where a motion is once a period, over a parameter, after it has settled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import floats
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.plot.arguments import axes_of
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.orbits.each import of_each
from nonsmooth.studies.orbits.looks import Looks
from nonsmooth.studies.orbits.repeating import Period, period_at
from nonsmooth.studies.periods import alike, periods, settling

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Diagram:
    """A bifurcation diagram.

    Attributes
    ----------
    name, label : str
        The parameter, and the same with its unit.
    values : array
        Its values, shape [n].
    coordinate, unit : str
        What is looked at once a period, and its unit.
    points : array
        What it was, the last ``keep`` times; nan where a run failed; shape [n, keep].
    failures : tuple of str
        Why runs failed, "" for those that did not.
    scale : float
        Of the coordinate, by the size of its body, in its unit.
    """

    name: str
    label: str
    values: Floats
    coordinate: str
    unit: str
    points: Floats
    failures: tuple[str, ...]
    scale: float

    @property
    def periods(self) -> NDArray[np.int64]:
        """After how many periods the motion repeats, shape [n].

        0 where it does not within those that were kept; -1 where the run failed.
        """
        found = periods(self.points[:, :, np.newaxis], alike(self.points, self.scale))
        return np.where([bool(text) for text in self.failures], -1, found)

    @property
    def settling(self) -> NDArray[np.bool_]:
        """Whether the motion still settles in the periods that were kept, shape [n]; a longer ``settle`` helps."""
        return settling(self.points[:, :, np.newaxis], alike(self.points, self.scale))

    @property
    def failed(self) -> int:
        """How many runs failed."""
        return sum(bool(text) for text in self.failures)

    def draw(self, ax: Axes | None = None, *, colour: str = "black", mark: str = ".", label: str | None = None) -> Axes:
        """Draw it: all points over the parameter; failed runs have dotted lines, motions that settle grey ones.

        Parameters
        ----------
        ax : Axes, optional
            Where, a branch of orbits may be there already; a new figure by default.
        colour, mark : str
            Of the points.
        label : str, optional
            What they are called in a legend.

        Returns
        -------
        Axes
            The axes.
        """
        ax = axes_of(ax)
        over = np.repeat(self.values, self.points.shape[1])
        ax.plot(over, self.points.ravel(), mark, markersize=2.0, color=colour, fillstyle="none", label=label)
        ax.set_xlabel(self.label)
        ax.locator_params(axis="x", nbins=6)  # labels of eight characters fit
        ax.set_ylabel(f"{self.coordinate}, once a period [{self.unit}]")
        for value, text in zip(self.values.tolist(), self.failures, strict=True):
            if text:
                ax.axvline(value, color="#d55e00", linewidth=0.8, linestyle=":")
        counts = {"runs failed (dotted)": self.failed, "still settle (grey)": int(np.sum(self.settling))}
        for value in self.values[self.settling].tolist():
            ax.axvline(value, color="0.8", linewidth=0.8, zorder=0)
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
    """Run a system with each value of a parameter, and look once a period.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; each run starts as it is placed.
    name : str
        The parameter.
    values : array
        Its values, shape [n].
    period : float or callable
        Of the drive, or a multiple [s]; ``period(value)`` if the parameter changes it.  A run at a value at which the
        drive has another period counts as failed.
    coordinate : str
        Which coordinate or velocity is looked at, "vz" or "ball.vz".
    at : float
        When in each period it is looked at [s]: where no velocity jumps, or points lie on either side of it.
    settle, keep : int
        Periods that are left out, and those that are kept.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If there is no such parameter or coordinate.
    InvalidInput
        If a number is not valid, or no value makes a system.
    """
    row = np.atleast_1d(floats("bifurcation: values", values))

    def looks(value: float) -> Looks:
        return Looks(period_at(period, value, "bifurcation: period"), coordinate, at, settle, keep, "bifurcation")

    family = Family.of(what, EventDriven())
    _ = family[name]
    unit, scale = looks(family[name]).unit_and_scale(family.model())

    def points_of(model: Model, value: float) -> Floats:
        return looks(value).settled(model, model.start)[0]

    points, failures = of_each(family, name, row.tolist(), points_of, np.full(keep, np.nan), display)
    return Diagram(name, family.label(name), row, coordinate, unit, np.array(points), failures, scale)
