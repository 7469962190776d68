"""Where the slider is in its guide."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.slider_crank.scenario import SliderCrank

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def heights(runs: Mapping[str, tuple[SliderCrank, Solution]], title: str) -> Figure:
    """Draw the slider's height over the turns of the crank, one panel per law."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 1.2 + 2.1 * len(runs)), layout="constrained")
    axes = figure.subplots(len(runs), sharex=True, squeeze=False)[:, 0]
    for axis, (law, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        c = 1e3 * scenario.clearance
        turns = solution.q[:, 0] / (2.0 * np.pi)
        axis.axhspan(c, 1.15 * c, color="0.8", linewidth=0.0)
        axis.axhspan(-1.15 * c, -c, color="0.8", linewidth=0.0)
        axis.plot(turns, 1e3 * scenario.height(solution), color="black", linewidth=1.1)
        axis.set_ylim(-1.15 * c, 1.15 * c)
        axis.set_title(f"impact law {law!r}", fontsize=9, loc="right")
        axis.set_ylabel("height of the slider [mm]")
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[-1].set_xlabel("turns of the crank")
    figure.suptitle(title, fontsize=11)
    return figure
