"""Draw the pictures of the pages on studies: ``python docs/study_figures.py docs/pages/figures``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from nonsmooth.scenarios.bouncing_ball import BouncingBall

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.bodies import Ball, Plate
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.studies.derivatives import pictures


def grid() -> Any:
    """Draw the last flight over two parameters, with the closed form of the least vibration."""
    restitution = np.linspace(0.5, 0.9, 21)
    sampling = studies.grid(restitution=restitution, gamma=np.linspace(0.2, 2.0, 19))
    with tempfile.TemporaryDirectory() as folder:
        study = studies.Study(BouncingBall(t_end=2.0), sampling, record=["last_flight"])
        figure = studies.draw_study(study.run(f"{folder}/grid.zarr"))
    axes = figure.axes[0]
    fold = np.pi * (1.0 - restitution) / (1.0 + restitution)
    inside = fold > 0.2
    axes.plot(fold[inside], restitution[inside], "r--", linewidth=2.0, label=r"$\pi(1-e)/(1+e)$")
    axes.legend(loc="upper right")
    return figure


def _dropped(height: float, restitution: float) -> ns.System:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    impact = EnergeticImpact(restitution)
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=impact)
    system.place(ball, position=(0.0, 0.0, 0.01 + height))
    return system


def derivatives() -> Any:
    """Draw the derivatives of the velocity of a bouncing ball over time."""
    family = studies.Family(_dropped, {"height": 0.1, "restitution": 0.7}, units={"height": "m"})
    found = studies.sensitivity(family, ("height", "restitution"), at=np.linspace(0.01, 0.5, 50))
    return pictures.sensitivities(found, "vz").figure


def main() -> None:
    """Save the figures in the folder given."""
    matplotlib.use("Agg")
    for name, draw in {"study_grid": grid, "study_derivatives": derivatives}.items():
        draw().savefig(Path(sys.argv[1]) / f"{name}.png", dpi=100)


if __name__ == "__main__":
    main()
