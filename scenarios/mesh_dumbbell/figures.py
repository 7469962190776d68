"""The gaps of dumbbells out of meshes beside those of the one with balls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.mesh_dumbbell.scenario import MeshDumbbell

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = ({"color": "#d55e00", "linestyle": "--"}, {"color": "#0072b2", "linestyle": "-"})


def gaps(runs: Sequence[tuple[MeshDumbbell, Solution]], beside: Solution) -> Figure:
    """Draw the gaps of both balls, and by how much that of ball 2 differs, over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.4), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    exact = runs[0][0].gaps(beside.t, beside.q, meshes=False)
    for ball in range(2):
        axes[ball].plot(1e3 * beside.t, 1e3 * exact[:, ball], color="0.7", linewidth=4.0, label="balls")
        axes[ball].set_ylabel(f"gap of ball {ball + 1} [mm]")
    worst = []
    for i, (scenario, solution) in enumerate(runs):
        look = _LOOKS[i % len(_LOOKS)]
        own = scenario.gaps(solution.t, solution.q, meshes=True)
        label = f"{20 * 4 ** int(scenario.subdivisions)} triangles each"
        for ball in range(2):
            axes[ball].plot(1e3 * solution.t, 1e3 * own[:, ball], linewidth=1.2, label=label, **look)
        n = min(len(own), len(exact))
        apart = np.max(np.abs(own[:n] - exact[:n]), axis=1)
        axes[2].semilogy(1e3 * solution.t[:n], 1e3 * np.maximum(apart, 1e-9), linewidth=1.2, **look)
        worst.append(f"{1e3 * float(np.max(apart)):.2g} mm with {label}")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    figure.suptitle(f"Gaps differ from those of balls by up to\n{', '.join(worst)}", fontsize=11)
    axes[2].set_ylabel("largest difference [mm]")
    axes[2].set_xlabel("time [ms]")
    for axis in axes:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    return figure
