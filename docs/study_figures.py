"""Draw the map of the page on studies: ``python docs/study_figures.py docs/pages/figures``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np
from nonsmooth.scenarios.bouncing_ball import BouncingBall

from nonsmooth import studies


def main() -> None:
    """Save the figure in the folder given."""
    matplotlib.use("Agg")
    restitution = np.linspace(0.5, 0.9, 21)
    grid = studies.grid(restitution=restitution, gamma=np.linspace(0.2, 2.0, 19))
    with tempfile.TemporaryDirectory() as folder:
        study = studies.Study(BouncingBall(t_end=2.0), grid, record=["last_flight"])
        figure = studies.draw_study(study.run(f"{folder}/grid.zarr"))
    axes = figure.axes[0]
    fold = np.pi * (1.0 - restitution) / (1.0 + restitution)
    inside = fold > 0.2
    axes.plot(fold[inside], restitution[inside], "r--", linewidth=2.0, label=r"$\pi(1-e)/(1+e)$")
    axes.legend(loc="upper right")
    figure.savefig(Path(sys.argv[1]) / "study_grid.png", dpi=100)


if __name__ == "__main__":
    main()
