"""Critical friction over the postures of the arm, and the height of its tip over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.solution import Solution
from scenarios.two_link_arm import painleve
from scenarios.two_link_arm.scenario import TwoLinkArm

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = (("black", "-"), ("tab:red", "--"), ("tab:blue", "-."))


def critical_friction(scenario: TwoLinkArm) -> Figure:
    """Draw the least friction of the paradox over the first link's angle, with the friction of the run."""
    from matplotlib.figure import Figure

    ratio = scenario.height / scenario.link_length
    sizes = (ratio, scenario.link_mass, scenario.link_length)
    low, high = math.acos(min(1.0, ratio)), math.acos(max(-1.0, ratio - 1.0))
    angles = np.linspace(low, high, 402)[1:-1]
    critical = np.array([painleve.critical_friction(x, *sizes) for x in angles])
    least, where = painleve.least_critical_friction(*sizes)
    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    axis.plot(angles, critical, color="black", linewidth=1.4)
    axis.fill_between(angles, critical, 2.0, where=critical < 2.0, color="tab:red", alpha=0.15, linewidth=0.0)
    axis.plot(where, least, "o", color="black", markersize=5)
    axis.annotate(
        f"least: {least:.4f} at {where:.3f} rad",
        (where, least),
        (-6, -16),
        textcoords="offset points",
        fontsize=9,
        ha="right",
    )
    axis.plot(scenario.angle, scenario.friction, "x", color="tab:red", markersize=7, label="start of the runs")
    axis.text(0.85 * where, 1.2, "no force fulfils the laws", ha="center", fontsize=9, color="tab:red")
    axis.set_ylim(0.0, 1.5)
    axis.set_title("Above the curve, friction pulls the sliding tip into the belt", fontsize=11)
    axis.set_xlabel("angle of the first link from the vertical [rad]")
    axis.set_ylabel("critical friction coefficient")
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
    axis.legend(fontsize=8, frameon=False, loc="lower left")
    return figure


def gaps(runs: Mapping[str, Sequence[tuple[TwoLinkArm, Solution]]], title: str) -> Figure:
    """Draw the height of the tip over the belt, one panel per name; crosses mark impacts without collision."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 1.2 + 2.2 * len(runs)), layout="constrained")
    axes = figure.subplots(len(runs), sharex=True, sharey=True, squeeze=False)[:, 0]
    for axis, (name, pairs) in zip(axes, runs.items(), strict=True):
        for (colour, line), (scenario, solution) in zip(_LOOKS, pairs, strict=False):
            label = f"spring {scenario.spring:g} N m/rad"
            axis.plot(
                solution.t, 1e3 * scenario.gap(solution), color=colour, linestyle=line, linewidth=1.2, label=label
            )
            times = solution.events.time[solution.events.cause == Cause.PAINLEVE]
            axis.plot(times, np.zeros(len(times)), "x", color=colour, markersize=8, clip_on=False, zorder=3)
        axis.set_title(name, fontsize=9, loc="right")
        axis.set_ylabel("gap [mm]")
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.legend(fontsize=8, frameon=False, loc="upper right")
    axes[-1].set_xlabel("time [s]")
    # room for the legend above the highest curve
    highest = max(
        1e3 * float(np.max(scenario.gap(solution))) for pairs in runs.values() for scenario, solution in pairs
    )
    axes[0].set_ylim(-0.05 * highest - 1e-6, 1.3 * highest + 1e-6)
    figure.suptitle(title, fontsize=11)
    return figure
