"""Regimes and speeds over Gamma, the path on the plate, and the last bounces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.bouncing_trimer.scenario import GRAVITY, BouncingTrimer
from scenarios.bouncing_trimer.survey import Entry, survey

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

GAMMAS: tuple[float, ...] = tuple(np.round(np.arange(0.9, 6.01, 0.3), 6).tolist())
"""Values of Gamma of the gallery."""
FREQUENCIES: tuple[float, ...] = (25.0, 50.0, 100.0)
"""Frequencies of the gallery [Hz]."""
PERIODS = 150
"""Plate periods of a run of the gallery."""

_LOOKS = (("o", "tab:blue"), ("s", "black"), ("^", "tab:red"), ("D", "tab:green"))
_BALLS = (("black", "-"), ("tab:red", "--"), ("tab:blue", "-."))
_SHOWN = 10.0
"""Plate periods of a motion that are drawn."""
_THRESHOLD = 1e-2
"""Where the axes become linear."""


def gallery(owner: type[BouncingTrimer], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    entries = survey(owner(), GAMMAS, FREQUENCIES, PERIODS, run)
    scenario = owner(gamma=3.0)
    solution = run(scenario)
    return {
        "regimes": regimes(owner(), entries),
        "path": path(scenario, solution),
        "gaps": last_bounces(scenario, solution),
    }


def regimes(scenario: BouncingTrimer, entries: list[Entry]) -> Figure:
    """Draw wandering and turning over Gamma, every run marked by its frequency; open where the trimer tumbles."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 7.2), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    for (marker, colour), frequency in zip(_LOOKS, sorted({entry.frequency for entry in entries}), strict=False):
        mine = [entry for entry in entries if entry.frequency == frequency]
        speed = GRAVITY / frequency
        rows = (
            [1e3 * entry.numbers["largest_gap"] * (frequency / 50.0) ** 2 for entry in mine],
            [entry.numbers["wandering"] / speed for entry in mine],
            [entry.numbers["turning"] * scenario.spacing / speed for entry in mine],
        )
        for axis, values in zip(axes, rows, strict=True):
            look: dict[str, Any] = {"marker": marker, "color": colour, "markersize": 4}
            axis.plot(
                [e.gamma for e in mine], values, linewidth=0.8, fillstyle="full", label=f"{frequency:g} Hz", **look
            )
            over = [i for i, entry in enumerate(mine) if entry.numbers["attractor"] == "tumbling"]
            opened = {**look, "markersize": 9, "fillstyle": "none", "linestyle": "none"}
            axis.plot([mine[i].gamma for i in over], [values[i] for i in over], **opened)
    for axis, label in zip(
        axes,
        ("largest gap · (f / 50 Hz)² [mm]", "speed along the path\n/ (g / f)", "turning rate · spacing\n/ (g / f)"),
        strict=True,
    ):
        axis.set_ylabel(label)
        axis.set_yscale("symlog", linthresh=_THRESHOLD)
        axis.set_ylim(0.0, 2.0 * max(_THRESHOLD, axis.dataLim.y1))
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[0].plot([], [], marker="o", markersize=9, fillstyle="none", linestyle="none", color="0.4", label="turns over")
    ended = [entry.gamma for entry in entries if entry.status != "done"]
    if ended:
        axes[0].plot(ended, [0.0] * len(ended), linestyle="none", marker="x", color="0.4", label="run ended early")
    axes[-1].set_xlabel("peak acceleration of the plate over gravity Γ")
    figure.suptitle("It rests, bounces level, wanders and turns, and at last tumbles, as Γ grows", fontsize=11)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def path(scenario: BouncingTrimer, solution: Solution) -> Figure:
    """Draw the path of the mass centre over the plate, and the triangle at the start and at the end."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 6.0), layout="constrained")
    axis = figure.subplots()
    place = 1e3 * scenario.motion(solution).place
    axis.plot(*place.T, color="black", linewidth=0.8, label="mass centre")
    looks: tuple[dict[str, Any], ...] = (
        {"color": "tab:blue", "linestyle": "--"},
        {"color": "tab:red", "linestyle": "-"},
    )
    for q, look, label in zip((solution.q[0], solution.q_end), looks, ("start", "end"), strict=True):
        _triangle(axis, scenario, q, look, label)
    axis.set_aspect("equal")
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("y [mm]")
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
    apart = float(np.hypot(*(place[-1] - place[0])))
    way = float(np.sum(np.hypot(*np.diff(place, axis=0).T)))
    words = f"Γ = {scenario.gamma:g}, {scenario.frequency:g} Hz"
    axis.set_title(f"A way of {way:.0f} mm in {solution.t_end:g} s leads {apart:.0f} mm away ({words})", fontsize=11)
    figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def _triangle(axis: Axes, scenario: BouncingTrimer, q: Floats, look: Mapping[str, Any], label: str) -> None:
    from matplotlib.patches import Circle

    corners = 1e3 * scenario.centres(q)
    closed = np.vstack([corners, corners[:1]])
    axis.plot(closed[:, 0], closed[:, 1], linewidth=1.0, label=label, **look)
    for x, y, _ in corners:
        axis.add_patch(Circle((x, y), 1e3 * scenario.radius, fill=False, linewidth=1.0, **look))
        axis.update_datalim([(x - 1e3 * scenario.radius, y), (x + 1e3 * scenario.radius, y)])
        axis.update_datalim([(x, y - 1e3 * scenario.radius), (x, y + 1e3 * scenario.radius)])


def last_bounces(scenario: BouncingTrimer, solution: Solution) -> Figure:
    """Draw the three gaps over the last plate periods."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.0), layout="constrained")
    axis = figure.subplots()
    begin = max(0.0, solution.t_end - _SHOWN / scenario.frequency)
    events = solution.events
    t = np.concatenate([solution.t, events.time])
    q = np.vstack([solution.q, events.q])
    order = np.argsort(t, kind="stable")
    t, q = t[order], q[order]
    shown = t >= begin
    gaps = scenario.gaps(t[shown], q[shown])
    for i, (colour, line) in enumerate(_BALLS):
        turns = (t[shown] - begin) * scenario.frequency
        axis.plot(turns, 1e3 * gaps[:, i], color=colour, linestyle=line, linewidth=1.2, label=f"ball {i + 1}")
    axis.set_xlabel("time [plate periods]")
    axis.set_ylabel("gap between ball and plate [mm]")
    axis.set_title(
        f"The balls meet the plate one by one: Γ = {scenario.gamma:g}, {scenario.frequency:g} Hz", fontsize=11
    )
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
    figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure
