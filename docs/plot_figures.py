"""Draw the overview of the page on plotting: ``python docs/plot_figures.py docs/pages/figures``."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

import nonsmooth as ns
from nonsmooth.bodies import Ball, Plate
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral


def main() -> None:
    """Save the figure in the folder given."""
    matplotlib.use("Agg")
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.017), impact=EnergeticImpact(0.7))
    system.place(ball, position=(0.0, 0.0, 0.12), velocity=(0.6, 0.0, 0.0))
    ns.simulate(system, 1.2).plot().savefig(Path(sys.argv[1]) / "overview_ball.png", dpi=90)


if __name__ == "__main__":
    main()
