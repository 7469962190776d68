"""Draw the figures of the pages on orbits and on basins.

``python docs/orbit_figures.py docs/pages/figures`` runs the examples of these pages; it takes two minutes.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from nonsmooth.scenarios.bouncing_ball import BouncingBall

from nonsmooth import progress, studies
from nonsmooth.studies import continuation, hysteresis, orbit
from nonsmooth.studies.attractors.pictures import basins as draw_basins
from nonsmooth.studies.orbits.pictures import branch as draw_branch
from nonsmooth.studies.orbits.pictures import multipliers

_QUIET = progress.Quiet()


def orbits(folder: Path) -> None:
    """Multipliers of an orbit, and a branch with a fold over what motions come to."""
    found = orbit(BouncingBall(gamma=0.8, start_phase=1.0, speed=0.2), 0.04, within=("z", "vz"))
    ball = BouncingBall(gamma=0.38, start_phase=0.4, speed=0.19)
    branch = continuation(orbit(ball, 0.04, within=("z", "vz")), "gamma", (0.3, 0.4), display=_QUIET)
    ways = hysteresis(ball, "gamma", np.linspace(0.3, 0.4, 21), 0.04, "vz", at=0.02, settle=200, keep=8, display=_QUIET)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.2), layout="constrained")
    multipliers(found, left)
    ways.draw(right)
    draw_branch(branch, lambda one: one.value("vz", at=0.02), "vz, once a period [m/s]", right)
    figure.savefig(folder / "orbits_ball.png", dpi=90)


def basins(folder: Path) -> None:
    """Basins of three attractors of a ball on a vibrating table."""
    strobe = studies.Stroboscope(0.04, ("z", "vz"), keep=16, at=0.02, phase="start_phase")
    starts = studies.grid(start_phase=np.linspace(0.0, 6.2, 64), speed=np.linspace(0.05, 0.6, 64))
    with tempfile.TemporaryDirectory() as place:
        study = studies.Study(BouncingBall(gamma=0.8, t_end=6.0), starts, [strobe])
        found = study.run(Path(place) / "ball.zarr", display=_QUIET)
        draw_basins(found.assign(studies.recurrences(found))).savefig(folder / "basins_ball.png", dpi=90)


def main() -> None:
    """Save the figures in the folder given."""
    folder = Path(sys.argv[1])
    for draw in (orbits, basins):
        draw(folder)


if __name__ == "__main__":
    main()
