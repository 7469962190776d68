"""Properties of impact laws that map rates to impulses."""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces import ImpactLaw, ImpactMap
from nonsmooth.testing.claims import GIVEN, Claims
from nonsmooth.testing.functions import OLD, CheckedFunction, plain_caller, written
from nonsmooth.testing.inputs import draws, number
from nonsmooth.testing.reference import ImpactProblem, problem_of, vectors_of
from nonsmooth.types import Array

_MU = number("friction", 0.0, 0.6)
_OF_FUNCTION = 0.3
"""Friction coefficient with which the function is tried."""
_OBEYS = 1e-6
"""Deviation of velocities that counts as zero, relative to the largest."""
MAP = Claims()


def is_alone(law: ImpactLaw) -> bool:
    """True for a law of a single contact."""
    return isinstance(law, ImpactMap) and law.one_contact


def map_functions(law: ImpactMap) -> list[CheckedFunction]:
    """Return the function of a map, with problems of one contact, and of two unless it is a law of a single one."""
    return [_of_contacts(law, 1)] if is_alone(law) else [_of_contacts(law, 1), _of_contacts(law, 2)]


def _of_contacts(law: ImpactMap, n: int) -> CheckedFunction:
    drawn, words = problem_of(n), f"{n} contact{'s' * (n > 1)}"
    inputs = [(words, _given(drawn.made(case))) for case in draws([drawn], 3)]
    return CheckedFunction(law, "impulses", "map", vectors_of([law] * n, [_OF_FUNCTION] * n), inputs, 3 * n)


def _given(p: ImpactProblem) -> tuple[int, Array, Array]:
    """Return the arguments of the function of a map."""
    return p.n, np.ascontiguousarray(p.delassus).ravel(), p.rates


def _impulses(law: ImpactMap, p: ImpactProblem, mu: float, old: float = 0.0) -> Array:
    call = plain_caller(law.impulses, "map", vectors_of([law] * p.n, [mu] * p.n))
    return written(lambda out: call(*_given(p), out), 3 * p.n, old)[: 3 * p.n]


@MAP.claim(GIVEN, _MU)
def _writes_its_block(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """It writes every impulse, whatever stood there, and nothing beyond."""
    clean, used = (_impulses(law, p, mu, old) for old in (0.0, OLD))
    return "" if np.allclose(clean, used, rtol=1e-9, atol=1e-12) else "numbers that stood there before are left"


@MAP.claim(GIVEN, _MU)
def _certificate(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """The impulses of the law obey it; larger ones, other friction and none where a contact approaches do not."""
    obeying, delassus, before = _impulses(law, p, mu), p.delassus, p.rates
    tolerance = _OBEYS * float(np.max(np.abs(before)))
    across = obeying * np.tile([0.0, 1.0, 1.0], p.n)
    wrong = {
        "1.1 times its impulses": 1.1 * obeying,
        "1.2 times its friction": obeying + 0.2 * across,
        "no impulses": 0.0 * obeying,
    }
    # impulses that change no velocity are the same solution
    others = {k: v for k, v in wrong.items() if np.max(np.abs(delassus @ (v - obeying))) > 1e3 * tolerance}
    friction = vectors_of([law] * p.n, [mu] * p.n)["friction"]
    for words, impulses in {"its impulses": obeying, **others}.items():
        expected = impulses is obeying
        if bool(law.is_fulfilled(delassus, before, impulses, friction, tolerance)) is not expected:
            return f"is_fulfilled {'refuses' if expected else 'accepts'} {words}"
    return ""
