"""How the egg stands up, and what that depends on."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.egg_on_table.scenario import EggOnTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FRICTIONS = (0.0, 0.05, 0.1, 0.2)
_SPINS = (40.0, 80.0, 140.0, 250.0)
"""Spins of the gallery [rad/s]."""
_LINES = (("black", "-"), ("tab:red", "--"), ("tab:blue", "-."), ("tab:green", ":"))


def history(scenario: EggOnTable, solution: Solution) -> Figure:
    """Draw tilt, spin, slip and Jellett's constant over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 8.0), layout="constrained")
    axes = figure.subplots(4, 1, sharex=True)
    numbers = scenario.coordinates(solution)
    values = (np.degrees(numbers["tilt"]), numbers["spin"], numbers["slip"], numbers["jellett"] / numbers["jellett"][0])
    labels = "tilt of the axis [deg]", "spin about\nthe vertical [rad/s]", "slip [m/s]", "$L_z h$ over its start"
    for axis, value, label in zip(axes, values, labels, strict=True):
        axis.plot(solution.t, value, color="black", linewidth=0.9)
        axis.set_ylabel(label)
        _grid(axis)
    axes[0].set_ylim(0.0, 90.0)
    axes[0].set_yticks(range(0, 91, 30))
    axes[1].axhline(
        scenario.upright_spin(), color="tab:red", linestyle="--", linewidth=0.9, label="by $A\\Omega h$, upright"
    )
    axes[1].legend(fontsize=8, frameon=False, loc="lower right")
    low, high = min(0.95, float(np.min(values[3]))), max(1.05, float(np.max(values[3])))
    axes[3].set_ylim(low, high)
    axes[3].set_xlabel("time [s]")
    upright = scenario.summarise(solution)["upright"]
    figure.suptitle("The egg does not stand up" if upright is None else f"The egg stands up within {upright:.1f} s")
    return figure


def gallery(owner: type[EggOnTable], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    base = owner()
    groups: dict[str, tuple[str, list[tuple[str, EggOnTable]]]] = {
        "history": ("", [("", base)]),
        "friction": (
            "Without friction it keeps its tilt; with more of it it rises faster",
            [(f"mu = {mu:g}", dataclasses.replace(base, friction=mu)) for mu in _FRICTIONS],
        ),
        "spin": (
            "A slow egg stays down, a fast one rises",
            [(f"{spin:g} rad/s", dataclasses.replace(base, spin=spin)) for spin in _SPINS],
        ),
        "jumps": ("", [("", dataclasses.replace(base, spin=250.0, t_end=2.0))]),
    }
    drawn = {}
    for name, (title, group) in groups.items():
        runs = []
        for label, scenario in group:
            solution = run(scenario)
            runs.append((label, scenario, solution))
        if title:
            drawn[name] = _tilts(runs, title)
        else:
            drawn[name] = (jumps if name == "jumps" else history)(*runs[0][1:])
    return drawn


def jumps(scenario: EggOnTable, solution: Solution) -> Figure:
    """Draw gap and tilt over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    axes[0].plot(solution.t, 1e3 * scenario.gaps(solution.q), color="black", linewidth=0.9)
    axes[0].set_ylabel("gap [mm]")
    axes[1].plot(solution.t, np.degrees(scenario.tilts(solution.q)), color="black", linewidth=0.9)
    axes[1].set_ylabel("tilt of the axis [deg]")
    axes[1].set_xlabel("time [s]")
    for axis in axes:
        _grid(axis)
    flights = scenario.summarise(solution)["flights"]
    figure.suptitle(
        f"Spun at {scenario.spin:g} rad/s the egg leaves the table {flights} times while it rises", fontsize=11
    )
    return figure


def _tilts(runs: list[tuple[str, EggOnTable, Solution]], title: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.0), layout="constrained")
    axis = figure.subplots()
    for (label, scenario, solution), (colour, line) in zip(runs, _LINES, strict=True):
        tilt = np.degrees(scenario.tilts(solution.q))
        axis.plot(solution.t, tilt, color=colour, linestyle=line, linewidth=1.2, label=label)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("tilt of the axis [deg]")
    axis.set_ylim(0.0, 92.0)
    axis.set_yticks(range(0, 91, 30))
    axis.set_title(title, fontsize=11)
    _grid(axis)
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _grid(axis: Axes) -> None:
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
