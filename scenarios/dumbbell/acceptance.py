"""What the paper says of the dumbbell's modes, and what a ball on the same plate says of the jump."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from nonsmooth.interfaces import Criterion
from nonsmooth.solution.modes import mode_shares
from nonsmooth.solution.solution import Solution

_PERIODS = {"drift": 1.0, "jump": 1.0, "flutter": 2.0}
_RESTS = "{01,00,01}"
"""The word of ball 1 on the plate and ball 2 in the air."""


def criteria(
    mode: str, nominal: bool, summary: Mapping[str, Any], solution: Solution, orbit_gap: float
) -> tuple[Criterion, ...]:
    """Return the criteria of a settled run of a mode with the nominal parameters; none of others.

    Parameters
    ----------
    mode : str
        The motion that the start leads to.
    nominal : bool
        Whether the parameters are those of the mode.
    summary : mapping
        Attractor, period, gaps and tilts of the run.
    solution : Solution
        The run.
    orbit_gap : float
        Largest gap of a ball on the orbit of one plate period [m].
    """
    if not nominal or mode not in _PERIODS:
        return ()
    paper = "the paper, section 5"
    period = summary["period"] if summary["attractor"] == mode else None
    name = f"plate periods after which the {mode} repeats"
    found = [Criterion.near(name, period, _PERIODS[mode], 0.0, paper)]
    if mode == "drift":
        share = float(mode_shares(solution).get(_RESTS, 0.0))
        found.append(
            Criterion(f"share of time in {_RESTS}", share, 0.5, 1.0, f"{paper}: ball 1 rests most of the cycle")
        )
    if mode == "jump":
        source = "both balls on the orbit of a bouncing ball, n = 1"
        for ball, gap in enumerate(summary["max_gap"]):
            found.append(
                Criterion.near(f"largest gap of ball {ball + 1} [m]", gap, orbit_gap, 1e-3 * orbit_gap, source)
            )
    if mode == "flutter":
        low, high = summary["beta_range"]
        source = "the compliant limit with the same parameters: +-10.4 degrees"
        for side, value in ((-1.0, low), (1.0, high)):
            name = f"{'least' if side < 0.0 else 'largest'} tilt [rad]"
            found.append(Criterion.near(name, value, side * math.radians(10.4), math.radians(0.2), source))
    return tuple(found)
