"""Figs. 3 and 6: velocities of ball 1 at its lowest point, A in the paper, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from scenarios.dumbbell.figures import style
from scenarios.dumbbell.figures.trace import Trace

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def tangential_velocity(trace: Trace, title: str) -> Figure:
    """Draw the slip velocity of ball 1 along the rod's first direction (y) and mark the double impacts."""
    figure, axes = style.new_figure(title, style.footnote(trace.scenario))
    axis = axes[0]
    slip = 1e3 * trace.slip[:, 1]
    double = np.flatnonzero(trace.struck.all(axis=1))
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    for begin, end in _stretches(trace.touching[:, 0]):
        axis.axvspan(trace.clock[begin], trace.clock[end], color="0.9", linewidth=0.0)
    axis.axvspan(0.0, 0.0, color="0.9", label="ball 1 on the plate")
    axis.plot(trace.clock, slip, label="slip velocity of ball 1, along y", **style.CURVE)
    axis.plot(trace.clock[double + 1], slip[double + 1], label="after a double impact", **style.IMPACT)
    axis.set_xlabel(f"time since t = {trace.t[0]:.3f} s [ms]")
    axis.set_ylabel("slip velocity of ball 1 [mm/s]")
    axis.margins(x=0.01)
    style.legend(axes)
    return figure


def normal_velocity(trace: Trace, title: str) -> Figure:
    """Draw the rate of the gap of ball 1 and mark the impacts of either ball."""
    figure, axes = style.new_figure(title, style.footnote(trace.scenario))
    axis = axes[0]
    rate = trace.u[:, 2] - trace.scenario.plate_velocity(trace.t)
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    axis.plot(trace.clock, rate, label="gap rate of ball 1", **style.CURVE)
    own = np.flatnonzero(trace.struck[:, 0])
    other = np.flatnonzero(trace.struck[:, 1] & ~trace.struck[:, 0])
    axis.plot(trace.clock[own + 1], rate[own + 1], label="after an impact of ball 1", **style.IMPACT)
    axis.plot(
        trace.clock[other + 1],
        rate[other + 1],
        label="after an impact of ball 2",
        **(style.IMPACT | {"color": "tab:blue", "marker": "s"}),
    )
    axis.set_xlabel(f"time since t = {trace.t[0]:.3f} s [ms]")
    axis.set_ylabel("normal velocity of ball 1 relative to the plate [m/s]")
    axis.margins(x=0.01)
    style.legend(axes)
    return figure


def _stretches(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return begin and end of every run of true flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags[:-1], [False]]).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
