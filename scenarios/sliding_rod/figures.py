"""Where the paradox begins, and what the rod does there."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.sliding_rod.scenario import SlidingRod

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

ANGLES, COEFFICIENTS = 17, 11
"""Numbers of angles and friction coefficients of the gallery."""
_MARKS: dict[int, tuple[str, str, str]] = {
    Cause.PAINLEVE: ("o", "tab:red", "impact without collision"),
    Cause.JAM: ("s", "tab:red", "jamming of the slip"),
    Cause.LIFT_OFF: ("^", "tab:blue", "lift-off"),
    Cause.SLIP_TO_STICK: ("D", "tab:green", "slip to stick"),
}
_CASES: tuple[tuple[str, dict[str, float]], ...] = (
    ("lift-off", {"friction": 1.2, "tilt": 1.0, "rate": 8.0, "speed": 5.0, "t_end": 0.08}),
    ("jamming", {"friction": 2.0, "tilt": 0.5, "rate": 5.0, "speed": 3.0, "t_end": 0.04}),
    ("impact without collision", {"friction": 1.4, "t_end": 0.04}),
)


@dataclass(frozen=True)
class _Trace:
    """Time [s], tilt [rad], slip [m/s] and height of the lower end [m], doubled where an event makes them jump."""

    t: Floats
    tilt: Floats
    slip: Floats
    height: Floats


def _trace(scenario: SlidingRod, solution: Solution) -> _Trace:
    events = solution.events
    parts = [
        (np.zeros(1), events.q[:1], events.u_before[:1]),
        (solution.t, solution.q, solution.u),
        (events.time, events.q, events.u_before),
        (events.time, events.q, events.u_after),
    ]
    order = np.argsort(np.concatenate([t for t, _, _ in parts]), kind="stable")
    t, q, u = (np.concatenate(column)[order] for column in zip(*parts, strict=True))
    # at one time: the state before the event, then the one after
    after = np.concatenate([np.full(len(p[0]), k) for k, p in enumerate(parts)])[order]
    order = np.lexsort((after == 3, t))
    keep = order[(after[order] != 1) | ~np.isin(t[order], events.time)]
    t, q, u = t[keep], q[keep], u[keep]
    tilt = scenario.tilts(q)
    height = q[:, 2] - scenario.half_length * np.sin(tilt) - scenario.end_radius
    return _Trace(t, tilt, scenario.slips(q, u), height)


def _draw(axes: list[Axes], scenario: SlidingRod, solution: Solution) -> None:
    trace = _trace(scenario, solution)
    events = solution.events
    at_events = scenario.tilts(events.q)
    slips = scenario.slips(events.q, events.u_before)
    lower = events.q[:, 2] - scenario.half_length * np.sin(at_events) - scenario.end_radius
    shown = (np.degrees(trace.tilt), trace.slip, 1e3 * trace.height)
    for axis, values, marked in zip(axes, shown, (np.degrees(at_events), slips, 1e3 * lower), strict=True):
        axis.plot(1e3 * trace.t, values, color="black", linewidth=1.3)
        for cause, (marker, colour, name) in _MARKS.items():
            hit = events.cause == cause
            if np.any(hit):
                axis.plot(
                    1e3 * events.time[hit],
                    marked[hit],
                    linestyle="none",
                    marker=marker,
                    color=colour,
                    fillstyle="none",
                    markersize=7,
                    label=name,
                )
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[2].set_ylim(bottom=-0.1, top=max(1.0, axes[2].get_ylim()[1]))
    axes[2].set_xlabel("time [ms]")


def _label(axes: list[Axes]) -> None:
    axes[0].set_ylabel("angle φ [deg]")
    axes[1].set_ylabel("slip velocity [m/s]")
    axes[2].set_ylabel("gap of the lower end [mm]")


def _legend(figure: Figure) -> None:
    found: dict[str, Any] = {}
    for axis in figure.axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    if found:
        figure.legend(list(found.values()), list(found), loc="outside lower center", ncols=4, fontsize=8, frameon=False)


def history(scenario: SlidingRod, solution: Solution) -> Figure:
    """Draw angle, slip and height of the lower end of one run."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 6.4), layout="constrained")
    axes = list(figure.subplots(3, 1, sharex=True))
    _draw(axes, scenario, solution)
    _label(axes)
    critical = scenario.rod.critical_friction(scenario.tilt)
    axes[0].set_title(f"µ = {scenario.friction:g}; the paradox begins at {critical:.4g} for this angle", fontsize=11)
    _legend(figure)
    return figure


def gallery(owner: type[SlidingRod], run: Run) -> Mapping[str, Any]:
    """Return all figures by name."""
    return {"paradox": _paradox(owner, run), "histories": _histories(owner, run)}


def _histories(owner: type[SlidingRod], run: Run) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 6.8), layout="constrained")
    grid = figure.subplots(3, len(_CASES), sharex="col")
    for column, (name, start) in enumerate(_CASES):
        scenario = owner(**start)
        solution = run(scenario)
        _draw(list(grid[:, column]), scenario, solution)
        critical = scenario.rod.critical_friction(scenario.tilt)
        grid[0, column].set_title(
            f"{name}\nµ = {scenario.friction:g}, critical at the start {critical:.3f}", fontsize=10
        )
    _label(list(grid[:, 0]))
    figure.suptitle(
        "Sliding can end in a lift-off, in a jam where it runs into the paradox, or at once where it starts in it",
        fontsize=11,
    )
    _legend(figure)
    return figure


def _paradox(owner: type[SlidingRod], run: Run) -> Figure:
    from matplotlib.figure import Figure

    base = owner(t_end=1e-6)
    angles = np.linspace(math.radians(25.0), math.radians(85.0), ANGLES)
    coefficients = np.linspace(1.0, 2.0, COEFFICIENTS)
    runs = [dataclasses.replace(base, tilt=float(a), friction=float(mu)) for a in angles for mu in coefficients]
    outcome: list[bool] = []
    for scenario in runs:
        events = run(scenario).events
        outcome.append(events.count(Cause.PAINLEVE) > 0)
    struck = np.array(outcome)
    places = np.array([(math.degrees(one.tilt), one.friction) for one in runs])
    figure = Figure(figsize=(7.2, 4.8), layout="constrained")
    axis = figure.subplots()
    fine = np.linspace(angles[0], angles[-1], 400)
    curve = [(3.0 * math.cos(a) ** 2 + 1.0) / (3.0 * math.cos(a) * math.sin(a)) for a in fine]
    axis.plot(np.degrees(fine), curve, color="black", linewidth=1.4, label="(1 + a cos²φ) / (a sinφ cosφ), a = 3")
    axis.plot(
        *places[struck].T,
        linestyle="none",
        marker="o",
        markersize=4,
        color="tab:red",
        label="run: impact without collision",
    )
    axis.plot(*places[~struck].T, linestyle="none", marker=".", markersize=3, color="0.6", label="run: slides on")
    lowest = math.degrees(math.atan(2.0))
    axis.annotate(
        "4/3 at tan φ = 2", xy=(lowest, 4.0 / 3.0), xytext=(lowest - 8.0, 1.13), fontsize=9,
        arrowprops={"arrowstyle": "->", "color": "black"}, backgroundcolor="white",
    )  # fmt: skip
    axis.set_ylim(0.92, 2.05)
    axis.set_xlabel("angle φ of the rod from the ground [deg]")
    axis.set_ylabel("friction coefficient µ")
    axis.set_title("Sliding ahead, the rod has no contact force above the curve", fontsize=11)
    figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure
