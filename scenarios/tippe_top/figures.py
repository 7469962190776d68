"""How the top turns over, and what that depends on."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.tippe_top.scenario import TippeTop

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RADII = (0.0, 0.05e-3, 0.1e-3, 0.5e-3, 2e-3)
"""Contact radii of the gallery [m]."""
_SPINS = (20.0, 60.0, 100.0, 150.0, 180.0)
"""Spins of the gallery [rad/s]."""
_SHORT = 5.0
"""End of their runs [s]."""
_LINES = (
    ("black", "-"),
    ("tab:red", "--"),
    ("tab:blue", "-."),
    ("tab:green", ":"),
    ("tab:purple", (0, (6, 1, 1, 1, 1, 1))),
)


def history(scenario: TippeTop, solution: Solution) -> Figure:
    """Draw tilt, spins and slip speeds over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 7.2), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    numbers = scenario.coordinates(solution)
    touching = np.abs(scenario.gaps(solution.q)) < 1e-9
    axes[0].plot(solution.t, np.degrees(numbers["tilt"]), color="black", linewidth=1.4)
    axes[0].set_ylabel("tilt of the axis [deg]")
    axes[0].set_yticks(range(0, 181, 45))
    for name, label, (colour, line) in (
        ("spin_vertical", "about the vertical", _LINES[0]),
        ("spin_axis", "about the top's axis", _LINES[1]),
    ):
        axes[1].plot(solution.t, numbers[name], color=colour, linestyle=line, linewidth=1.4, label=label)
    axes[1].set_ylabel("angular velocity [rad/s]")
    for i, (name, (colour, line)) in enumerate((("body", _LINES[0]), ("stem", _LINES[1]))):
        slip = np.where(touching[:, i], numbers[f"slip_{name}"], np.nan)
        axes[2].plot(solution.t, slip, color=colour, linestyle=line, linewidth=1.4, label=f"{name} on the plane")
    axes[2].set_ylabel("slip speed [m/s]")
    axes[2].set_xlabel("time [s]")
    summary = scenario.summarise(solution)
    for axis in axes:
        if summary["stem_down"] is not None:
            axis.axvline(summary["stem_down"], color="0.5", linewidth=0.8, linestyle=":", label="the stem touches")
        _grid(axis)
    for axis in axes[1:]:
        axis.legend(fontsize=8, frameon=False, loc="upper right")
    word = "turns over and stands on its stem" if summary["inverted"] else "does not turn over"
    figure.suptitle(
        f"The top {word}: the spin about its axis changes sign" if summary["inverted"] else f"The top {word}"
    )
    return figure


def gallery(owner: type[TippeTop], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    base = owner()
    groups: dict[str, list[tuple[str, TippeTop]]] = {
        "history": [("", base)],
        "contact_radius": [(_radius(r), dataclasses.replace(base, contact_radius=r, t_end=_SHORT)) for r in _RADII],
        "spin": [(f"{spin:g} rad/s", dataclasses.replace(base, spin=spin, t_end=_SHORT)) for spin in _SPINS],
    }
    titles = {
        "contact_radius": "Friction at a point makes the top roll, and it stays upright; a spinning disc lets it slip",
        "spin": "A fast top rises onto its stem, slower ones come to lean, a slow one does not turn",
    }
    drawn = {}
    for name, group in groups.items():
        runs = []
        for label, scenario in group:
            solution = run(scenario)
            runs.append((label, scenario, solution))
        drawn[name] = _tilts(runs, titles[name]) if name in titles else history(*runs[0][1:])
    return drawn


def _radius(radius: float) -> str:
    return "friction at a point" if radius == 0.0 else f"R = {1e3 * radius:g} mm"


def _tilts(runs: list[tuple[str, TippeTop, Solution]], title: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axis = figure.subplots()
    for (label, scenario, solution), (colour, line) in zip(runs, _LINES, strict=True):
        tilt = np.degrees(scenario.tilts(solution.q))
        axis.plot(solution.t, tilt, color=colour, linestyle=line, linewidth=1.4, label=label)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("tilt of the axis [deg]")
    axis.set_yticks(range(0, 181, 45))
    axis.set_title(title, fontsize=11)
    _grid(axis)
    figure.legend(loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    return figure


def _grid(axis: Axes) -> None:
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
