"""Itinerary diagrams: the phase of each event in its period.

A diagram has one row for each value of a parameter, or, for a single run, one row for each of its periods.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.charts import COLOURS, verbatim
from nonsmooth.checks import floats, is_finite
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.plot.arguments import axes_of
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import Signature, completed, events_of, named
from nonsmooth.studies.inputs import check_periods
from nonsmooth.studies.orbits.scan import Period, check_period, period_at, scan
from nonsmooth.studies.plotting import finish
from nonsmooth.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FILLS = COLOURS[1:]
_HATCHES = ("", "////", "....", "xxxx")
_KINDS = len(_FILLS) * len(_HATCHES)
"""Number of kinds of events that a picture distinguishes; all rarer kinds have the colour and hatch of the last one."""


@final
@dataclass(frozen=True)
class Itinerary:
    """The events of some periods.

    Attributes
    ----------
    at : array
        Times of the events, in periods since the start of the first of these periods, shape [n].  If ``at[0]`` is
        negative, it is the time of the last event before this start.
    events : Signature
        Cause and contact of each event.
    """

    at: Array
    events: Signature


@final
@dataclass(frozen=True)
class ItineraryDiagram:
    """Events over the phase of a period: a row for each value of a parameter, or for each period of a run.

    Attributes
    ----------
    label : str
        The parameter with its unit.
    values : array
        Value of the parameter, or number of the period, in each row, shape [n].
    keep : int
        Number of periods in each row.
    rows : tuple of Itinerary
        The events of each row.
    words : mapping
        Words for each kind of event, by its cause and contact, the most frequent first.
    failures : tuple of str
        Reasons of failures, "" for a run that succeeded.
    """

    label: str
    values: Array
    keep: int
    rows: tuple[Itinerary, ...]
    words: dict[tuple[int, int], str]
    failures: tuple[str, ...]

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw a row for each value or period, on given axes or in a new figure.

        The colour at each phase shows the last event before this phase.  Strokes show the events.
        """
        from matplotlib.patches import Patch

        ax, edges, kinds = axes_of(ax, 4.2), _edges(self.values), list(self.words)
        for row, low, high in zip(self.rows, edges[:-1], edges[1:], strict=True):
            ends = np.append(row.at[1:], self.keep) if len(row.at) else row.at
            for place, kind in enumerate(kinds):
                spans = [
                    (max(0.0, begin), end - max(0.0, begin))
                    for begin, end, event in zip(row.at.tolist(), ends.tolist(), row.events, strict=True)
                    if event == kind
                ]
                ax.broken_barh(spans, (low, high - low), linewidth=0.0, **_fill(place))
            ax.vlines(row.at[row.at >= 0.0], low, high, color="black", linewidth=0.5)
        ax.set_xlim(0.0, self.keep)
        ax.set_ylim(edges[0], edges[-1])
        ax.locator_params(axis="y", integer=bool(np.all(self.values % 1.0 == 0.0)))
        failed = sum(map(bool, self.failures))
        words = f"; {failed} of {len(self.values)} runs failed (white)" if failed else ""
        names = [verbatim(self.words[kind].replace(" of '", "\nof '")) for kind in kinds]
        entries = [Patch(label=name, **_fill(place)) for place, name in enumerate(names)]
        title = f"Colours: the last event; strokes: events{words}"
        return finish(ax, "phase of the period [1]", self.label, title, grid="", legend=entries)


def itinerary_diagram(
    what: Varied,
    name: str,
    values: ArrayLike,
    period: Period,
    *,
    settle: int = 200,
    keep: int = 1,
    display: Display | None = None,
) -> ItineraryDiagram:
    """Record the events of the last periods for each value of a parameter.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; each run starts as it is placed.
    name : str
        Name of the parameter.
    values : array
        Values of the parameter, rising, shape [n].
    period : float or callable
        Period of the drive, or a multiple [s]; ``period(value)`` if the parameter changes it.  A run fails if the drive
        has another period at its value.
    settle : int
        Number of periods of the transient, which are not recorded.
    keep : int
        Number of periods that are recorded.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If the system has no parameter of this name.
    InvalidInput
        If an argument is not valid, or the runs at all values are refused.
    """
    thing = "itinerary_diagram: period"
    column = np.atleast_1d(floats("itinerary_diagram: values", values))
    if not (len(column) and np.all(np.diff(column) > 0.0)):
        raise InvalidInput("itinerary_diagram: values", "must rise", column.tolist(), "Sort them.")
    check_periods("itinerary_diagram", settle=settle, keep=keep)
    family = Family.of(what, EventDriven())
    _ = period_at(period, family[name], thing)

    def row(model: Model, value: float) -> Itinerary:
        lasts = period_at(period, value, thing)
        run = completed(model.run((settle + keep) * lasts, sample_interval=lasts))
        check_period(model, run.state, lasts, thing)
        return _row(run, lasts, settle, keep)

    rows, failures = scan(family, name, column.tolist(), row, Itinerary(np.empty(0), ()), display)
    return ItineraryDiagram(family.label(name), column, keep, tuple(rows), _words(rows, family.model()), failures)


def itinerary_of_run(model: Model, run: Solution, period: float) -> ItineraryDiagram:
    """Return the events of a run, in a row for each whole period [s] of it.

    Raises
    ------
    InvalidInput
        If the period is not positive, or longer than the run.
    """
    n = int(run.t_end / period * (1.0 + 1e-12)) if is_finite(period) and period > 0.0 else 0
    if n < 1:
        rule = f"must be positive, and not longer than the run of {run.t_end:.9g} s"
        raise InvalidInput("itinerary_of_run: period", rule, period, "Give it in [s].")
    rows = [_row(run, period, i, 1) for i in range(n)]
    values, words = np.arange(1.0, n + 1.0), _words(rows, model)
    return ItineraryDiagram("number of the period", values, 1, tuple(rows), words, ("",) * n)


def _row(run: Solution, period: float, first: int, keep: int) -> Itinerary:
    """Return the events of ``keep`` periods of a run, from period ``first`` on, and the last event before them.

    This earlier event comes first.  It gives the colour at the start of the row in a diagram.
    """
    times, events = events_of(run)
    at = times / period - first
    begin, end = max(0, int(np.searchsorted(at, 0.0)) - 1), int(np.searchsorted(at, keep))
    return Itinerary(at[begin:end], events[begin:end])


def _words(rows: Sequence[Itinerary], model: Model) -> dict[tuple[int, int], str]:
    counted = Counter(event for row in rows for event in row.events)
    return {kind: named((kind,), model) for kind, _ in counted.most_common()}


def _edges(values: Array) -> Array:
    """Return the bounds of rows about values, halfway between neighbours."""
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2.0 * values[0] - middle[0]], middle, [2.0 * values[-1] - middle[-1]]])


def _fill(place: int) -> dict[str, Any]:
    turn, which = divmod(min(place, _KINDS - 1), len(_FILLS))
    return {"facecolor": _FILLS[which], "hatch": _HATCHES[turn], "edgecolor": "white"}
