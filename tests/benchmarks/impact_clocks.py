"""Clocks for an impact: ``python -m tests.benchmarks.impact_clocks``.

One Hertz contact of unit mass, stiffness and speed goes through compression and expansion, its velocity, deformation
and impulse integrated in the pseudo-time s, in sigma with ds = sqrt(x) d(sigma), where sqrt(x) takes the place of the
deformation and all is polynomial, and in a clock that counts impulse, too, by the pairs of order five and eight.
Printed are evaluations and the error of the impulse.  Expansion ends where the deformation does; e = 1, so that no
other event interrupts.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from nonsmooth.types import Array

TOLERANCES = (1e-7, 1e-8, 1e-9)
CLOCKS = (("s", False, 0.0), ("sigma", True, 0.0), ("sigma + 0.3 P", True, 0.3), ("sigma + P", True, 1.0))


def slope(root: bool, share: float) -> Callable[[float, Array], list[float]]:
    """Return the rates of (x or its root, P, E) in a clock that advances with ``share`` times the impulse, too."""

    def rates(_clock: float, state: Array) -> list[float]:
        deformation, impulse, _energy = state
        speed = 1.0 - impulse
        if root:
            pace = 1.0 / (1.0 + share * deformation**4)
            force = deformation**4 * pace
            return [0.5 * speed * pace, force, force * speed]
        force = max(deformation, 0.0) ** 1.5
        return [speed, force, force * speed]

    return rates


def opens(_clock: float, state: Array) -> float:
    """Vanish where the contact opens."""
    return float(state[0])


opens.terminal = True  # type: ignore[attr-defined]
opens.direction = -1.0  # type: ignore[attr-defined]


def main() -> None:
    """Print a line per pair and clock."""
    print(f"{'pair':8}{'clock':15}" + "".join(f"{tolerance:>22.0e}" for tolerance in TOLERANCES))
    for pair in ("RK45", "DOP853"):
        for name, root, share in CLOCKS:
            line = f"{pair:8}{name:15}"
            for tolerance in TOLERANCES:
                run = solve_ivp(
                    slope(root, share),
                    (0.0, 40.0),
                    np.zeros(3),
                    method=pair,
                    rtol=tolerance,
                    atol=tolerance,
                    first_step=0.1,
                    events=opens,
                )
                line += f"{run.nfev:12d}{abs(run.y[1, -1] - 2.0):10.1e}"
            print(line)


if __name__ == "__main__":
    main()
