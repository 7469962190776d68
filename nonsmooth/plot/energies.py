"""Energies over time, with what was lost stacked on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.plot.arguments import axes_of, beside, over_time, times_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_LAYERS = (
    ("potential_energy", "potential, over its least", "#56b4e9", ""),
    ("kinetic_energy", "kinetic", "#0072b2", ""),
    ("friction_loss", "lost to friction", "#e69f00", "////"),
    ("restitution_loss", "lost to restitution", "#d55e00", "...."),
    ("closing_loss", "lost in closings", "#7f7f7f", "xxxx"),
)
"""Layers of the stack, the lowest first: variable, label, colour and hatch."""
_SEEN = 1e-3
"""A layer appears in the legend if its peak exceeds this fraction of the largest sum; smaller layers are invisible."""


def energies(solution: Solution, ax: Axes | None = None, *, times: ArrayLike | None = None) -> Axes:
    """Draw energies [J] and all losses since the start over time [s], stacked.

    The line is the sum that the stack must have: the energy at the start and the work of driven bodies, loads and
    compliant contacts since then.  A difference between stack and line is energy that is not accounted for.

    Parameters
    ----------
    solution, ax, times
        As for :func:`nonsmooth.plot.gaps`.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput
        If a time is not within the run.
    """
    row, account = times_of("nonsmooth.plot.energies", solution, times), solution.energy
    told = solution.history(*(name for name, *_ in _LAYERS), "driven_work", "load_work", times=row)
    least = float(np.min(told["potential_energy"]))
    total = account.kinetic_start + account.potential_start - least + told["driven_work"] + told["load_work"]
    parts = {**told, "potential_energy": told["potential_energy"] - least}
    ax, below = axes_of(ax), np.zeros_like(total)
    some = _SEEN * float(np.max(np.abs(total)))
    for name, label, colour, hatch in _LAYERS:
        above, seen = below + parts[name], np.max(np.abs(parts[name])) > some
        ax.fill_between(
            row, below, above, label=label if seen else None, facecolor=colour, hatch=hatch, edgecolor="white",
            linewidth=0.0,
        )  # fmt: skip
        below = above
    ax.plot(row, total, color="black", linewidth=1.4, linestyle="--", label="at the start, and work since")
    over_time(ax, solution)
    ax.set_ylabel("energy [J]")
    beside(ax)
    return ax
