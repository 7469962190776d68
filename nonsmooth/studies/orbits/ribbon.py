"""Signature ribbons: which events follow one another, period by period or over a parameter."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.charts import COLOURS
from nonsmooth.checks import floats, is_finite
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.plot.arguments import axes_of
from nonsmooth.plot.lines import beside
from nonsmooth.progress import Display
from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.passage import Signature, named
from nonsmooth.studies.orbits.each import of_each
from nonsmooth.studies.orbits.repeating import Period, check_counts, check_period, period_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
_FILLS = COLOURS[1:]
_HATCHES = ("", "////", "....", "xxxx")
_KINDS = len(_FILLS) * len(_HATCHES)
"""Kinds of events that are told apart; the rest looks like the last of them."""


@final
@dataclass(frozen=True)
class Row:
    """The events of some periods.

    Attributes
    ----------
    at : array
        When they were, in periods from the first one's begin, shape [n]; the first may be earlier than 0.
    events : Signature
        Cause and contact of each.
    """

    at: Floats
    events: Signature


@final
@dataclass(frozen=True)
class Ribbon:
    """Events over the phase of a period, in a row for each value of a parameter, or for each period of a run.

    Attributes
    ----------
    label : str
        What the rows are of.
    values : array
        What each is of, shape [n].
    keep : int
        Periods of each row.
    rows : tuple of Row
        The events.
    words : mapping
        Kinds of events by cause and contact, in words, the most frequent first.
    failures : tuple of str
        Why runs failed, "" for those that did not.
    """

    label: str
    values: Floats
    keep: int
    rows: tuple[Row, ...]
    words: dict[tuple[int, int], str]
    failures: tuple[str, ...]

    def draw(self, ax: Axes | None = None) -> Axes:
        """Draw it: from each event to the next one in the colour of its cause and contact, with strokes at events."""
        from matplotlib.patches import Patch

        ax = axes_of(ax, 4.2)
        edges = _edges(self.values)
        kinds = list(self.words)
        for row, low, high in zip(self.rows, edges[:-1], edges[1:], strict=True):
            ends = np.append(row.at[1:], self.keep) if len(row.at) else row.at
            for place, kind in enumerate(kinds):
                spans = [
                    (max(0.0, begin), end - max(0.0, begin))
                    for begin, end, event in zip(row.at.tolist(), ends.tolist(), row.events, strict=True)
                    if event == kind
                ]
                ax.broken_barh(spans, (low, high - low), linewidth=0.0, **_look(place))
            strokes = row.at[row.at >= 0.0]
            ax.vlines(strokes, low, high, color="black", linewidth=0.5)
        ax.set_xlim(0.0, self.keep)
        ax.set_ylim(edges[0], edges[-1])
        ax.locator_params(axis="y", integer=bool(np.all(self.values % 1.0 == 0.0)))
        ax.set_xlabel("phase of the period [1]")
        ax.set_ylabel(self.label)
        failed = sum(map(bool, self.failures))
        told = f"; {failed} of {len(self.values)} runs failed (white)" if failed else ""
        ax.set_title(f"What happened last; strokes: events{told}", fontsize=10)
        words = [self.words[kind].replace(" of '", "\nof '") for kind in kinds]
        beside(ax, handles=[Patch(label=word, **_look(place)) for place, word in enumerate(words)])
        return ax


def ribbon(
    what: Varied,
    name: str,
    values: ArrayLike,
    period: Period,
    *,
    settle: int = 200,
    keep: int = 1,
    display: Display | None = None,
) -> Ribbon:
    """Run a system with each value of a parameter, and keep the events of the last periods.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; each run starts as it is placed.
    name : str
        The parameter.
    values : array
        Its values, rising, shape [n].
    period : float or callable
        Of the drive, or a multiple [s]; ``period(value)`` if the parameter changes it.  A run at a value at which the
        drive has another period counts as failed.
    settle, keep : int
        Periods that are left out, and those that are kept.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If there is no such parameter.
    InvalidInput
        If a number is not valid, or no value makes a system.
    """
    column = np.atleast_1d(floats("ribbon: values", values))
    if not (len(column) and np.all(np.diff(column) > 0.0)):
        raise InvalidInput("ribbon: values", "must rise", column.tolist(), "Sort them.")
    check_counts("ribbon", settle=settle, keep=keep)
    family = Family.of(what, EventDriven())
    _ = period_at(period, family[name], "ribbon: period")

    def row(model: Model, value: float) -> Row:
        lasts = period_at(period, value, "ribbon: period")
        run = model.run((settle + keep) * lasts, sample_interval=lasts)
        if run.status == "interrupted":
            raise KeyboardInterrupt
        check_period(model, run.state, lasts, "ribbon: period")
        return _row(run, lasts, settle, keep)

    rows, failures = of_each(family, name, column.tolist(), row, Row(np.empty(0), ()), display)
    return Ribbon(family.label(name), column, keep, tuple(rows), _words(rows, family.model()), failures)


def periods(model: Model, run: Solution, period: float) -> Ribbon:
    """Return the events of a run, in a row for each whole period [s] of it.

    Raises
    ------
    InvalidInput
        If the run is shorter than a period.
    """
    n = int(run.t_end / period * (1.0 + 1e-12)) if is_finite(period) and period > 0.0 else 0
    if n < 1:
        rule = f"must be positive, and not longer than the run of {run.t_end:.9g} s"
        raise InvalidInput("periods: period", rule, period, "Give it in [s].")
    rows = [_row(run, period, i, 1) for i in range(n)]
    return Ribbon("number of the period", np.arange(1.0, n + 1.0), 1, tuple(rows), _words(rows, model), ("",) * n)


def _row(run: Solution, period: float, first: int, keep: int) -> Row:
    """Return the events of some periods, and the last one before them, which colours their begin."""
    events = run.events
    kept = events.cause != Cause.START
    at = events.time[kept] / period - first
    told = list(zip(events.cause[kept].tolist(), events.contact[kept].tolist(), strict=True))
    begin, end = max(0, int(np.searchsorted(at, 0.0)) - 1), int(np.searchsorted(at, keep))
    return Row(at[begin:end], tuple(told[begin:end]))


def _words(rows: list[Row], model: Model) -> dict[tuple[int, int], str]:
    counted = Counter(event for row in rows for event in row.events)
    return {kind: named((kind,), model) for kind, _ in counted.most_common()}


def _edges(values: Floats) -> Floats:
    """Return the bounds of rows about values, halfway between neighbours."""
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2.0 * values[0] - middle[0]], middle, [2.0 * values[-1] - middle[-1]]])


def _look(place: int) -> dict[str, Any]:
    turn, which = divmod(min(place, _KINDS - 1), len(_FILLS))
    return {"facecolor": _FILLS[which], "hatch": _HATCHES[turn], "edgecolor": "white"}
