"""Draws Figs. 8 to 10 of the paper: phase portraits of theta, beta and gamma, with the paper's marks at impacts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth import charts

from .coordinates import NAMES
from .trace import Flags, Floats, Trace, note

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SYMBOLS: Mapping[str, str] = {"theta": "θ", "beta": "β", "gamma": "\N{GREEK SMALL LETTER GAMMA}"}
_STEMS: Mapping[str, str] = {"theta": "fig08_theta", "beta": "fig09_beta", "gamma": "fig10_gamma"}
_STATEMENTS: Mapping[str, str] = {
    "theta": "the heading: drift turns about the vertical, flutter swings; jump, not shown, does not turn",
    "beta": "the tilt: closed, as the normal motion is periodic; jump, not shown, stays level",
    "gamma": "the roll: open in all three modes, the dumbbell rolls along",
}
"""Angle -> statement in the title of its phase portrait, if the figure has a panel for each mode of the paper.

Modes in which the angle does not change have no panel.
"""
_TURN = 1e-9
"""Range of an angle [rad] and of its rate [rad/s] below which the angle is treated as constant."""

IMPACT: dict[str, Any] = {"color": "tab:red", "linestyle": "none", "marker": "o", "fillstyle": "none", "markersize": 6}
_DIAMOND = IMPACT | {"marker": "D"}
_CIRCLE = IMPACT | {"color": "black"}
_FLIGHT: dict[str, Any] = {"color": "black", "linestyle": "-", "linewidth": 1.3}
CONTACT: dict[str, Any] = {"color": "tab:blue", "linestyle": "--", "linewidth": 1.6}
_JUMP: dict[str, Any] = {"color": "0.5", "linestyle": ":", "linewidth": 1.0}


def portraits(traces: Mapping[str, Trace], angles: Sequence[str], ends: str = "") -> dict[str, Figure]:
    """Draw rate over angle, a figure for each angle and a panel for each trace in which it changes.

    The title of figures with several traces states the results of the paper, or ``ends`` if it is given: the
    attractors of runs with other parameters.
    """
    figures = {}
    for angle in angles:
        column = NAMES.index(angle)
        turning = {mode: trace for mode, trace in traces.items() if _turns(trace, column)}
        title = f"Phase portrait of {angle} at the end of the run"
        if len(traces) > 1:
            title = f"Phase portraits of {angle}" + (f"\n{ends}" if ends else f",\n{_STATEMENTS[angle]}")
        if turning:
            figures[_STEMS[angle]] = _portrait(turning, column, _SYMBOLS[angle], title)
    return figures


def left_out(drawn: Mapping[str, Figure], angles: Sequence[str]) -> list[str]:
    """Return the file names of the portraits that :func:`portraits` has not drawn."""
    return [_STEMS[angle] for angle in angles if _STEMS[angle] not in drawn]


def _turns(trace: Trace, column: int) -> bool:
    return bool(max(np.ptp(trace.motion.q[:, column]), np.ptp(trace.motion.u[:, column])) >= _TURN)


def _portrait(traces: Mapping[str, Trace], column: int, symbol: str, title: str) -> Figure:
    figure, axes = charts.panels(1, len(traces), title, (max(8.6, 3.7 * len(traces)), 5.2))
    for ax, (mode, trace) in zip(axes, traces.items(), strict=True):
        x, y = trace.motion.q[:, column], trace.motion.u[:, column]
        # without impacts the motion is not the one that the mode names
        draw = _MODES[mode] if mode in _MODES and trace.struck.any() else _draw_drift
        draw(ax, trace, x, y)
        _arrows(ax, x, y, trace)
        ax.set_title(mode, fontsize=10)
        ax.set_xlabel(f"{symbol} [rad]")
        ax.tick_params(labelsize=8)
        ax.locator_params(axis="x", nbins=5)
    axes[0].set_ylabel(f"d{symbol}/dt [rad/s]")
    charts.legend(figure, note=note(*(trace.scenario for trace in traces.values())))
    return figure


def _draw_drift(ax: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Draw a drift: free flight black, one ball on the plate blue and dashed, changes in impacts dotted.

    Red circles mark the states before and after double impacts.
    """
    double, hit = _struck(trace)
    standing = np.asarray(trace.touching.any(axis=1)) & ~hit
    _steps(ax, x, y, ~standing & ~hit, "free flight", _FLIGHT)
    _steps(ax, x, y, hit & ~double, "change in an impact", _JUMP)
    _steps(ax, x, y, standing, "single contact", CONTACT)
    _marks(ax, x, y, double, "double impact", IMPACT)


