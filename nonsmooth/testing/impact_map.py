"""Properties of impact laws that map rates to impulses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import parameter_names
from nonsmooth.interfaces import ImpactLaw, ImpactMap
from nonsmooth.testing.callers import compiled_map
from nonsmooth.testing.component import variants
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import examine
from nonsmooth.testing.functions import OLD, ROOM, Function
from nonsmooth.testing.property import Row
from nonsmooth.testing.reference import Problem, problem, problem_space
from nonsmooth.testing.respond import vectors_of

Array = NDArray[np.float64]
_MU = 0.3
_OBEYS = 1e-6
"""Deviation of velocities that counts as zero, relative to the largest."""


def is_alone(law: ImpactLaw) -> bool:
    """Tell whether a law is one of a single contact, and of no more."""
    return isinstance(law, ImpactMap) and law.one_contact


def _spaces(law: ImpactLaw) -> dict[int, list[Variable]]:
    """Return the numbers that make problems that the law takes, by the number of contacts."""
    return {n: problem_space(n) for n in ((1,) if is_alone(law) else (1, 2))}


def map_function(law: ImpactMap) -> Function:
    """Return the function of a map with problems of one and two contacts to try."""
    inputs: list[tuple[str, Problem]] = []
    for n, space in _spaces(law).items():
        for case in draws(space, 3, "map"):
            inputs.append((f"{n} contact{'s' * (n > 1)}", problem(case, n)))
    offered = {"friction": _MU, **law.numbers()}

    def plain(p: Problem) -> Array:
        vectors = vectors_of([law] * p.n, [_MU] * p.n)
        own = {name: vectors[name] for name in parameter_names(law.impulses, "map")}
        return _written(p, lambda *given: law.impulses(*given, **own))

    def compiled() -> Callable[[Problem], Array]:
        def call(p: Problem) -> Array:
            vectors = vectors_of([law] * p.n, [_MU] * p.n)
            own = {name: vectors[name] for name in parameter_names(law.impulses, "map")}
            return _written(p, compiled_map(law.impulses, own, type(law).__name__))

        return call

    return Function(law, "impulses", law.impulses, "map", offered, plain, compiled, inputs)


def _written(p: Problem, call: Callable[..., Any], old: float = 0.0) -> Array:
    """Return what a map writes, and what stands behind it, which is not its own."""
    columns = p.columns
    delassus = columns.T @ np.linalg.solve(p.mass, columns)
    out = np.full(3 * p.n + ROOM, OLD)
    out[: 3 * p.n] = old
    call(p.n, np.ascontiguousarray(delassus).ravel(), columns.T @ p.velocity, out)
    return out


def map_rows(law: ImpactMap) -> list[Row]:
    """Return the properties that only a map has."""
    space = [*list(_spaces(law).values())[-1], Variable("friction", 0.0, 0.6)]
    return [
        (
            "writes its block",
            "it writes every impulse, whatever stood there, and nothing beyond",
            lambda: examine("writes its block", variants(law), space, _writes, 4),
        ),
        (
            "certificate",
            "the impulses of the law obey it; larger ones, other friction and none where a contact approaches do not",
            lambda: examine("certificate", variants(law), space, _certifies, 4),
        ),
    ]


def _writes(law: ImpactMap, case: Case) -> str:
    p = problem(case, max(_spaces(law)))
    vectors = vectors_of([law] * p.n, [case["friction"]] * p.n)
    own = {name: vectors[name] for name in parameter_names(law.impulses, "map")}
    clean, used = (_written(p, lambda *given: law.impulses(*given, **own), old) for old in (0.0, OLD))
    return (
        ""
        if np.allclose(clean[: 3 * p.n], used[: 3 * p.n], rtol=1e-9, atol=1e-12)
        else "numbers that stood there before are left"
    )


def _certifies(law: ImpactMap, case: Case) -> str:
    p = problem(case, max(_spaces(law)))
    vectors = vectors_of([law] * p.n, [case["friction"]] * p.n)
    own = {name: vectors[name] for name in parameter_names(law.impulses, "map")}
    obeying = _written(p, lambda *given: law.impulses(*given, **own))[: 3 * p.n]
    delassus, before = p.columns.T @ np.linalg.solve(p.mass, p.columns), p.columns.T @ p.velocity
    tolerance = _OBEYS * float(np.max(np.abs(before)))
    across = obeying * np.tile([0.0, 1.0, 1.0], p.n)
    tried = [("its impulses", obeying, True)]
    for words, wrong in (
        ("1.1 times its impulses", 1.1 * obeying),
        ("1.2 times its friction", obeying + 0.2 * across),
        ("no impulses", 0.0 * obeying),
    ):
        # what changes no velocity is no other solution
        if np.max(np.abs(delassus @ (wrong - obeying))) > 1e3 * tolerance:
            tried.append((words, wrong, False))
    for words, impulses, expected in tried:
        if bool(law.is_fulfilled(delassus, before, impulses, vectors["friction"], tolerance)) is not expected:
            return f"is_fulfilled {'refuses' if expected else 'accepts'} {words}"
    return ""
