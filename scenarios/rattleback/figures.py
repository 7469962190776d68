"""How the spin turns round, and what that depends on."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.rattleback.scenario import Rattleback

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINES = (("black", "-"), ("tab:red", "--"), ("tab:blue", "-."), ("tab:green", ":"))


def history(scenario: Rattleback, solution: Solution) -> Figure:
    """Draw spin, pitch and roll over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.0), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    numbers = scenario.coordinates(solution)
    axes[0].plot(solution.t, numbers["spin"], color="black", linewidth=1.4)
    axes[0].axhline(0.0, color="0.6", linewidth=0.8)
    axes[0].set_ylabel("spin [rad/s]")
    for axis, name, words in (
        (axes[1], "pitch", "pitch of\nthe long axis"),
        (axes[2], "roll", "roll about\nthe long axis"),
    ):
        axis.plot(solution.t, np.degrees(numbers[name]), color="black", linewidth=0.7)
        axis.set_ylabel(f"{words} [deg]")
    axes[2].set_xlabel("time [s]")
    for axis in axes:
        _grid(axis)
    turned = scenario.summarise(solution)["reversed"]
    figure.suptitle(
        "The spin is not turned round" if turned is None else f"The spin is turned round after {turned:.1f} s"
    )
    return figure


def gallery(owner: type[Rattleback], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    base = owner()
    groups: dict[str, tuple[str, list[tuple[str, Rattleback]]]] = {
        "history": ("", [("", base)]),
        "sense": (
            "One way it rattles and turns round, the other way it spins on for long",
            [(f"{spin:+g} rad/s", dataclasses.replace(base, spin=spin, t_end=60.0)) for spin in (-5.0, 5.0)],
        ),
        "friction": (
            "Where it slips while it rattles, it comes back slower",
            [(f"mu = {mu:g}", dataclasses.replace(base, friction=mu)) for mu in (1.0, 0.5, 0.3, 0.2)],
        ),
    }
    drawn = {}
    for name, (title, group) in groups.items():
        runs = []
        for label, scenario in group:
            solution = run(scenario)
            runs.append((label, scenario, solution))
        drawn[name] = _spins(runs, title) if title else history(*runs[0][1:])
    return drawn


def _spins(runs: list[tuple[str, Rattleback, Solution]], title: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 3.8), layout="constrained")
    axis = figure.subplots()
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    for (label, scenario, solution), (colour, line) in zip(runs, _LINES, strict=False):
        spin = scenario.coordinates(solution)["spin"]
        axis.plot(solution.t, spin, color=colour, linestyle=line, linewidth=1.4, label=label)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("spin about the vertical [rad/s]")
    axis.set_title(title, fontsize=11)
    _grid(axis)
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _grid(axis: Axes) -> None:
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
