"""The bifurcation diagram and the motion over time."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.runs.simulate import Progress, simulate
from nonsmooth.solution.solution import Solution
from scenarios.bouncing_ball import orbits
from scenarios.bouncing_ball.scenario import BouncingBall
from scenarios.bouncing_ball.sweep import Points, sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

RUNS = 400
"""Runs of the bifurcation diagram."""
_SHOWN = 8.0
"""Table periods of a motion that are drawn."""
_DISTURBANCE = 1e-3
"""Of the speed at the start: on an unstable orbit, a run would stay without it."""


def gallery(owner: type[BouncingBall], progress: Progress | None) -> Mapping[str, Any]:
    """Return all figures by name."""
    scenario = owner(restitution=0.6)
    first = 1.001 * orbits.existence(scenario.restitution, int(scenario.orbit))
    points = sweep(scenario, np.linspace(first, 2.0, RUNS), settle=250, keep=150, progress=progress)
    return {"bifurcation": bifurcation(scenario, points), "motions": branches(owner, progress)}


def bifurcation(scenario: BouncingBall, points: Points) -> Figure:
    """Draw phases of the impacts and flights between them over Gamma, with the bounds of the orbit."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.4), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    e = scenario.restitution
    first, last = float(np.min(points.gamma)), float(np.max(points.gamma))
    for axis, values, label in (
        (axes[0], points.phase, "table phase at impact [turns]"),
        (axes[1], points.flight, "flight [table periods]"),
    ):
        axis.plot(points.gamma, values, linestyle="none", marker=".", markersize=0.8, color="black", rasterized=True)
        axis.set_ylabel(label)
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.set_xlim(first - 0.05 * (last - first), last)
    inside = np.linspace(first, last, 600)
    n = int(scenario.orbit)
    low, high = orbits.existence(e, n), orbits.stability(e, n)
    exists = inside[inside > low]
    theory = [orbits.impact_phase(gamma, e, n) / (2.0 * np.pi) for gamma in exists]
    axes[0].plot(exists, theory, color="tab:red", linewidth=1.0, linestyle="--", label=f"orbit with flights of n = {n}")
    axes[1].plot(exists, np.full(len(exists), float(n)), color="tab:red", linewidth=1.0, linestyle="--")
    for axis in axes:
        axis.axvline(low, color="tab:blue", linewidth=1.0, linestyle=":", label=f"it exists from Γ = {low:.3f}")
        axis.axvline(high, color="tab:blue", linewidth=1.0, linestyle="-.", label=f"it is stable up to Γ = {high:.3f}")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    axes[0].set_ylim(0.0, 1.0)
    axes[1].set_ylim(bottom=0.0)
    axes[1].set_xlabel("peak acceleration of the table over gravity Γ")
    figure.suptitle(
        f"The orbit loses its stability where the formula says, and doubles into chaos (e = {e:g})", fontsize=11
    )
    return figure


def motion(scenario: BouncingBall, solution: Solution) -> Figure:
    """Draw ball and table over the last table periods, or over the whole run on a table at rest."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.0), layout="constrained")
    axis = figure.subplots()
    _paths(axis, scenario, solution)
    axis.set_title(_flights(scenario, solution), fontsize=11)
    axis.set_xlabel("time [s]" if scenario.gamma == 0.0 else "time [table periods]")
    figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def _flights(scenario: BouncingBall, solution: Solution) -> str:
    """Return a title: what the last flights are like."""
    words = f"(Γ = {scenario.gamma:g}, e = {scenario.restitution:g})"
    summary = scenario.summarise(solution)
    if summary["resting_share"] > 0.0:
        return f"The ball comes to rest on the table at {summary['first_rest']:.3g} s {words}"
    if scenario.gamma == 0.0 or summary["last_flight"] is None:
        return f"The ball strikes {summary['impacts']} times {words}"
    last, after = summary["last_flight"], summary["repeats_after"]
    repeats = (
        "no flight repeats" if after is None else "each is as the last" if after == 1 else f"each {after}th repeats"
    )
    long = f"{last:.3g}"
    return f"The last flight lasts {long} table period{'s' * (long != '1')}, {repeats} {words}"


def branches(owner: type[BouncingBall], progress: Progress | None) -> Figure:
    """Draw the motion on four attractors at the same restitution."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 6.0), layout="constrained")
    axes = figure.subplots(2, 2)
    cases = (
        ("n = 1", {"gamma": 0.8}),
        ("n = 2, at the same Γ", {"gamma": 0.8, "orbit": 2.0}),
        ("period doubled", {"gamma": 1.12}),
        ("chaos", {"gamma": 2.5}),
    )
    for axis, (name, start) in zip(axes.flat, cases, strict=True):
        scenario = owner(**start)
        scenario = dataclasses.replace(scenario, speed=(1.0 + _DISTURBANCE) * scenario.resolved()["speed"])
        solution = simulate(
            scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval, progress=progress
        )
        _paths(axis, scenario, solution)
        axis.set_title(f"{name}: Γ = {scenario.gamma:g}", fontsize=10)
    for axis in axes[1]:
        axis.set_xlabel("time [table periods]")
    figure.legend(
        *axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8, frameon=False
    )
    figure.suptitle(
        f"Which orbit a ball is on depends on Γ, and on its start (e = {scenario.restitution:g})", fontsize=11
    )
    return figure


def _paths(axis: Axes, scenario: BouncingBall, solution: Solution) -> None:
    at_rest = scenario.gamma == 0.0
    unit = 1.0 if at_rest else scenario.period
    begin = 0.0 if at_rest else max(0.0, solution.t_end - _SHOWN * unit)
    # a parabola between two events needs more points than the samples of a long run have
    events = solution.events
    edges = np.append(events.time, solution.t_end)
    first = max(0, int(np.searchsorted(edges, begin, side="right")) - 1)
    t, z = [], []
    for i in range(first, len(events)):
        inside = (solution.t > edges[i]) & (solution.t < edges[i + 1])
        t += [events.time[i], *solution.t[inside]]
        z += [events.q[i, 2] - scenario.radius, *scenario.lifts(solution)[inside]]
    times = np.array([*t, solution.t_end])
    heights = np.array([*z, solution.q_end[2] - scenario.radius])
    shown = times >= begin
    axis.plot(
        (times[shown] - begin) / unit, 1e3 * heights[shown], color="black", linewidth=1.2, label="ball, lowest point"
    )
    fine = np.linspace(begin, solution.t_end, 1200)
    axis.plot(
        (fine - begin) / unit,
        1e3 * scenario.table(fine),
        color="tab:blue",
        linewidth=1.2,
        linestyle="--",
        label="table",
    )
    hits = scenario.impact_times(solution)
    hits = hits[hits >= begin]
    axis.plot(
        (hits - begin) / unit, 1e3 * scenario.table(hits), linestyle="none", marker="o", markersize=4, color="tab:red",
        fillstyle="none", label="impact",
    )  # fmt: skip
    axis.set_ylabel("height [mm]")
    axis.grid(color="0.9", linewidth=0.6)
    axis.set_axisbelow(True)
