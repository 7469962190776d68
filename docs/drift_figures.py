"""Draw the drift of the dumbbell with other impact laws: ``python docs/drift_figures.py docs/pages/figures``."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from nonsmooth.scenarios.dumbbell import DumbbellScenario
from nonsmooth.scenarios.dumbbell.trace import note

import nonsmooth as ns
from nonsmooth import charts
from nonsmooth.interfaces import ImpactLaw
from nonsmooth.laws import (
    EnergeticImpact,
    JohnsonImpact,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    ViscoelasticImpact,
)
from nonsmooth.system.replacing import with_laws

Ran = tuple[DumbbellScenario, ns.Solution]

_TURNED = DumbbellScenario(radius=5e-3, rod_mass_fraction=0.0, restitution=0.6, friction=0.15)
"""Start at which the impact law decides the direction of the drift."""
_STRIKE = 0.25
"""Speed at which ball 2 strikes in the drift [m/s]; there the laws that depend on it have the e of the others."""
_VISCOELASTIC = 33.8
"""Ratio of the reference speed to the speed at which e is 0.6."""
_SPRINGS = 3.13e-3
"""Drift velocity with these parameters on springs in real time [m/s], by tests/benchmarks/compliant.py."""
_PAIR = "energetic (compliant limit)", "Newton, in one step"
_MOVED = "displacement of the mass centre along y [mm]"


def main() -> None:
    """Save both figures in the folder given."""
    matplotlib.use("Agg")
    starts = DumbbellScenario(mode="drift"), _TURNED
    both = [[dataclasses.replace(start, impact=law) for law in ("energetic", "newton")] for start in starts]
    pairs = [[(scenario, ns.run_scenario(scenario)) for scenario in pair] for pair in both]
    for stem, figure in {"drift_two_laws": drift_by_law(pairs), "drift_all_laws": drifts_of_all(_TURNED)}.items():
        figure.savefig(Path(sys.argv[1]) / f"{stem}.png", dpi=110)


def drift_by_law(pairs: Sequence[Sequence[Ran]]) -> Figure:
    """Draw the displacement of the mass centre along the rod's first direction (y) by both laws, a panel for each pair.

    The first run of a pair is by the energetic law, the second one by Newton's; other parameters are the same.
    """
    title = "The impact law decides how fast the dumbbell drifts, and with some parameters even where to"
    figure, axes = charts.panels(1, len(pairs), title, (10.0, 4.8))
    for ax, pair in zip(axes, pairs, strict=True):
        for place, (name, ran) in enumerate(zip(_PAIR, pair, strict=True)):
            (t, moved, speed), style = _drift(*ran), charts.line(place)
            ax.plot(t, moved, label=name, **style)
            middle, offset = len(moved) // 2, (6, -12 if speed > 0.0 else 6)
            text = {"xytext": offset, "textcoords": "offset points", "fontsize": 8, "color": style["color"]}
            ax.annotate(f"{speed:+.1f} mm/s", (t[middle], moved[middle]), **text)
        used = pair[0][0].resolved()
        words = (f"e = {used['restitution']:g}", f"µ = {used['friction']:g}", f"rod mass {used['rod_mass_fraction']:g}")
        ax.set_title(", ".join(words), fontsize=10)
        ax.set_xlabel("time [s]")
        ax.axhline(0.0, color="0.6", linewidth=0.8)
    axes[0].set_ylabel(_MOVED)
    charts.legend(figure, note=note(*(scenario for pair in pairs for scenario, _ in pair)))
    return figure


def drifts_of_all(scenario: DumbbellScenario) -> Figure:
    """Run all impact laws from one start; draw displacements over time and the velocities that they settle to."""
    title = "Laws that follow the slip through the impact drift as springs do, maps the other way"
    figure, (over_time, bars) = charts.panels(1, 2, title, (10.0, 5.2))
    names = []
    for place, (name, law) in enumerate(_laws(scenario).items()):
        system = with_laws(scenario.build(), impact=law)
        solution = ns.simulate(system, scenario.t_end, sample_interval=scenario.sample_interval)
        t, moved, speed = _drift(scenario, solution)
        dashes, marker = ("-", "--", ":")[place % 3], ("", "o", "s")[place // 3]
        style: dict[str, Any] = {
            "linestyle": dashes,
            "marker": marker,
            "markevery": 0.1,
            "markersize": 4,
            "linewidth": 1.5,
        }
        over_time.plot(t, moved, label=name, color=f"C{place}", **style)
        bar = bars.barh(place, speed, color=f"C{place}", height=0.6)
        bars.bar_label(bar, [f"{speed:+.2f}" if round(speed, 2) else "0"], padding=4, fontsize=8)
        settles = scenario.summarise(solution)["attractor"] in ("drift", "rest")
        names.append(name if settles else f"{name} (not periodic)")
    over_time.axhline(0.0, color="0.4", linewidth=0.8)
    over_time.set(xlabel="time [s]", ylabel=_MOVED)
    bars.axvline(0.0, color="0.4", linewidth=0.8)
    bars.axvline(1e3 * _SPRINGS, color="black", linestyle="--", linewidth=1.2)
    bars.annotate("stiff springs", (1e3 * _SPRINGS, 6.0), xytext=(4, 0), textcoords="offset points", fontsize=8)
    bars.set_yticks(np.arange(len(names)), names, fontsize=8)
    bars.invert_yaxis()
    bars.set(xlabel="settled velocity of the mass centre along y [mm/s]", xlim=(-15.0, 10.0))
    charts.legend(figure, columns=5, note=note(scenario, impact="as named"))
    return figure


def _drift(scenario: DumbbellScenario, solution: ns.Solution) -> tuple[np.ndarray, np.ndarray, float]:
    """Return times [s], displacements of the mass centre along y [mm], and the velocity that it settles to [mm/s]."""
    motion = scenario.motion(solution)
    y = motion.centre[:, 1]
    return motion.t, 1e3 * (y - y[0]), 1e3 * scenario.summarise(solution)["drift_velocity"][1]


def _laws(scenario: DumbbellScenario) -> dict[str, ImpactLaw]:
    """Return the impact laws for any number of contacts, with the scenario's coefficient if they have one."""
    used = scenario.resolved()
    e, duration = float(used["restitution"]), float(used["contact_time"])
    return {
        "energetic": EnergeticImpact(e, duration=duration),
        "mono-stiffness": MonoStiffnessImpact(e, duration=duration),
        "viscoelastic": ViscoelasticImpact(_VISCOELASTIC * _STRIKE, duration=duration),
        "Johnson": JohnsonImpact(e**4 * _STRIKE, duration=duration),
        "plastic": PlasticImpact(duration=duration),
        "Moreau, $e_T = e$": MoreauImpact(e, e, duration=duration),
        "Poisson": PoissonImpact(e, duration=duration),
        "Moreau, $e_T = 0$": MoreauImpact(e, 0.0, duration=duration),
        "Newton": NewtonImpact(e, duration=duration),
    }


if __name__ == "__main__":
    main()
