"""Properties of impact laws that the engine integrates."""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces import ImpactProcess
from nonsmooth.testing.claims import FEWEST, Claims
from nonsmooth.testing.functions import plain_caller
from nonsmooth.testing.inputs import number
from nonsmooth.testing.reference import ImpactProblem, problem_of, respond

_INDENTATION = number("indentation", 1e-6, 1e1, 1.0, is_log=True)
_RATE = number("rate", 1e-6, 1e2, 1.0, is_log=True)
_STORED = number("stored", 1e-3, 1e3, 1.0, is_log=True)
_MU = number("friction", 0.0, 0.6)
_GRID = tuple(np.geomspace(1e-9, 1e2, 23).tolist())
PROCESS = Claims(fewest=FEWEST)


@PROCESS.claim(_INDENTATION)
def _force(law: ImpactProcess, indentation: float) -> str:
    """Zero at zero, and it rises with the indentation."""
    force = plain_caller(law.force, "scalar", law.parameters())
    if force(0.0) != 0.0:
        return f"force(0) is {force(0.0):g}"
    for less in (indentation, *_GRID):
        low, high = force(less), force(1.5 * less)
        if not high > low > 0.0:
            return f"force({less:g}) is {low:g} and force({1.5 * less:g}) {high:g}"
    return ""


@PROCESS.claim(_RATE)
def _efficiency(law: ImpactProcess, drawn: float) -> str:
    """1 for rates below zero, between 0 and 1 from there."""
    efficiency = plain_caller(law.efficiency, "scalar", law.parameters())
    for rate in (0.0, drawn, *_GRID):
        if rate > 0.0 and efficiency(-rate) != 1.0:
            return f"efficiency({-rate:g}) is {efficiency(-rate):g}"
        if not 0.0 <= efficiency(rate) <= 1.0:
            return f"efficiency({rate:g}) is {efficiency(rate):g}"
    return ""


@PROCESS.claim(problem_of(2), _MU)
def _certificate(law: ImpactProcess, p: ImpactProblem, mu: float) -> str:
    """Energies that the engine stores and gives back obey it."""
    r = respond([law] * 2, [mu] * 2, p)
    size = float(np.max(r.stored, initial=0.0))
    for stored, returned in zip(r.stored.tolist(), r.returned.tolist(), strict=True):
        if not law.is_fulfilled(stored, returned, 1e-7 * size + 1e-12):
            return f"is_fulfilled refuses {returned:g} J back of {stored:g} J"
    return ""


@PROCESS.claim(_STORED)
def _no_gain_accepted(law: ImpactProcess, stored: float) -> str:
    """More energy back than was stored does not obey it."""
    if law.is_fulfilled(stored, 1.01 * stored, 1e-6 * stored):
        return f"is_fulfilled accepts {1.01 * stored:g} J back of {stored:g} J"
    return ""
