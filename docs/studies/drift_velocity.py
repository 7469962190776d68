"""Drift velocity of the dumbbell over friction and aspect ratio, for each impact law.

    python docs/studies/drift_velocity.py drift_velocity.zarr drift_velocity.png [N]

N x N runs for each of six laws, 24 x 24 by default; cut off, it goes on where it was.
"""

from __future__ import annotations

import sys

import matplotlib
import numpy as np
import xarray
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure
from nonsmooth.scenarios.dumbbell import DumbbellScenario

from nonsmooth import Solution, studies

LAWS = ["energetic", "mono_stiffness", "moreau", "poisson", "newton", "plastic"]


def drift_velocity(scenario: DumbbellScenario, solution: Solution) -> float | None:
    """Mean velocity along the rod where the dumbbell drifts [m/s]."""
    found = scenario.summarise(solution)
    return found["drift_velocity"][1] if found["attractor"] == "drift" else None


def drawn(found: xarray.Dataset) -> Figure:
    """Draw a map for each law, all with one scale."""
    millimetres = 1e3 * found.drift_velocity
    most = float(np.nanmax(np.abs(millimetres)))
    figure = Figure(figsize=(10.0, 6.2), layout="constrained")
    panels = figure.subplots(2, 3, sharex=True, sharey=True)
    for law, axes in zip(LAWS, panels.flat, strict=True):
        one = millimetres.sel(impact=law).transpose("aspect_ratio", "friction")
        mesh = axes.pcolormesh(
            one.friction, one.aspect_ratio, one, cmap="RdBu_r", norm=SymLogNorm(1.0, 1.0, -most, most)
        )
        if one.min() < 0.0 < one.max():
            axes.contour(one.friction, one.aspect_ratio, one, levels=[0.0], colors="black", linewidths=1.0)
        axes.set_facecolor("0.8")
        axes.set_title(f"{law}: {int(one.notnull().mean() * 100)} % drift", fontsize=10)
    figure.supxlabel("friction coefficient mu [1]")
    figure.supylabel("aspect ratio A_r [1]")
    figure.colorbar(mesh, ax=panels, label="drift velocity [mm/s]; line: 0; grey: no drift")
    return figure


if __name__ == "__main__":
    matplotlib.use("Agg")
    store, picture, n = sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 24
    over = studies.grid(impact=LAWS, friction=np.linspace(0.02, 0.5, n), aspect_ratio=np.linspace(3.0, 6.5, n))
    study = studies.Study(DumbbellScenario(mode="drift"), over, record=["attractor", drift_velocity])
    drawn(study.run(store)).savefig(picture, dpi=120)
