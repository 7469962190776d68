"""Draw the figures of the catalogue of laws: ``python docs/law_figures.py docs/pages/figures``."""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from compliant_figures import compliance
from law_axes import GREY, make_axes
from traction_figures import traction

import laws
import nonsmooth as ns

_E, _MU, _TILT = 0.9, 0.5, math.radians(40.0)
_SLIPS = np.linspace(-3.0, 3.0, 121)


def _curve(law: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return indentation and force of one contact, over those at the end of compression, through both phases."""
    x = np.linspace(0.0, 1.0, 201)
    values = law.parameters()
    force = np.array([law.force(one, values["stiffness"], values["exponent"]) for one in x])
    share = law.efficiency(0.0, law.restitution)
    falling = law.efficiency(1.0, law.restitution)
    back = x[::-1][x[::-1] ** (values["exponent"] + 1.0) >= 1.0 - share]
    # the deformation-like coordinate runs back 1 / falling times as fast as the indentation
    way = 1.0 - falling * (1.0 - back)
    forces = np.interp(back, x, force)
    return np.concatenate([x, way, way[-1:]]), np.concatenate([force, forces, [0.0]])


def indentation() -> Mapping[str, Any]:
    """Draw force over indentation of the two energetic laws."""
    titles = {
        "energetic": "Bi-stiffness: expansion falls along a steeper curve",
        "mono_stiffness": "Mono-stiffness: expansion goes back the same way and lets go",
    }
    kinds = {"energetic": laws.EnergeticImpact, "mono_stiffness": laws.MonoStiffnessImpact}
    figures = {}
    for name, title in titles.items():
        figure, (axis,) = make_axes(title)
        for e, look in ((1.0, ":"), (0.8, "-"), (0.5, "--")):
            axis.plot(*_curve(kinds[name](e)), linestyle=look, color="black" if e < 1.0 else "0.5", label=f"e = {e:g}")
        axis.set_xlabel("indentation / largest")
        axis.set_ylabel("normal force / largest")
        axis.legend(frameon=False, fontsize=8)
        figures[f"law_{name}"] = figure
    return figures


def _rod() -> np.ndarray:
    """Return G of the end of a slender rod of unit mass and length, tilted, that strikes a plane."""
    across, along = 0.5 * math.sin(_TILT), 0.5 * math.cos(_TILT)
    columns = np.array([[0.0, 1.0, across], [1.0, 0.0, -along]])
    delassus = np.diag([0.0, 0.0, 1.0])
    delassus[:2, :2] = columns @ np.diag([1.0, 1.0, 12.0]) @ columns.T
    return delassus


def _response(law: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return slip after and energy after over energy before, for a unit approach and all slips."""
    delassus = _rod()
    names = list(inspect.signature(law.impulses).parameters)[5:]
    values = [np.array([law.parameters()[name]]) for name in names]
    slips, energies = [], []
    for slip in _SLIPS:
        before, out = np.array([-1.0, slip, 0.0]), np.zeros(3)
        law.impulses(1, delassus.ravel(), before, out, np.array([_MU]), *values)
        after = before + delassus @ out
        energy = [z[:2] @ np.linalg.solve(delassus[:2, :2], z[:2]) for z in (before, after)]
        slips.append(after[1])
        energies.append(energy[1] / energy[0])
    return np.array(slips), np.array(energies)


def maps() -> Mapping[str, Any]:
    """Draw what each map does to a tilted rod that strikes and slides."""
    kinds = {
        "newton": ("Newton: friction by the last slip alone may gain energy", laws.NewtonImpact(_E)),
        "moreau": ("Moreau, $e_T = e_N$: slip comes back, energy does not grow", laws.MoreauImpact(_E, _E)),
        "poisson": ("Poisson: two phases, friction by the slip at the end of each", laws.PoissonImpact(_E)),
        "plastic": ("Plastic: the contact stays closed", laws.PlasticImpact()),
        "stronge": ("Stronge: slip, stick and reversal are followed", laws.StrongeImpact(_E)),
    }
    reference = _response(laws.StrongeImpact(_E))
    figures = {}
    for name, (title, law) in kinds.items():
        figure, axes = make_axes(f"{title}\nend of a rod, tilted by 40 degrees, e = {_E:g}, µ = {_MU:g}", 2)
        for axis, own, other, label in zip(
            axes, _response(law), reference, ("slip after / approach", "energy after / before"), strict=True
        ):
            axis.plot(_SLIPS, own, color="black", label=name)
            if name != "stronge":
                axis.plot(_SLIPS, other, label="energetic", **GREY)
            axis.set_xlabel("slip before / approach")
            axis.set_ylabel(label)
        axes[0].axhline(0.0, color="0.7", linewidth=0.8)
        axes[1].axhline(1.0, color="tab:red", linewidth=0.8)
        axes[1].set_ylim(0.0, 1.4)
        axes[0].legend(frameon=False, fontsize=8)
        figures[f"law_{name}"] = figure
    return figures


def restitution() -> Mapping[str, Any]:
    """Draw the coefficients that depend on the approach speed: formula, and what the impact does."""
    speeds = np.geomspace(1e-4, 1e3, 200)
    figures = {}
    for name, title, law, formula in (
        ("johnson", "Johnson: plastic flow, the fourth root of the speed", laws.JohnsonImpact(1.0), "johnson"),
        ("viscoelastic", "Viscoelastic spheres: elastic when slow", laws.ViscoelasticImpact(1.0), "viscoelastic"),
    ):
        figure, (axis,) = make_axes(title)
        e = getattr(laws, f"{formula}_restitution")
        axis.semilogx(speeds, [e(v, 1.0) for v in speeds], color="black", label="formula")
        few = speeds[::12]
        done = [
            ns.solve_impact([[1.0]], [[1.0]], [[[0.0, 0.0]]], [-v], [law], [laws.Frictionless()]).velocity[0] / v
            for v in few
        ]
        axis.semilogx(few, done, "o", fillstyle="none", markersize=5, color="tab:red", label="impact, integrated")
        if name == "viscoelastic":
            slow = speeds[speeds < 0.3]
            series = 1.0 - 1.15344 * slow**0.2 + 0.6 * 1.15344**2 * slow**0.4
            axis.semilogx(slow, series, label="series, two terms", **GREY)
        axis.set_ylim(0.0, 1.05)
        axis.set_xlabel("approach speed / $v_1$")
        axis.set_ylabel("coefficient of restitution")
        axis.legend(frameon=False, fontsize=8)
        figures[f"law_{name}"] = figure
    return figures


def friction() -> Mapping[str, Any]:
    """Draw the friction coefficients over the slip velocity, signed, with the range at rest."""
    figures = {}
    slips = np.linspace(1e-9, 2.0, 400)
    for name, title, law in (
        ("frictionless", "Frictionless", laws.Frictionless()),
        ("coulomb", "Coulomb: µ = 0.3, static 0.4", laws.Coulomb(0.3, 0.4)),
        ("stribeck", "Stribeck: falls with the slip speed", laws.Stribeck(0.4, 3.0, 0.1)),
        ("viscous", "Viscous: rises with the slip speed, up to a bound", laws.Viscous(0.2, 0.25, 0.6)),
    ):
        figure, (axis,) = make_axes(title)
        values = list(law.parameters().values())
        mu = np.array([law.coefficient(float(v), *values) for v in slips])
        rest = law.coefficient(0.0, *values)
        for side in (-1.0, 1.0):
            axis.plot(side * slips, -side * mu, color="black")
        axis.plot([0.0, 0.0], [-rest, rest], color="tab:red", linewidth=2.0, label="at rest: any force up to here")
        axis.axhline(0.0, color="0.7", linewidth=0.8)
        axis.set_ylim(-0.8, 0.8)
        axis.set_xlabel("slip velocity [m/s]")
        axis.set_ylabel("friction force / normal force")
        axis.legend(frameon=False, fontsize=8)
        figures[f"law_{name}"] = figure
    return figures


def main() -> None:
    """Save all figures in the folder given."""
    folder = Path(sys.argv[1])
    for draw in (indentation, maps, restitution, friction, compliance, traction):
        for name, figure in draw().items():
            figure.savefig(folder / f"{name}.png", dpi=110)
            plt.close(figure)


if __name__ == "__main__":
    main()
