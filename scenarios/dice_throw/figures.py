"""The dice at some instants, and their heights over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bodies import Box
from nonsmooth.solution.solution import Solution
from scenarios.dice_throw.scenario import EYES, DiceThrow
from scenarios.solids import draw_solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_COLOURS = ("#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#d55e00", "#0072b2")
_DASHES = "-", "--", "-.", ":"
_PIPS = {
    1: ((0, 0),),
    2: ((-1, -1), (1, 1)),
    3: ((-1, -1), (0, 0), (1, 1)),
    4: ((-1, -1), (-1, 1), (1, -1), (1, 1)),
    5: ((-1, -1), (-1, 1), (0, 0), (1, -1), (1, 1)),
    6: ((-1, -1), (-1, 0), (-1, 1), (1, -1), (1, 0), (1, 1)),
}
"""Places of the pips on a face, across and along."""
_PIP, _APART, _SIDES = 0.16, 0.5, 16
"""Radius of a pip and how far they are apart, in halves of the edge; sides of its polygon."""
_SHOWN = (0.0, 0.1, 0.2, 1.0)
"""Parts of the run."""


def _pips(half: float) -> list[tuple[Floats, Floats]]:
    """Return the pips of a die of half an edge [m]: normal of the face, and corners."""
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    ring, found = _PIP * np.column_stack([np.cos(turn), np.sin(turn)]), []
    for (side, axis), eyes in np.ndenumerate(EYES):
        normal = np.roll([2.0 * side - 1.0, 0.0, 0.0], axis)
        for place in _PIPS[int(eyes)]:
            flat = np.column_stack([np.ones(_SIDES) * (2.0 * side - 1.0), ring + _APART * np.array(place)])
            found.append((normal, half * np.roll(flat, axis, axis=1)))
    return found


def throw(scenario: DiceThrow, solution: Solution) -> Figure:
    """Draw the dice as one sees them at four instants, and the heights of their centres."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.8), layout="constrained")
    grid = figure.add_gridspec(3, 2, height_ratios=(1.0, 1.0, 1.1))
    n, half = int(scenario.number), 0.5 * scenario.edge
    shades = [_COLOURS[i % len(_COLOURS)] for i in range(n)]
    panels = [figure.add_subplot(grid[i // 2, i % 2]) for i in range(4)]
    for axis, share in zip(panels, _SHOWN, strict=True):
        sample = min(int(share * len(solution.t)), len(solution.t) - 1)
        poses = solution.q[sample].reshape(-1, 7)
        dice = [Box(half, half, half, rounding=scenario.rounding)] * n
        draw_solids(axis, dice, poses, -1.2, 0.45, shades, _pips(half))
        axis.set_title(f"t = {1e3 * solution.t[sample]:.0f} ms", fontsize=9)
        axis.set_xticks([])
        axis.set_yticks([])
    # one scale for all panels
    limits = np.array([[*axis.get_xlim(), *axis.get_ylim()] for axis in panels])
    width = np.max(limits[:, 1] - limits[:, 0]), np.max(limits[:, 3] - limits[:, 2])
    for axis, (left, right, low, high) in zip(panels, limits, strict=True):
        axis.set_xlim(0.5 * (left + right - width[0]), 0.5 * (left + right + width[0]))
        axis.set_ylim(0.5 * (low + high - width[1]), 0.5 * (low + high + width[1]))
    axis = figure.add_subplot(grid[2, :])
    for i, height in enumerate(scenario.heights(solution).T):
        axis.plot(1e3 * solution.t, 1e3 * height, _DASHES[i % 4], color=shades[i], linewidth=1.4, label=f"die {i + 1}")
    axis.axhline(1e3 * half, color="0.5", linewidth=0.8, linestyle="--", label="on a face")
    axis.set_xlabel("time [ms]")
    axis.set_ylabel("height of the centre [mm]")
    axis.set_ylim(bottom=0.0)
    axis.grid(color="0.9", linewidth=0.6)
    axis.legend(fontsize=8, frameon=False, loc="upper right")
    kind = "Rounded" if scenario.rounding > 0.0 else "Sharp"
    eyes = " + ".join(str(e) for e in scenario.eyes(solution))
    figure.suptitle(
        f"{kind} dice strike table and each other, and end on a face: {eyes}",
        fontsize=11,
    )
    return figure
