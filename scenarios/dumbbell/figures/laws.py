"""Figs. 12 and 13: what the impact law does to the drift."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from laws import (
    EnergeticImpact,
    JohnsonImpact,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    ViscoelasticImpact,
)
from nonsmooth.interfaces import ImpactLaw
from nonsmooth.runs.simulate import simulate
from nonsmooth.system.system import System
from scenarios.dumbbell.figures import style
from scenarios.dumbbell.figures.paths import Run
from scenarios.dumbbell.scenario import DumbbellScenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = (style.CURVE, style.OTHER)
_NAMES = "energetic (compliant limit)", "Newton, in one step"
_STRIKE = 0.25
"""Speed at which ball 2 strikes in the drift [m/s]; there the laws that depend on it have the e of the others."""
_VISCOELASTIC = 33.8
"""Ratio of the reference speed to the speed at which e is 0.6."""

_SPRINGS = 3.13e-3
"""What springs in real time drift at with these parameters [m/s], by tests/benchmarks/compliant.py."""


def catalogue(scenario: DumbbellScenario) -> dict[str, ImpactLaw]:
    """Return the impact laws for any number of contacts, with the scenario's coefficient where they have one."""
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


def with_law(scenario: DumbbellScenario, law: ImpactLaw) -> System:
    """Return the scenario's system with another impact law."""
    built = scenario.build()
    contact = built.contacts[0]
    system = System(built.bodies, gravity=-built.gravity[2])
    system.contact(contact.first, contact.second, normal=contact.normal, friction=contact.friction, impact=law)
    for body in built.bodies:
        system.set_start(body, *built.start(body))
    return system


def drifts_of_all(scenario: DumbbellScenario, title: str) -> Figure:
    """Run all impact laws from one start; draw displacements over time and the velocities that they settle to."""
    figure, (paths, bars) = style.new_figure(title, style.footnote(scenario, impact="as named"), panels=2, width=10.0)
    names, speeds = [], []
    for number, (name, law) in enumerate(catalogue(scenario).items()):
        interval = scenario.sample_interval
        solution = simulate(with_law(scenario, law), scenario.t_end, sample_interval=interval)
        summary, motion = scenario.summarise(solution), scenario.motion(solution)
        names.append(name if summary["attractor"] in ("drift", "rest") else f"{name} (not periodic)")
        speeds.append(1e3 * summary["drift_velocity"][1])
        moved = 1e3 * (motion.centre[:, 1] - motion.centre[0, 1])
        look: dict[str, Any] = {
            "linestyle": ("-", "--", ":")[number % 3],
            "marker": ("", "o", "s")[number // 3],
            "markevery": 0.1,
        }
        paths.plot(motion.t, moved, label=name, color=f"C{number}", markersize=4, linewidth=1.5, **look)
        bars.barh(number, speeds[-1], color=f"C{number}", height=0.6)
        left = speeds[-1] < 0.0
        bars.annotate(
            f"{speeds[-1]:+.2f}" if round(speeds[-1], 2) else "0",
            (speeds[-1], number),
            xytext=(-4 if left else 4, 0),
            textcoords="offset points",
            ha="right" if left else "left",
            va="center",
            fontsize=8,
        )
    for axis in (paths, bars):
        (axis.axhline if axis is paths else axis.axvline)(0.0, color="0.4", linewidth=0.8)
    paths.set_xlabel("time [s]")
    paths.set_ylabel("displacement of the mass centre along y [mm]")
    bars.set_yticks(np.arange(len(names)), names, fontsize=8)
    bars.invert_yaxis()
    bars.axvline(1e3 * _SPRINGS, color="black", linestyle="--", linewidth=1.2)
    bars.annotate("stiff springs", (1e3 * _SPRINGS, 6.0), xytext=(4, 0), textcoords="offset points", fontsize=8)
    bars.set_xlim(-15.0, 10.0)
    bars.set_xticks(np.arange(-15.0, 11.0, 5.0))
    bars.set_xlabel("settled velocity of the mass centre along y [mm/s]")
    style.legend([paths], columns=5)
    return figure


def drift_by_law(pairs: Sequence[tuple[Run, Run]], title: str) -> Figure:
    """Draw the displacement of the mass centre along the rod's first direction (y) by both laws, a panel for each pair.

    The first run of a pair is by the energetic law, the second one by Newton's; other parameters are the same.
    """
    note = style.footnote(*(scenario for pair in pairs for scenario, _ in pair))
    figure, axes = style.new_figure(title, note, len(pairs), width=10.0)
    for axis, pair in zip(axes, pairs, strict=True):
        axis.axhline(0.0, color="0.6", linewidth=0.8)
        for look, name, (scenario, solution) in zip(_LOOKS, _NAMES, pair, strict=True):
            motion = scenario.motion(solution)
            speed = 1e3 * scenario.summarise(solution)["drift_velocity"][1]
            moved = 1e3 * (motion.centre[:, 1] - motion.centre[0, 1])
            axis.plot(motion.t, moved, label=name, **look)
            half = len(moved) // 2
            axis.annotate(
                f"{speed:+.1f} mm/s", (motion.t[half], moved[half]), xytext=(6, -12 if speed > 0.0 else 6),
                textcoords="offset points", fontsize=8, color=look["color"],
            )  # fmt: skip
        used = pair[0][0].resolved()
        words = (f"e = {used['restitution']:g}", f"µ = {used['friction']:g}", f"rod mass {used['rod_mass_fraction']:g}")
        axis.set_title(", ".join(words), fontsize=10)
        axis.set_xlabel("time [s]")
    axes[0].set_ylabel("displacement of the mass centre along y [mm]")
    style.legend(axes)
    return figure
