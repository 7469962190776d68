"""The bifurcation diagram and the motion over time."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution

from . import orbits

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import BouncingBall

Floats = NDArray[np.float64]

RUNS = 400
"""Runs of the bifurcation diagram."""
_SHOWN = 8.0
"""Table periods of a motion that are drawn."""
_DISTURBANCE = 1e-3
"""Relative change of the speed at the start; without it a run would remain on an unstable orbit."""


def motion(scenario: BouncingBall, solution: Solution) -> Figure:
    """Draw ball and table over the last table periods, or over the whole run on a table at rest."""
    figure, (ax,) = charts.panels(title=_flights(scenario, solution), size=(7.2, 4.0))
    _paths(ax, scenario, solution)
    ax.set_xlabel("time [s]" if scenario.gamma == 0.0 else "time [table periods]")
    charts.legend(figure)
    return figure


def _flights(scenario: BouncingBall, solution: Solution) -> str:
    """Return a title: what the last flights are like."""
    words = f"(Γ = {scenario.gamma:g}, e = {scenario.restitution:g})"
    summary = scenario.summarise(solution)
    if summary["resting_share"] > 0.0:
        return f"The ball comes to rest on the table at {summary['first_rest']:.3g} s {words}"
    if scenario.gamma == 0.0 or summary["last_flight"] is None:
        return f"The ball strikes {summary['impacts']} times {words}"
    last, after = f"{summary['last_flight']:.3g}", summary["repeats_after"]
    repeats = {None: "no flight repeats", 1: "each is as the last"}.get(after, f"each {after}th repeats")
    return f"The last flight lasts {last} table period{'s' * (last != '1')}, {repeats} {words}"


def branches(owner: type[BouncingBall], run: Run) -> Figure:
    """Draw the motion on four attractors at the same restitution."""
    cases = {
        "n = 1": owner(gamma=0.8),
        "n = 2, at the same Γ": owner(gamma=0.8, orbit=2),
        "period doubled": owner(gamma=1.12),
        "chaos": owner(gamma=2.5),
    }
    title = f"Which orbit a ball is on depends on Γ, and on its start (e = {owner().restitution:g})"
    figure, axes = charts.panels(2, 2, title, (7.2, 6.0))
    for ax, (name, on_orbit) in zip(axes, cases.items(), strict=True):
        scenario = dataclasses.replace(on_orbit, speed=(1.0 + _DISTURBANCE) * on_orbit.resolved()["speed"])
        _paths(ax, scenario, run(scenario))
        ax.set_title(f"{name}: Γ = {scenario.gamma:g}", fontsize=10)
    for ax in axes[2:]:
        ax.set_xlabel("time [table periods]")
    charts.legend(figure)
    return figure


def _paths(ax: Axes, scenario: BouncingBall, solution: Solution) -> None:
    """Draw heights of ball and table, and the impacts."""
    at_rest = scenario.gamma == 0.0
    unit = 1.0 if at_rest else scenario.period
    begin = 0.0 if at_rest else max(0.0, solution.t_end - _SHOWN * unit)
    times, heights = _motion(scenario, solution, begin)
    table, hits = np.linspace(begin, solution.t_end, 1200), scenario.impact_times(solution)
    hits = hits[hits >= begin]
    curves = ("ball, lowest point", times, heights), ("table", table, scenario.table(table))
    for place, (label, t, z) in enumerate(curves):
        ax.plot((t - begin) / unit, 1e3 * z, label=label, **charts.line(place))
    ax.plot((hits - begin) / unit, 1e3 * scenario.table(hits), markersize=4, label="impact", **charts.marker(2))
    ax.set_ylabel("height [mm]")


def _motion(scenario: BouncingBall, solution: Solution, begin: float) -> tuple[Floats, Floats]:
    """Return times from ``begin`` on, at samples, events and end [s], and heights of the ball's lowest point [m]."""
    events = solution.events
    times = np.concatenate([events.time, solution.t, [solution.t_end]])
    heights = np.concatenate([events.q[:, 2], solution.q[:, 2], solution.q_end[2:3]]) - scenario.radius
    order = np.argsort(times, kind="stable")
    order = order[times[order] >= begin]
    return times[order], heights[order]


def bifurcation(scenario: BouncingBall, run: Run) -> Figure:
    """Draw impact phases and flight times over Gamma, with the bounds of existence and stability of the orbit."""
    e, n = scenario.restitution, scenario.orbit
    low, high = orbits.existence(e, n), orbits.stability(e, n)
    gamma, phase, flight = sweep(scenario, np.linspace(1.001 * low, 2.0, RUNS), settle=250, keep=150, run=run)
    exists = np.linspace(1.001 * low, float(gamma.max()), 600)
    orbit = [orbits.impact_phase(g, e, n) / (2.0 * np.pi) for g in exists.tolist()]
    title = f"The orbit loses its stability where the formula says, and doubles into chaos (e = {e:g})"
    figure, axes = charts.panels(2, 1, title, (7.2, 6.4), sharex=True)
    for ax, values, theory, label in (
        (axes[0], phase, orbit, "table phase at impact [turns]"),
        (axes[1], flight, np.full(len(exists), n), "flight [table periods]"),
    ):
        ax.plot(gamma, values, linestyle="none", marker=".", markersize=0.8, color="black", rasterized=True)
        ax.plot(exists, theory, color="tab:red", linewidth=1.0, linestyle="--", label=f"orbit with flights of n = {n}")
        ax.axvline(low, color="tab:blue", linewidth=1.0, linestyle=":", label=f"it exists from Γ = {low:.3f}")
        ax.axvline(high, color="tab:blue", linewidth=1.0, linestyle="-.", label=f"it is stable up to Γ = {high:.3f}")
        ax.set_ylabel(label)
        ax.set_ylim(bottom=0.0)
    axes[0].set_ylim(top=1.0)
    axes[1].set_xlabel("peak acceleration of the table over gravity Γ")
    charts.legend(figure)
    return figure


def sweep(
    scenario: BouncingBall, gammas: Iterable[float], *, settle: int, keep: int, run: Run
) -> tuple[Floats, Floats, Floats]:
    """Run a scenario for several values of Gamma, each run from the last impact of the run before.

    Every run lasts ``settle`` + ``keep`` table periods.  It starts with the phase and the take-off speed of that
    impact, so that the runs follow one attractor as long as it exists.

    Returns
    -------
    gamma, phase, flight : array
        For each impact of the last ``keep`` periods: Gamma, phase of the table [turns], and the flight that follows
        [table periods].
    """
    found: list[Floats] = []
    start: dict[str, Any] = {}
    for gamma in gammas:
        one = dataclasses.replace(scenario, gamma=float(gamma), t_end=(settle + keep) * scenario.period, **start)
        solution = run(one)
        times, flights, phases = one.impact_times(solution), one.flights(solution), one.phases(solution)
        kept = times[:-1] >= settle * one.period
        found.append(np.column_stack([np.full(kept.sum(), one.gamma), phases[:-1][kept], flights[kept]]))
        if len(times) > 0:
            last = solution.events.u_after[solution.events.cause == Cause.IMPACT][-1]
            start = {"start_phase": 2.0 * math.pi * float(phases[-1]), "speed": float(last[2])}
    gamma, phase, flight = np.vstack(found).T
    return gamma, phase, flight
