"""Figs. 2, 4, 5, 7: heights of both balls and the plate over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from scenarios.dumbbell.figures import style
from scenarios.dumbbell.figures.trace import Trace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CIRCLES_PER_PERIOD = 20


def normal_motion(trace: Trace, title: str) -> Figure:
    """Draw the lowest points of the balls and the plate; ball 1 touches the plate where its circles lie on it."""
    figure, axes = style.new_figure(title, style.footnote(trace.scenario))
    axis = axes[0]
    heights, plate = 1e3 * trace.heights, 1e3 * trace.scenario.plate_height(trace.t)
    circles = np.arange(0.0, trace.clock[-1], 1e3 / (trace.scenario.frequency * _CIRCLES_PER_PERIOD))
    axis.plot(trace.clock, plate, label="plate", zorder=3, **style.PLATE)
    axis.plot(trace.clock, heights[:, 1], label="ball 2", **style.BALL_2)
    axis.plot(circles, np.interp(circles, trace.clock, heights[:, 0]), label="ball 1", **style.BALL_1)
    axis.set_xlabel(f"time since t = {trace.t[0]:.3f} s [ms]")
    axis.set_ylabel("height of the lowest point [mm]")
    axis.margins(x=0.01)
    style.legend(axes)
    return figure
