"""All figures of the scenario, and those of one run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from nonsmooth.runs.simulate import Progress, simulate
from nonsmooth.solution.solution import Solution
from scenarios.dumbbell.figures.laws import drift_by_law, drifts_of_all
from scenarios.dumbbell.figures.motions import normal_motion
from scenarios.dumbbell.figures.paths import Run, goes, paths
from scenarios.dumbbell.figures.portraits import portrait, turns
from scenarios.dumbbell.figures.trace import Trace
from scenarios.dumbbell.figures.velocities import normal_velocity, tangential_velocity
from scenarios.dumbbell.scenario import DumbbellScenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ACROSS = {"transverse_velocity": 1.0}
_ONE_DEGREE = {"mode": "jump", "beta0": math.radians(1.0)}
_TURNED = {"radius": 5e-3, "rod_mass_fraction": 0.0, "restitution": 0.6, "friction": 0.15, "t_end": 4.0}
_RUNS: dict[str, dict[str, Any]] = {
    "drift": {"mode": "drift"},
    "jump": {"mode": "jump"},
    "jump 1": _ONE_DEGREE,
    "flutter": {"mode": "flutter", "t_end": 8.0},
    "drift 3D": {"mode": "drift", "t_end": 24.0} | _ACROSS,
    # the level orbit is not stable: in a long run round-off tilts it
    "jump 3D": {"mode": "jump", "t_end": 0.5} | _ACROSS,
    "flutter 3D": {"mode": "flutter", "t_end": 8.0} | _ACROSS,
    "newton": {"mode": "drift", "impact": "newton"},
    "energetic turned": _TURNED | {"impact": "energetic"},
    "newton turned": _TURNED | {"impact": "newton"},
}
_ANGLES = {
    "theta": (
        "fig08_theta",
        "the heading: drift turns about the vertical, flutter swings; jump, not shown, does not turn",
    ),
    "beta": ("fig09_beta", "the tilt: closed, as the normal motion is periodic; jump, not shown, stays level"),
    "gamma": ("fig10_gamma", "the roll: open in all three modes, the dumbbell rolls along"),
}
_SPANS = {"drift": 600.0, "jump": 8.0, "flutter": 8.0}
"""Plate periods of path to show."""
_PERIODS = {"drift": 3.0, "jump": 3.0, "flutter": 4.0, "free": 6.0}
"""Plate periods of motion to show."""


def all_figures(kind: type[DumbbellScenario], progress: Progress | None) -> dict[str, Figure]:
    """Run the paper's starts and draw Figs. 2 to 13."""
    scenarios = {name: kind(**parameters) for name, parameters in _RUNS.items()}
    total = sum(scenario.t_end for scenario in scenarios.values())
    done = 0.0
    runs: dict[str, Run] = {}
    for name, scenario in scenarios.items():
        interval = scenario.sample_interval
        runs[name] = scenario, simulate(scenario.build(), scenario.t_end, sample_interval=interval)
        done += scenario.t_end
        if progress is not None:
            progress(done, total)
    figures = _motions({name: runs[name] for name in ("drift", "jump", "jump 1", "flutter")})
    across = {mode: runs[f"{mode} 3D"] for mode in ("drift", "jump", "flutter")}
    figures |= _portraits(across, ("theta", "beta", "gamma"))
    sight = "Paths from above: drift circles, jump goes straight, flutter zigzags"
    figures["fig11_paths"] = paths(across, _SPANS, sight)
    laws = [(runs["drift"], runs["newton"]), (runs["energetic turned"], runs["newton turned"])]
    title = "The impact law decides how fast the dumbbell drifts, and with some parameters even where to"
    figures["fig12_impact_laws"] = drift_by_law(laws, title)
    title = "Laws that follow the slip through the impact drift as springs do, maps the other way"
    figures["fig13_all_impact_laws"] = drifts_of_all(scenarios["energetic turned"], title)
    return figures


