"""Draw the figure of forces over time: ``python docs/force_figures.py docs/pages/figures``."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from law_axes import make_axes
from nonsmooth.scenarios.dumbbell import DumbbellScenario

import nonsmooth as ns

_START, _END, _TIMES = 0.12, 0.2, 4000
_LOOKS = (("black", 12.0, 1.0), ("tab:red", 24.0, 2.5))
"""Colour of a contact, and length and width of the strokes of its impacts."""


def main() -> None:
    """Save the figure in the folder given."""
    scenario = DumbbellScenario()
    solution = ns.simulate(scenario.build(), _END)
    times = np.linspace(_START, _END, _TIMES)
    history = solution.history("mode", "normal_force", "friction_force", times=times)
    figure, (normal, friction) = make_axes(
        "Drift of the dumbbell: where the slip turns round, friction does, and the plate presses more", 2
    )
    events = solution.events
    for number, (name, (colour, long, wide)) in enumerate(zip(solution.system.names.contacts, _LOOKS, strict=True)):
        closed = np.where(history["mode"][:, number] > 0, 1.0, math.nan)
        normal.plot(1e3 * times, 1e3 * closed * history["normal_force"][:, number], color=colour, label=name)
        friction.plot(1e3 * times, 1e3 * closed * history["friction_force"][:, number, 1], color=colour)
        struck = (events.time > _START) & (events.impulse[:, number, 0] > 0.0)
        hits, look = 1e3 * events.time[struck], {"color": colour, "markersize": long, "markeredgewidth": wide}
        normal.plot(hits, np.zeros(len(hits)), "|", zorder=3 - number, **look)
    normal.set_ylabel("normal force [mN]")
    friction.set_ylabel("friction [mN]")
    for axis in (normal, friction):
        axis.set_xlabel("time [ms]")
    figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=8)
    figure.savefig(Path(sys.argv[1]) / "forces_dumbbell.png", dpi=110)


if __name__ == "__main__":
    main()
