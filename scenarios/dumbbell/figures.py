"""Figures of the paper: runs, motions and velocities over time (Figs. 2 to 7), paths (Fig. 11)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.errors import NonsmoothWarning
from nonsmooth.interfaces import Run
from nonsmooth.notices import warn
from nonsmooth.solution.solution import Solution

from . import portraits
from .attractor import Settled
from .trace import Trace, note

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import DumbbellScenario

Floats = NDArray[np.float64]

_ACROSS = {"transverse_velocity": 1.0}
_RUNS: Mapping[str, dict[str, Any]] = {
    "drift": {"mode": "drift"},
    "jump": {"mode": "jump"},
    "jump 1": {"mode": "jump", "beta0": math.radians(1.0)},
    "flutter": {"mode": "flutter", "t_end": 8.0},
    "drift 3D": {"mode": "drift", "t_end": 24.0} | _ACROSS,
    # jump 3D is short, because the level motion is not stable: in a long run round-off tilts the dumbbell
    "jump 3D": {"mode": "jump", "t_end": 0.5} | _ACROSS,
    "flutter 3D": {"mode": "flutter", "t_end": 8.0} | _ACROSS,
}
_PERIODS: Mapping[str, float] = {"drift": 3.0, "jump": 3.0, "flutter": 4.0, "free": 6.0}
"""Plate periods that are drawn in figures over time, by mode."""
_SPANS: Mapping[str, float] = {"drift": 600.0, "jump": 8.0, "flutter": 8.0}
"""Plate periods that are drawn in figures of the path, by mode."""
_ANGLES = ("theta", "beta", "gamma")


def of_paper(kind: type[DumbbellScenario], run: Run) -> dict[str, Figure]:
    """Return Figs. 2 to 11 of the paper by file name.

    With other parameters a phase portrait of an angle that is constant in all runs is left out, with a warning.
    """
    scenarios = {name: kind(**parameters) for name, parameters in _RUNS.items()}
    runs = {name: (scenario, run(scenario)) for name, scenario in scenarios.items()}
    figures: dict[str, Figure] = {}
    for name in ("drift", "jump", "jump 1", "flutter"):
        figures |= _over_time(name, *runs[name])
    across = {mode: runs[f"{mode} 3D"] for mode in ("drift", "jump", "flutter")}
    # the results of the paper hold for its parameters only
    ends = "" if _is_published(kind) else _ends(across)
    title = (
        f"Paths from above {ends}" if ends else "Paths from above: drift circles, jump goes straight, flutter zigzags"
    )
    traces = {mode: Trace.of(*ran, _PERIODS[mode]) for mode, ran in across.items()}
    drawn = portraits.portraits(traces, _ANGLES, ends)
    for stem in portraits.left_out(drawn, _ANGLES):
        warn(f"The figure {stem} is left out: its angle is constant at the end of all runs.", NonsmoothWarning)
    return figures | drawn | {"fig11_paths": paths(across, _SPANS, title)}


def _is_published(kind: type[DumbbellScenario]) -> bool:
    """Return True if the default parameters are those of the paper; ``nonsmooth figures --set`` changes them."""
    from .scenario import DumbbellScenario

    return asdict(kind()) == asdict(DumbbellScenario())


def _ends(runs: Mapping[str, tuple[DumbbellScenario, Solution]]) -> str:
    """Return a text with the attractor that each run has reached."""
    found = {mode: scenario.summarise(solution)["attractor"] for mode, (scenario, solution) in runs.items()}
    return f"(attractors: {', '.join(f'{end} from the start of {mode}' for mode, end in found.items())})"


def of_run(scenario: DumbbellScenario, solution: Solution) -> dict[str, Figure]:
    """Return the figures of one run by file name, without figures of constant quantities; empty without samples."""
    if len(solution.t) < 2:
        return {}
    mode = scenario.mode
    tilted = mode == "jump" and scenario.resolved()["beta0"] != 0.0
    figures = _over_time("jump 1" if tilted else mode, scenario, solution)
    trace = Trace.of(scenario, solution, _PERIODS[mode])
    figures |= portraits.portraits({mode: trace}, _ANGLES if scenario.transverse_velocity else ("beta",))
    settled = Settled.of(scenario, solution)
    if _wanders(settled):
        span = _SPANS["flutter"] if mode == "flutter" else scenario.t_end * scenario.frequency
        summary = settled.summary()
        speed = 1e3 * math.hypot(*summary["drift_velocity"])
        title = f"From above: the settled mass centre moves at {speed:.3g} mm/s (attractor: {summary['attractor']})"
        figures["fig11_path"] = paths({mode: (scenario, solution)}, {mode: span}, title)
    return figures


def _over_time(name: str, scenario: DumbbellScenario, solution: Solution) -> dict[str, Figure]:
    """Return the figures over time of a run by file name."""
    trace = Trace.of(scenario, solution, _PERIODS[scenario.mode])
    attractor = scenario.summarise(solution)["attractor"]
    figures = {}
    for run, stem, draw, claim in _OVER_TIME:
        if run == name:
            # with other parameters the run may not show the motion that the title names
            title = claim if attractor == scenario.mode else f"{_NEUTRAL[draw]} (attractor: {attractor})"
            figures[stem] = draw(trace, title)
            charts.legend(figures[stem], note=note(scenario))
    return figures


def heights(trace: Trace, title: str) -> Figure:
    """Draw the heights of the plate and of both balls' lowest points; ball 1, as circles, may lie on the plate."""
    clock, (ball_1, ball_2) = trace.clock, 1e3 * trace.motion.heights.T
    plate = 1e3 * trace.scenario.plate_height(trace.motion.t)
    figure, ax = _panel(trace, "ball 2", ball_2, title, "height of the lowest point [mm]")
    ax.plot(clock, plate, label="plate", zorder=3, **portraits.CONTACT)
    circles = np.arange(0.0, clock[-1], 50.0 / trace.scenario.frequency)
    ax.plot(circles, np.interp(circles, clock, ball_1), label="ball 1", **(portraits.IMPACT | {"markersize": 4}))
    return figure


