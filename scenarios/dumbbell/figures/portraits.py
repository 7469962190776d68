"""Figs. 8 to 10: phase portraits of theta, beta and gamma, with the paper's marks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from scenarios.dumbbell.coordinates import NAMES
from scenarios.dumbbell.figures import style
from scenarios.dumbbell.figures.trace import Trace

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_SYMBOL = {"theta": "θ", "beta": "β", "gamma": "\N{GREEK SMALL LETTER GAMMA}"}
_TURN = 1e-9
"""Angle [rad] and rate [rad/s] below which nothing turns."""
_ARROWS = 4
_JUMP: dict[str, Any] = {"color": "0.5", "linestyle": ":", "linewidth": 1.0}
_DIAMOND = style.IMPACT | {"marker": "D"}
_CIRCLE = style.IMPACT | {"color": "black"}
_BEFORE_1: dict[str, Any] = {"color": "tab:red", "linestyle": "-", "linewidth": 1.3}
_BEFORE_2: dict[str, Any] = {"color": "black", "linestyle": "--", "linewidth": 1.3}


def turns(angle: str, trace: Trace) -> bool:
    """Tell whether an angle changes at all: a portrait of one that does not is a point."""
    column = NAMES.index(angle)
    return bool(max(np.ptp(trace.q[:, column]), np.ptp(trace.u[:, column])) >= _TURN)


def portrait(angle: str, traces: Mapping[str, Trace], title: str) -> Figure:
    """Draw rate over angle, one panel per mode."""
    note = style.footnote(*(trace.scenario for trace in traces.values()))
    figure, axes = style.new_figure(title, note, len(traces), width=max(8.6, 3.7 * len(traces)), height=5.2)
    column = NAMES.index(angle)
    for axis, (mode, trace) in zip(axes, traces.items(), strict=True):
        x, y = trace.q[:, column], trace.u[:, column]
        _DRAW.get(mode, _drift)(axis, trace, x, y)
        _arrows(axis, x, y, trace)
        axis.set_title(mode, fontsize=10)
        axis.set_xlabel(f"{_SYMBOL[angle]} [rad]")
        axis.tick_params(labelsize=8)
        axis.locator_params(axis="x", nbins=5)
    axes[0].set_ylabel(f"d{_SYMBOL[angle]}/dt [rad/s]")
    style.legend(axes)
    return figure


def _drift(axis: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Black: free flight; blue, dashed: one ball on the plate; dotted: impacts, red circles at double ones."""
    double, hit = _struck(trace)
    standing = np.asarray(trace.touching.any(axis=1)) & ~hit
    _steps(axis, x, y, ~standing & ~hit, "free flight", style.CURVE)
    _steps(axis, x, y, hit & ~double, "change in an impact", _JUMP)
    _steps(axis, x, y, standing, "single contact", style.OTHER)
    _marks(axis, x, y, double, "double impact", style.IMPACT)


def _jump(axis: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Black: flight; red circles: double impacts; diamonds and black circles: single ones."""
    double, hit = _struck(trace)
    _steps(axis, x, y, ~hit, "free flight", style.CURVE)
    _marks(axis, x, y, double, "double impact", style.IMPACT)
    _marks(axis, x, y, trace.struck[:, 0] & ~double, "single impact of ball 1", _DIAMOND)
    _marks(axis, x, y, trace.struck[:, 1] & ~double, "single impact of ball 2", _CIRCLE)


def _flutter(axis: Axes, trace: Trace, x: Floats, y: Floats) -> None:
    """Red: flight before an impact of ball 1 (diamond); black, dashed: flight before one of ball 2 (circle)."""
    _, hit = _struck(trace)
    hits = np.flatnonzero(hit)
    following = np.searchsorted(hits, np.arange(len(x)))
    known = following < len(hits)
    first = known & trace.struck[hits[np.minimum(following, len(hits) - 1)], 0] if len(hits) else known
    _steps(axis, x, y, ~hit & known & first, "free flight before ball 1 strikes", _BEFORE_1)
    _steps(axis, x, y, ~hit & known & ~first, "free flight before ball 2 strikes", _BEFORE_2)
    _marks(axis, x, y, trace.struck[:, 0], "single impact of ball 1", _DIAMOND)
    _marks(axis, x, y, trace.struck[:, 1], "single impact of ball 2", _CIRCLE)


_DRAW = {"drift": _drift, "jump": _jump, "flutter": _flutter}


def _struck(trace: Trace) -> tuple[Flags, Flags]:
    """Return which steps are double impacts, and which are impacts at all."""
    return np.asarray(trace.struck.all(axis=1)), np.asarray(trace.struck.any(axis=1))


def _steps(axis: Axes, x: Floats, y: Floats, chosen: Flags, label: str, look: dict[str, Any]) -> None:
    """Draw the ways from the chosen points to their next ones, joined where they follow each other."""
    index = np.flatnonzero(chosen[:-1])
    if not len(index):
        return
    pieces = np.split(index, np.flatnonzero(np.diff(index) > 1) + 1)
    gap = np.array([np.nan])
    line_x = np.concatenate([part for piece in pieces for part in (x[piece], x[piece[-1:] + 1], gap)])
    line_y = np.concatenate([part for piece in pieces for part in (y[piece], y[piece[-1:] + 1], gap)])
    axis.plot(line_x, line_y, label=label, **look)


def _marks(axis: Axes, x: Floats, y: Floats, chosen: Flags, label: str, look: dict[str, Any]) -> None:
    """Mark the states before and after the chosen jumps and join them."""
    index = np.flatnonzero(chosen[:-1])
    if not len(index):
        return
    _steps(axis, x, y, chosen, "change in an impact", _JUMP)
    axis.plot(x[index + 1], y[index + 1], label=label, **look)
    axis.plot(x[index], y[index], **look)


def _arrows(axis: Axes, x: Floats, y: Floats, trace: Trace) -> None:
    """Show the sense of time on the first smooth ways."""
    smooth = np.flatnonzero(~_struck(trace)[1][:-1] & (np.diff(trace.t) > 0.0))
    for i in smooth[np.linspace(0, len(smooth) - 1, _ARROWS + 2).astype(int)[1:-1]]:
        axis.annotate(
            "",
            (x[i + 1], y[i + 1]),
            (x[i], y[i]),
            arrowprops={"arrowstyle": "-|>", "color": "0.2", "shrinkA": 0, "shrinkB": 0},
        )
