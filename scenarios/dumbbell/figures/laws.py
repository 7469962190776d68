"""Fig. 12: what the impact law does to the drift."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from nonsmooth.solution.solution import Solution
from scenarios.dumbbell.figures import style
from scenarios.dumbbell.scenario import DumbbellScenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = (style.CURVE, style.OTHER)


def drift_by_law(runs: Mapping[str, tuple[DumbbellScenario, Solution]], title: str) -> Figure:
    """Draw the displacement of the mass centre along the rod's first direction (y) for each impact law."""
    figure, axes = style.new_figure(title, style.footnote(*(scenario for scenario, _ in runs.values())))
    axis = axes[0]
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    for look, (name, (scenario, solution)) in zip(_LOOKS, runs.items(), strict=True):
        motion = scenario.motion(solution)
        speed = 1e3 * scenario.summarise(solution)["drift_velocity"][1]
        moved = 1e3 * (motion.centre[:, 1] - motion.centre[0, 1])
        axis.plot(motion.t, moved, label=f"{name}: {speed:+.1f} mm/s when settled", **look)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("displacement of the mass centre along y [mm]")
    style.legend(axes)
    return figure
