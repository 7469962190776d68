"""Properties of impact laws that the engine integrates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nonsmooth.interfaces import ImpactProcess
from nonsmooth.testing.callers import plain_caller
from nonsmooth.testing.component import variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.property import Row
from nonsmooth.testing.reference import problem, problem_space
from nonsmooth.testing.respond import respond

_INDENTATION = Variable("indentation", 1e-6, 1e1, 1.0, log=True)
_RATE = Variable("rate", 1e-6, 1e2, 1.0, log=True)
_DRAWS = 6
_GRID = tuple(np.geomspace(1e-9, 1e2, 23).tolist())


def process_rows(law: ImpactProcess) -> list[Row]:
    """Return the properties that only a process has."""

    def row(name: str, says: str, trial: Trial, space: Sequence[Variable]) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=FEWEST)

    return [
        row("force", "zero at zero, and it rises with the indentation", _force, [_INDENTATION]),
        row("efficiency", "1 for rates below zero, between 0 and 1 from there", _efficiency, [_RATE]),
        row(
            "certificate",
            "energies that the engine stores and gives back obey it",
            _accepts,
            [*problem_space(2), Variable("friction", 0.0, 0.6)],
        ),
        row(
            "no gain accepted",
            "energy that comes back beyond what was stored does not obey it",
            _refuses_gain,
            [Variable("stored", 1e-3, 1e3, 1.0, log=True)],
        ),
    ]


def _force(law: ImpactProcess, case: Case) -> str:
    force = plain_caller(law.force, "scalar", law.parameters())
    x = case["indentation"]
    if force(0.0) != 0.0:
        return f"force(0) is {force(0.0):g}"
    for less in (x, *_GRID):
        low, high = force(less), force(1.5 * less)
        if not high > low > 0.0:
            return f"force({less:g}) is {low:g} and force({1.5 * less:g}) {high:g}"
    return ""


def _efficiency(law: ImpactProcess, case: Case) -> str:
    efficiency = plain_caller(law.efficiency, "scalar", law.parameters())
    for rate in (0.0, case["rate"], *_GRID):
        if rate > 0.0 and efficiency(-rate) != 1.0:
            return f"efficiency({-rate:g}) is {efficiency(-rate):g}"
        if not 0.0 <= efficiency(rate) <= 1.0:
            return f"efficiency({rate:g}) is {efficiency(rate):g}"
    return ""


def _accepts(law: ImpactProcess, case: Case) -> str:
    r = respond([law] * 2, [case["friction"]] * 2, problem(case, 2))
    size = float(np.max(r.stored, initial=0.0))
    for stored, returned in zip(r.stored.tolist(), r.returned.tolist(), strict=True):
        if not law.is_fulfilled(stored, returned, 1e-7 * size + 1e-12):
            return f"is_fulfilled refuses {returned:g} J back of {stored:g} J"
    return ""


def _refuses_gain(law: ImpactProcess, case: Case) -> str:
    stored = case["stored"]
    if law.is_fulfilled(stored, 1.01 * stored, 1e-6 * stored):
        return f"is_fulfilled accepts {1.01 * stored:g} J back of {stored:g} J"
    return ""
