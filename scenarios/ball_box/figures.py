"""The balls in the box, and how they came there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.solution.solution import Solution
from scenarios.ball_box.scenario import BallBox

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = (("black", "-"), ("tab:red", "--"), ("tab:blue", "-."))


def pile(scenario: BallBox, solution: Solution) -> Figure:
    """Draw the balls at the start and at the end, from the side and from above, the nearer ones lighter."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle

    figure = Figure(figsize=(7.2, 5.6), layout="constrained")
    places = scenario.positions(solution)
    half, top = 500.0 * scenario.box_width, 1e3 * (np.max(places[0, :, 2]) + 1.5 * scenario.radius)
    axes = figure.subplots(2, 2, sharex=True, height_ratios=[top, 2.0 * half])
    closed = int(scenario.closed_contacts(solution)[-1])
    for column, (centres, name) in enumerate(((places[0], "start"), (places[-1], f"t = {solution.t[-1]:g} s"))):
        for axis, up, towards in ((axes[0, column], 2, -1), (axes[1, column], 1, 2)):
            # the nearest to the eye is drawn last
            depth = centres[:, 2] if towards == 2 else -centres[:, 1]
            for i in np.argsort(depth):
                near = (depth[i] - np.min(depth)) / max(float(np.ptp(depth)), scenario.radius)
                axis.add_patch(
                    Circle(
                        (1e3 * centres[i, 0], 1e3 * centres[i, up]),
                        1e3 * scenario.radius,
                        facecolor=str(0.6 + 0.35 * near),
                        edgecolor="black",
                        linewidth=0.8,
                    )
                )
            axis.set_aspect("equal")
            axis.set_xlim(-half, half)
        axes[0, column].set_ylim(0.0, top)
        axes[1, column].set_ylim(-half, half)
        axes[0, column].set_title(f"from the side, {name}", fontsize=10)
        axes[1, column].set_title(f"from above, {name}", fontsize=10)
        axes[1, column].set_xlabel("x [mm]")
    axes[0, 0].set_ylabel("z [mm]")
    axes[1, 0].set_ylabel("y [mm]")
    share = float(scenario.kinetic_energy(solution)[-1]) / scenario.fall_energy
    title = f"{places.shape[1]} balls have {share:.1e} of the energy of their fall left, and {closed} closed contacts"
    figure.suptitle(title, fontsize=11)
    return figure


def history(runs: Mapping[str, tuple[BallBox, Solution]]) -> Figure:
    """Draw the kinetic energy, over that of the fall, and the number of closed contacts over time."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(7.2, 5.6), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    for (colour, line), (name, (scenario, solution)) in zip(_LOOKS, runs.items(), strict=False):
        share = scenario.kinetic_energy(solution) / scenario.fall_energy
        axes[0].semilogy(solution.t, share, color=colour, linestyle=line, linewidth=1.2, label=name)
        times = np.append(solution.events.time, solution.t_end)
        closed = scenario.closed_contacts(solution)
        axes[1].step(
            times, np.append(closed, closed[-1]), where="post", color=colour, linestyle=line, linewidth=1.2, label=name
        )
    axes[0].set_title("Collisions take the energy; what rolls on keeps it", fontsize=11)
    axes[0].set_ylabel("kinetic energy / energy of the fall")
    axes[1].set_ylabel("closed contacts")
    axes[1].yaxis.set_major_locator(MaxNLocator(integer=True))
    axes[1].set_xlabel("time [s]")
    for axis in axes:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    if len(runs) > 1:
        axes[0].legend(fontsize=8, frameon=False)
    return figure
