"""Runs and impacts that need a constant of the engine: which, and what they may cost with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tests.engine.plain_cases import CASES

_WRONG = 1e-7
"""Part of the energy that may vanish."""


@dataclass(frozen=True)
class Run:
    """One of the plain cases, and how many steps, tries and looks at gaps it takes at most."""

    name: str
    most: int

    def assert_solved(self) -> None:
        """Run it, and hold its end, its energy and what it cost against what they should be."""
        numbers = CASES[self.name]()
        assert "status" not in numbers or list(numbers["status"]) == ["done"]
        assert abs(numbers["wrong"][0]) < _WRONG
        assert numbers["cost"][0] <= self.most


RUNS: dict[str, tuple[Any, Run]] = {
    "bodies.anisotropy._UPRIGHT": (0.0, Run("axis along the normal", 50)),
    "bodies.listing._ACCELERATION": (200.0, Run("slow border", 24)),
    "bodies.listing._SPENT": (0.0, Run("hills", 73)),
    "events.event_update._ATTEMPTS": (1, Run("no force, impact", 15)),
    "events.event_update._PAINLEVE_ATTEMPTS": (0, Run("no force, impact", 15)),
    "events.stopping._ALMOST": (0.0, Run("creeping", 65)),
    "events.stopping._BEYOND": (0.0, Run("creeping", 65)),
    "events.stopping._SHARES": ((1e-9, 1e-3), Run("creeping", 65)),
    "flow.clearance._CURVED": (400.0, Run("no force, impact", 15)),
    "flow.clearance.WAY": (0.0, Run("border", 40)),
    "flow.clearance.ABOUT": (0.0, Run("shaken", 12)),
    "flow.clearance._COARSE": (0.0, Run("over an edge", 150)),
    "flow.leap._FASTER": (1e9, Run("flat", 100)),
    "contact.problem._INCIPIENT": (0.0, Run("shaken", 12)),
    "flow.location._FARTHEST": (3e-3, Run("border", 40)),
    "flow.location._FINE": (1e6, Run("skew", 220)),
    "flow.location._SAMPLES": (200, Run("slow border", 24)),
    "flow.location.NEGLIGIBLE": (1.0, Run("shaken", 12)),
    "flow.projection._FARTHEST": (1e-6, Run("border", 40)),
    "flow.self_check.EXPLAINED": (1e-3, Run("bouncing", 48)),
    "flow.self_check.NEAR": (0.0, Run("over an edge", 150)),
    "flow.self_check._ROUND_OFF": (0.0, Run("squeezed", 3)),
    "flow.step._SHARE": (0.0, Run("shaken", 12)),
    "flow.step._SLOWEST": (0.0, Run("shaken", 12)),
    "impact.instant._NEXT_TO_ZERO": (0.0, Run("into the singularity", 200)),
    "impact.problem._FAR": (0.01, Run("bouncing", 48)),
    "impact.problem._FIRST": (25.0, Run("skew", 220)),
    "impact.problem._LAST": (0.0, Run("skew", 220)),
    "impact.problem._AT_EVENT": (0.0, Run("bouncing", 48)),
    "impact.problem._SHARE": (0.01, Run("impact problem 2", 100)),
    "impact.problem._LEAST_ERROR": (1.0, Run("impact problem 2", 100)),
    "impact.problem.MOST_STEPS": (1, Run("bouncing", 48)),
    "impact.rates.NOISE": (1e-3, Run("bouncing", 48)),
    "impact.step._CAREFUL": (1e4, Run("next to the bound, 1", 80)),
    "impact.step._SETTLING": (300.0, Run("next to the bound, 1", 80)),
    "impact.step._STIFF": (100.0, Run("next to the bound, 1", 80)),
    "impact.step._STRAIGHT": (1.0, Run("impact problem 2", 100)),
    "numerics.roots.SHORT": (0.0, Run("shaken", 12)),
    "numerics.roots.TRUSTED": (0.0, Run("over an edge", 150)),
    "numerics.runge_kutta._EXPONENT": (-1.0, Run("impact problem 2", 100)),
    "numerics.runge_kutta.GROW": (1.05, Run("impact problem 2", 100)),
    "numerics.runge_kutta.SAFETY": (0.3, Run("impact problem 2", 100)),
    "numerics.runge_kutta.SHRINK": (0.9, Run("next to the bound, 4", 136)),
}
"""By constant: another value, and a run that is right with the present one only."""
