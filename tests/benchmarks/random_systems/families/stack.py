"""A stack on a plate."""

from __future__ import annotations

from bodies import Plate
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families.aligned import (
    DOWN,
    UP,
    all_pairs,
    face,
    interval,
    laws,
    lay,
    next_to,
    size_of,
    start,
    tiny,
)
from tests.benchmarks.random_systems.families.bodies import bodies
from tests.benchmarks.random_systems.solids import Random


def draw(random: Random) -> Case:
    """Draw two to six bodies, one on the other, at rest with gaps of 0 or 1e-12 to 1e-3 of a size, or all falling.

    Those that fall have gaps of 1e-4 to 0.1 of a size.
    """
    size, n = size_of(random), int(random.integers(2, 7))
    laid = lay(random, bodies(random, size, n), face(random, 0.8), UP)
    falls = random.random() < 0.5
    places = [(laid[0].reach(DOWN) + (tiny(random, size) if falls else 0.0)) * UP]
    for k in range(1, n):
        gap = size * 10.0 ** random.uniform(-4.0, -1.0) if falls else tiny(random, size)
        places.append(next_to(random, places[-1], laid[k - 1], laid[k], UP, gap))
    starts = (None, *(start(one, place) for one, place in zip(laid, places, strict=True)))
    contacts = all_pairs(n + 1, laws(random))
    made = (Plate(), *(one.body for one in laid))
    return Case(made, starts, contacts, (), 9.81, 0.05, interval(laid, UP, 0.4, size))
