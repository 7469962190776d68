"""The jumping ball over the strength of the vibration: where it comes to, its orbits, and the closed-form bounds.

    python docs/studies/ball_bifurcation.py ball_bifurcation.png [N]

N values up and down again, 160 by default.
"""

import math
import sys

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from nonsmooth.scenarios.bouncing_ball import BouncingBall

from nonsmooth.studies.orbits import continuation, hysteresis, orbit
from nonsmooth.studies.orbits.pictures import branch as draw_branch

E, PERIOD, RANGE = 0.8, 0.04, (0.3, 1.3)
FOLD = math.pi * (1.0 - E) / (1.0 + E)
DOUBLING = math.hypot(FOLD, 2.0 * (1.0 + E**2) / (1.0 + E) ** 2)


def main() -> None:
    """Follow, compare, draw."""
    matplotlib.use("Agg")
    n = int(sys.argv[2]) if len(sys.argv) > 2 else 160
    ball = BouncingBall(restitution=E, gamma=0.8, start_phase=1.1, speed=0.19)
    once = continuation(orbit(ball, PERIOD, within=("z", "vz")), "gamma", RANGE)
    for kind, bound in (("fold", FOLD), ("period doubling", DOUBLING)):
        found = next(one.value for one in once.special if one.kind == kind)
        print(f"{kind:<16} found at gamma = {found:.10f}, in closed form {bound:.10f}, apart {abs(found - bound):.0e}")
    ways = hysteresis(ball, "gamma", np.linspace(*RANGE, n), PERIOD, "vz", at=0.02, settle=200, keep=48)
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes = ways.draw(figure.subplots())
    draw_branch(once, lambda one: one.value("vz", at=0.02), "vz, once a period [m/s]", axes)
    for bound, name in ((FOLD, "fold"), (DOUBLING, "doubling")):
        axes.axvline(bound, color="0.6", linewidth=0.8, zorder=0)
        axes.annotate(f" {name}, closed form", (bound, 0.02), xycoords=("data", "axes fraction"), fontsize=8)
    figure.savefig(sys.argv[1], dpi=120)


if __name__ == "__main__":
    main()