def _draw_jump(ax: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Draw a jump: free flight black, double impacts as red circles, single impacts of ball 1 as red diamonds.

    Single impacts of ball 2 are black circles.
    """
    double, hit = _struck(trace)
    _steps(ax, x, y, ~hit, "free flight", _FLIGHT)
    _marks(ax, x, y, double, "double impact", IMPACT)
    _marks(ax, x, y, trace.struck[:, 0] & ~double, "single impact of ball 1", _DIAMOND)
    _marks(ax, x, y, trace.struck[:, 1] & ~double, "single impact of ball 2", _CIRCLE)


def _draw_flutter(ax: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Draw flutter: the flight before each impact of ball 1 red, the flight before each impact of ball 2 black, dashed.

    Impacts of ball 1 are red diamonds, impacts of ball 2 black circles.
    """
    hit = _struck(trace)[1]
    hits = np.flatnonzero(hit)
    following = np.searchsorted(hits, np.arange(len(x)))
    known = following < len(hits)
    first = known & trace.struck[hits[np.minimum(following, len(hits) - 1)], 0] if len(hits) else known
    _steps(ax, x, y, ~hit & known & first, "free flight before ball 1 strikes", _FLIGHT | {"color": "tab:red"})
    _steps(ax, x, y, ~hit & known & ~first, "free flight before ball 2 strikes", _FLIGHT | {"linestyle": "--"})
    _marks(ax, x, y, trace.struck[:, 0], "single impact of ball 1", _DIAMOND)
    _marks(ax, x, y, trace.struck[:, 1], "single impact of ball 2", _CIRCLE)


_MODES = {"drift": _draw_drift, "jump": _draw_jump, "flutter": _draw_flutter}


def _struck(trace: Trace) -> tuple[Flags, Flags]:
    """Return which steps are double impacts, and which are single or double impacts."""
    return np.asarray(trace.struck.all(axis=1)), np.asarray(trace.struck.any(axis=1))


def _steps(ax: Axes, x: Floats, y: Floats, chosen: Flags, label: str, style: dict[str, Any]) -> None:
    """Draw the lines from each chosen point to the next point."""
    index = np.flatnonzero(chosen[:-1])
    if len(index):
        pieces = np.split(index, np.flatnonzero(np.diff(index) > 1) + 1)
        # the line of a piece also has the point after the last chosen point; -1 becomes nan, which interrupts the line
        points = np.concatenate([np.append(piece, [piece[-1] + 1, -1]) for piece in pieces])
        ax.plot(*(np.where(points < 0, np.nan, values[points]) for values in (x, y)), label=label, **style)


def _marks(ax: Axes, x: Floats, y: Floats, chosen: Flags, label: str, style: dict[str, Any]) -> None:
    """Mark the states before and after the chosen jumps and join them."""
    index = np.flatnonzero(chosen[:-1])
    if len(index):
        _steps(ax, x, y, chosen, "change in an impact", _JUMP)
        ax.plot(x[index + 1], y[index + 1], label=label, **style)
        ax.plot(x[index], y[index], **style)


def _arrows(ax: Axes, x: Floats, y: Floats, trace: Trace) -> None:
    """Draw four arrowheads on the curve, in the sense of time."""
    smooth = np.flatnonzero(~_struck(trace)[1][:-1] & (np.diff(trace.motion.t) > 0.0))
    head = {"arrowstyle": "-|>", "color": "0.2", "shrinkA": 0, "shrinkB": 0}
    for i in smooth[np.linspace(0, len(smooth) - 1, 6).astype(int)[1:-1]]:
        ax.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops=head)
