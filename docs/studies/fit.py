"""Restitution and friction of the drifting dumbbell, fitted to positions that were measured with an error.

    python docs/studies/fit.py fit.png [SEED]

The measurements are made up: 20 positions of the mass centre in 0.2 s of a run with e = 0.65 and mu = 0.2, each
coordinate off by a normal deviate of 0.02 mm.
"""

from __future__ import annotations

import sys

import matplotlib
import numpy as np
from nonsmooth.scenarios.dumbbell import DumbbellScenario
from numpy.typing import NDArray

from nonsmooth import State
from nonsmooth.studies import Family, fit
from nonsmooth.studies.derivatives.pictures import fitted

TRUE, NOISE = {"restitution": 0.65, "friction": 0.2}, 2e-5
TIMES = np.linspace(0.01, 0.2, 20)
BOUNDS = {"restitution": (0.5, 0.8), "friction": (0.1, 0.3)}


def place(state: State) -> NDArray[np.float64]:
    """Where the mass centre is along and above the plate [m]."""
    return state.q[1:3]


def main() -> None:
    """Measure, fit, draw."""
    matplotlib.use("Agg")
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    family = Family.of(DumbbellScenario(mode="drift"))
    exact = family.at(**TRUE).model().run(TIMES[-1]).at(TIMES)["q"][:, 1:3]
    measured = exact + NOISE * np.random.default_rng(seed).standard_normal(exact.shape)
    begin = family.at(restitution=0.55, friction=0.25)
    found = fit(begin, BOUNDS, at=TIMES, measured=measured, observe=place)
    for name, true in TRUE.items():
        error = found.standard_errors[name]
        off = (found.values[name] - true) / error
        print(f"{name} {found.values[name]:.5f} +- {error:.5f}, {off:+.1f} standard errors from {true}")
    print(f"left over: {1e3 * found.deviation:.4f} mm")
    fitted(found, "position [m]", ("y", "z")).savefig(sys.argv[1], dpi=120)


if __name__ == "__main__":
    main()
