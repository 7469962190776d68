"""Properties of impact laws that map rates to impulses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import parameter_names
from nonsmooth.interfaces import ImpactLaw, ImpactMap
from nonsmooth.testing.claims import GIVEN, Claims
from nonsmooth.testing.functions import OLD, compiled_map, written
from nonsmooth.testing.inputs import draws, number
from nonsmooth.testing.reference import ImpactProblem, problem_of, vectors_of

Array = NDArray[np.float64]
_MU = number("friction", 0.0, 0.6)
_OF_FUNCTION = 0.3
"""Friction coefficient with which the function is tried."""
_OBEYS = 1e-6
"""Deviation of velocities that counts as zero, relative to the largest."""
MAP = Claims()


def is_alone(law: ImpactLaw) -> bool:
    """True for a law of a single contact."""
    return isinstance(law, ImpactMap) and law.one_contact


@final
@dataclass(frozen=True)
class _MapFunction:
    """The function of a map, as a :class:`nonsmooth.testing.functions.CheckedFunction`."""

    owner: ImpactMap
    inputs: Sequence[tuple[str, tuple[ImpactProblem]]]
    form: ClassVar[str] = "map"

    @property
    def function(self) -> Callable[..., None]:
        return self.owner.impulses

    @property
    def title(self) -> str:
        return f"{type(self.owner).__name__}.impulses"

    @property
    def offered(self) -> dict[str, Any]:
        return {"friction": _OF_FUNCTION, **self.owner.numbers()}

    def plain(self, p: ImpactProblem) -> Array:
        return _impulses(self.owner, p, _OF_FUNCTION)

    def compiled(self) -> Callable[[ImpactProblem], Array]:
        name, (_, (first,)) = type(self.owner).__name__, self.inputs[0]
        # compiled now, and not in the first call, whose time is limited
        compiled_map(self.function, _own(self.owner, first, _OF_FUNCTION), name)
        return lambda p: _written(p, compiled_map(self.function, _own(self.owner, p, _OF_FUNCTION), name))


def map_function(law: ImpactMap) -> Any:
    """Return the function of a map with problems of one and two contacts to try."""
    problems = [
        (f"{n} contact{'s' * (n > 1)}", (drawn.made(case),))
        for n, drawn in {n: problem_of(n) for n in ((1,) if is_alone(law) else (1, 2))}.items()
        for case in draws([drawn], 3)
    ]
    return _MapFunction(law, problems)


def _own(law: ImpactMap, p: ImpactProblem, mu: float) -> dict[str, Array]:
    vectors = vectors_of([law] * p.n, [mu] * p.n)
    return {name: vectors[name] for name in parameter_names(law.impulses, "map")}


def _written(p: ImpactProblem, call: Callable[..., Any], old: float = 0.0) -> Array:
    delassus = np.ascontiguousarray(p.delassus).ravel()
    return written(lambda out: call(p.n, delassus, p.rates, out), 3 * p.n, old)


def _impulses(law: ImpactMap, p: ImpactProblem, mu: float, old: float = 0.0) -> Array:
    own = _own(law, p, mu)
    return _written(p, lambda *given: law.impulses(*given, **own), old)


@MAP.claim(GIVEN, _MU)
def _writes_its_block(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """It writes every impulse, whatever stood there, and nothing beyond."""
    clean, used = (_impulses(law, p, mu, old)[: 3 * p.n] for old in (0.0, OLD))
    return "" if np.allclose(clean, used, rtol=1e-9, atol=1e-12) else "numbers that stood there before are left"


@MAP.claim(GIVEN, _MU)
def _certificate(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """The impulses of the law obey it; larger ones, other friction and none where a contact approaches do not."""
    obeying, delassus, before = _impulses(law, p, mu)[: 3 * p.n], p.delassus, p.rates
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