def slip_velocity(trace: Trace, title: str) -> Figure:
    """Draw the slip velocity of ball 1 along the rod's first direction (y) and mark the double impacts."""
    clock, slip = trace.clock, 1e3 * trace.motion.slip[:, 1]
    label, ylabel = "slip velocity of ball 1, along y", "slip velocity of ball 1 [mm/s]"
    figure, ax = _panel(trace, label, slip, title, ylabel)
    on_plate = np.column_stack([clock[:-1], np.diff(clock)])[trace.touching[:-1, 0]]
    style: dict[str, Any] = {"color": "0.9", "linewidth": 0.0, "antialiased": False, "label": "ball 1 on the plate"}
    ax.broken_barh(on_plate.tolist(), (0.0, 1.0), transform=ax.get_xaxis_transform(), **style)
    double = np.flatnonzero(trace.struck.all(axis=1))
    ax.plot(clock[double + 1], slip[double + 1], label="after a double impact", **portraits.IMPACT)
    ax.axhline(0.0, color="0.6", linewidth=0.8)
    return figure


def gap_rate(trace: Trace, title: str) -> Figure:
    """Draw the rate of the gap of ball 1 and mark the impacts of either ball."""
    clock, rate = trace.clock, trace.motion.gap_rate[:, 0]
    label = "normal velocity of ball 1 relative to the plate [m/s]"
    figure, ax = _panel(trace, "gap rate of ball 1", rate, title, label)
    own = np.flatnonzero(trace.struck[:, 0])
    other = np.flatnonzero(trace.struck[:, 1] & ~trace.struck[:, 0])
    ax.plot(clock[own + 1], rate[own + 1], label="after an impact of ball 1", **portraits.IMPACT)
    blue = portraits.IMPACT | {"color": "tab:blue", "marker": "s"}
    ax.plot(clock[other + 1], rate[other + 1], label="after an impact of ball 2", **blue)
    ax.axhline(0.0, color="0.6", linewidth=0.8)
    return figure


def _panel(trace: Trace, label: str, values: Floats, title: str, ylabel: str) -> tuple[Figure, Axes]:
    """Return a figure with a curve over the time of a trace."""
    figure, (ax,) = charts.panels(title=title, size=(7.2, 4.8))
    xlabel = f"time since t = {trace.motion.t[0]:.3f} s [ms]"
    charts.histories({ylabel: {label: (trace.clock, values)}}, xlabel=xlabel, axes=[ax])
    ax.margins(x=0.01)
    return figure, ax


_NEUTRAL = {
    heights: "Heights of both balls and the plate at the end of the run",
    slip_velocity: "Slip of ball 1 at the end of the run",
    gap_rate: "Normal velocity of ball 1 at the end of the run",
}
"""Drawing function -> neutral title of its figure.

A figure has this title if the run has not settled into the motion that ``mode`` names.
"""
_STANDS = "Drift: one ball keeps to the plate, the other strikes once per plate period"
_SLIP = "Drift: the slip of ball 1 is not symmetric, so that friction moves the dumbbell"
_TILTED = "Jump from a tilt: two single impacts per plate period instead of a double one"
_OVER_TIME = (
    ("drift", "fig02_drift_motion", heights, _STANDS),
    ("drift", "fig03_drift_tangential_velocity", slip_velocity, _SLIP),
    ("jump", "fig04_jump_motion", heights, "Jump: both balls strike together, once per plate period"),
    ("jump 1", "fig05_jump_tilted_motion", heights, "Jump from a tilt: the balls strike one after the other"),
    ("jump 1", "fig06_jump_tilted_normal_velocity", gap_rate, _TILTED),
    ("flutter", "fig07_flutter_motion", heights, "Flutter: the balls strike in turn, each every second plate period"),
    ("free", "free_motion", heights, _NEUTRAL[heights]),
)
"""Figures over time: name of the run, file name, drawing function and title of each."""


