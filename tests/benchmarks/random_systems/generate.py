"""The system that belongs to a number: the same at every call, and no two alike."""

from __future__ import annotations

import numpy as np

from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families import FLUSH, TUMBLING

FAMILIES = {"tumbling": TUMBLING, **{name: draw for name, (_, draw) in FLUSH.items()}}
"""What draws a system of each family."""
_EVERY = 3
"""One of so many numbers belongs to a flush family."""


def flush_family_of(seed: int) -> str:
    """Flush family of a number, if all systems are flush."""
    weights = np.array([weight for weight, _ in FLUSH.values()])
    return str(np.random.default_rng([20_263, seed]).choice(list(FLUSH), p=weights / weights.sum()))


def family_of(seed: int) -> str:
    """Family of the system of a number, drawn apart from the system itself."""
    return flush_family_of(seed) if seed % _EVERY == _EVERY - 1 else "tumbling"


def flush_case_of(seed: int) -> Case:
    """Return the flush system of a number."""
    return case_of(seed, flush_family_of(seed))


def case_of(seed: int, family: str | None = None) -> Case:
    """Return the system of a number, of its own family or of one that is named."""
    name = family_of(seed) if family is None else family
    stream = 20_261 if name == "tumbling" else 20_264
    return FAMILIES[name](np.random.default_rng([stream, seed]))