def of_run(scenario: DumbbellScenario, solution: Solution) -> dict[str, Figure]:
    """Draw the figures of one run's mode; none of a run without samples, and none of what stays as it is."""
    if len(solution.t) < 2:
        return {}
    mode = scenario.mode
    tilted = mode == "jump" and scenario.resolved()["beta0"] != 0.0
    runs: dict[str, Run] = {mode: (scenario, solution)}
    figures = _motions({"jump 1" if tilted else mode: (scenario, solution)})
    figures |= _portraits(runs, ("theta", "beta", "gamma") if scenario.transverse_velocity else ("beta",))
    periods = {mode: _SPANS["flutter"] if mode == "flutter" else scenario.t_end * scenario.frequency}
    if goes(runs[mode]):
        figures["fig11_path"] = paths(runs, periods, _way(scenario, solution))
    return figures


def _way(scenario: DumbbellScenario, solution: Solution) -> str:
    summary = scenario.summarise(solution)
    speed = 1e3 * math.hypot(*summary["drift_velocity"])
    return f"From above: settled, the mass centre goes on at {speed:.3g} mm/s (attractor: {summary['attractor']})"


def _motions(runs: Mapping[str, Run]) -> dict[str, Figure]:
    figures: dict[str, Figure] = {}
    for name, (scenario, solution) in runs.items():
        trace = Trace.of(scenario, solution, _PERIODS[scenario.mode])
        attractor = scenario.summarise(solution)["attractor"]
        for stem, draw, claim, neutral in _PLOTS[name]:
            # a title must not promise what other parameters did not bring about
            figures[stem] = draw(trace, claim if attractor == scenario.mode else f"{neutral} (attractor: {attractor})")
    return figures


_HEIGHTS = "Heights of both balls and the plate at the end of the run"
_PLOTS: dict[str, tuple[tuple[str, Callable[[Trace, str], Figure], str, str], ...]] = {
    "drift": (
        (
            "fig02_drift_motion",
            normal_motion,
            "Drift: one ball keeps to the plate, the other strikes once per plate period",
            _HEIGHTS,
        ),
        (
            "fig03_drift_tangential_velocity",
            tangential_velocity,
            "Drift: the slip of ball 1 is not symmetric, so that friction moves the dumbbell",
            "Slip of ball 1 at the end of the run",
        ),
    ),
    "jump": (
        ("fig04_jump_motion", normal_motion, "Jump: both balls strike together, once per plate period", _HEIGHTS),
    ),
    "jump 1": (
        (
            "fig05_jump_tilted_motion",
            normal_motion,
            "Jump from a tilt: the balls strike one after the other",
            _HEIGHTS,
        ),
        (
            "fig06_jump_tilted_normal_velocity",
            normal_velocity,
            "Jump from a tilt: two single impacts per plate period instead of a double one",
            "Normal velocity of ball 1 at the end of the run",
        ),
    ),
    "flutter": (
        (
            "fig07_flutter_motion",
            normal_motion,
            "Flutter: the balls strike in turn, each every second plate period",
            _HEIGHTS,
        ),
    ),
    "free": (("free_motion", normal_motion, _HEIGHTS, _HEIGHTS),),
}
"""Name of the run: file stem, drawing, title where the run is in its mode, title elsewhere."""


def _portraits(runs: Mapping[str, Run], angles: tuple[str, ...]) -> dict[str, Figure]:
    traces = {mode: Trace.of(*run, _PERIODS[run[0].mode]) for mode, run in runs.items()}
    figures = {}
    for angle in angles:
        stem, sight = _ANGLES[angle]
        single = f"Phase portrait of {angle} at the end of the run"
        turning = {mode: trace for mode, trace in traces.items() if turns(angle, trace)}
        if turning:
            title = f"Phase portraits of {angle},\n{sight}" if len(runs) > 1 else single
            figures[stem] = portrait(angle, turning, title)
    return figures