def paths(runs: Mapping[str, tuple[DumbbellScenario, Solution]], spans: Mapping[str, float], title: str) -> Figure:
    """Draw the path in the last ``spans`` [plate periods] of each run, with the mean velocity as arrows."""
    figure, axes = charts.panels(1, len(runs), title, (max(7.2, 3.9 * len(runs)), 5.2))
    for ax, (mode, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        settled = Settled.of(scenario, solution)
        motion = scenario.motion(solution, solution.t_end - spans[mode] / scenario.frequency - 1e-9)
        t, path = motion.t, motion.centre
        times, velocities = _means(settled, t, path)
        # the path of flutter sways across by too little to be seen at equal scales of both axes
        if mode == "flutter":
            turn = 1e3 * _turn(path)
            path, velocities = (path - path[0]) @ turn, velocities @ turn
            ax.set(xlabel="along the mean path [mm]", ylabel="across it [mm], magnified")
        else:
            _show_square(ax, path)
            ax.set(xlabel="x [m]", ylabel="y [m]")
        ax.plot(path[:, 0], path[:, 1], label="mass centre", **charts.line(0))
        ax.plot(*path[0], label="start of the part shown", **portraits.IMPACT)
        _arrows(ax, t, path, times, velocities)
        ax.set_title(f"{mode}, last {(t[-1] - t[0]):.3g} s", fontsize=10)
        ax.tick_params(labelsize=8)
        ax.locator_params(axis="x", nbins=5)
    charts.legend(figure, note=note(*(scenario for scenario, _ in runs.values())))
    return figure


def _wanders(settled: Settled) -> bool:
    """Return True if the mean velocity of the settled mass centre is not zero within its error."""
    velocities = _means(settled, settled.motion.t, settled.motion.centre)[1]
    if len(velocities) < 2:
        return bool(np.any(velocities != 0.0))
    speed = float(np.sqrt(np.mean(np.sum(velocities**2, axis=1))))
    spread = float(np.sqrt(np.mean(np.sum(np.diff(velocities, axis=0) ** 2, axis=1)) / 2.0))
    # three times the spread from period to period, and round-off relative to the speed of the plate
    return speed > max(3.0 * spread, 1e-9 * settled.scales[1])


def _means(settled: Settled, t: Floats, path: Floats) -> tuple[Floats, Floats]:
    """Return the middle times of successive periods of the motion [s], and the mean velocities in them [m/s]."""
    span = float(settled.summary()["period"] or 1) / settled.motion.scenario.frequency
    edges = t[-1] - span * np.arange(int((t[-1] - t[0]) / span + 1e-9), -1.0, -1.0)
    places = np.column_stack([np.interp(edges, t, column) for column in path.T])
    return edges[:-1] + span / 2.0, np.diff(places, axis=0) / span


def _show_square(ax: Axes, path: Floats) -> None:
    """Set the limits of the axes to a square around the path, with equal scales."""
    low, high = path.min(axis=0), path.max(axis=0)
    half = 0.58 * float((high - low).max())
    (x, y) = (low + high) / 2.0
    ax.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect="equal")


def _turn(path: Floats) -> Floats:
    """Return the rotation matrix R for which ``path @ R`` leads from start to end along the first axis."""
    c, s = (path[-1] - path[0]) / max(float(np.hypot(*(path[-1] - path[0]))), 1e-300)
    return np.array([[c, -s], [s, c]])


def _arrows(ax: Axes, t: Floats, path: Floats, times: Floats, velocities: Floats) -> None:
    """Draw six of the mean velocities as arrows, each at the place of the mass centre at its time."""
    if len(times) == 0:
        return
    at = np.unique(((np.arange(6) + 0.5) / 6 * len(times)).astype(int))
    places = [np.interp(times[at], t, column) for column in path.T]
    scale = max(float(np.hypot(*velocities[at].T).max()), 1e-300) / 0.1
    sizes: dict[str, Any] = {"angles": "xy", "scale_units": "width", "scale": scale, "width": 0.009, "zorder": 3}
    ax.quiver(*places, *velocities[at].T, color="tab:blue", label="mean velocity", **sizes)
