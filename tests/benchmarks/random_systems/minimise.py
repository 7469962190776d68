"""Make a case smaller as long as it ends in the same way."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.run import Outcome, run

_SIMPLE = (
    ns.ContactLaws(Unilateral(), Frictionless(), EnergeticImpact(0.0)),
    ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5)),
)


def _smaller(case: Case) -> Iterator[Case]:
    """Yield cases with less in them, the boldest cuts first."""
    for k in reversed(range(len(case.bodies))):
        yield case.without(k)
    for k in range(len(case.joints)):
        yield replace(case, joints=case.joints[:k] + case.joints[k + 1 :])
    for k in range(len(case.contacts)):
        yield replace(case, contacts=case.contacts[:k] + case.contacts[k + 1 :])
    for laws in _SIMPLE:
        if all(row[2] == laws for row in case.contacts):
            break
        yield replace(case, contacts=tuple((i, j, laws) for i, j, _ in case.contacts))
    for part in (0.3, 0.7) if case.t_end > 2.0 * case.sample_interval else ():
        yield replace(case, t_end=float(f"{part * case.t_end:.2g}"))
    for k, start in enumerate(case.starts):
        if start is not None:
            for simpler in _simpler_starts(start):
                yield replace(case, starts=(*case.starts[:k], simpler, *case.starts[k + 1 :]))


def _simpler_starts(start: Start) -> Iterator[Start]:
    words = dict(start.arguments)
    for name in ("velocity", "angular_velocity"):
        if any(words.get(name, ())):
            yield Start(start.how, tuple((words | {name: (0.0, 0.0, 0.0)}).items()))
    if words.get("orientation", (1.0,))[0] != 1.0:
        yield Start(start.how, tuple((words | {"orientation": (1.0, 0.0, 0.0, 0.0)}).items()))
    for digits in (2, 3):
        rounded = {
            name: tuple(float(f"{x:.{digits}g}") for x in words[name])
            for name in ("position", "velocity", "angular_velocity")
            if name in words
        }
        if any(words[name] != value for name, value in rounded.items()):
            yield Start(start.how, tuple((words | rounded).items()))


def minimise(case: Case, outcome: Outcome, seconds: float, note: Callable[[Case], None]) -> Case:
    """Return the smallest case found within a time that ends in the same way.

    Parameters
    ----------
    case, outcome : Case, Outcome
        What happened.
    seconds : float
        Time for the whole search [s].
    note : callable
        Called with each smaller case, so that it is kept if the next one does not come back.
    """
    ends, limit = time.monotonic() + seconds, 2.0 * outcome.seconds + 2.0
    shrinking = True
    while shrinking:
        shrinking = False
        for smaller in _smaller(case):
            if time.monotonic() > ends:
                return case
            if run(smaller, limit).kind == outcome.kind:
                case, shrinking = smaller, True
                note(case)
                break
    return case
