"""Bodies that touch when they start."""

from __future__ import annotations

import numpy as np

from bodies import Plate
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.case import Case, Start
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
    """Draw two or three bodies with gaps of 0 or 1e-12 to 1e-3 of a size: a pile or a row on a plate, or afloat.

    They are at rest; afloat the first one is pushed into the second, or along it, at 0.1 to 1 m/s.
    """
    size, n, choice = size_of(random), 2 if random.random() < 0.7 else 3, random.random()
    way = UP if choice < 0.4 else np.eye(3)[random.integers(2)]
    laid = lay(random, bodies(random, size, n), face(random, 0.6), way)
    places = [laid[0].reach(DOWN) * UP]
    for k in range(1, n):
        places.append(next_to(random, places[-1], laid[k - 1], laid[k], way, tiny(random, size)))
    if 0.4 <= choice < 0.75:
        places = [np.array([*place[:2], one.reach(DOWN)]) for place, one in zip(places, laid, strict=True)]
    afloat = choice >= 0.75
    speed = float(f"{10.0 ** random.uniform(-1.0, 0.0):.3g}") if afloat else 0.0
    push = speed * (way if random.random() < 0.5 else np.roll(way, 1))
    starts = [start(one, place, None if k else push) for k, (one, place) in enumerate(zip(laid, places, strict=True))]
    floor: list[Body] = [] if afloat else [Plate()]
    first: list[Start | None] = [] if afloat else [None]
    made = (*floor, *(one.body for one in laid))
    apart = interval(laid, way, max(speed, 0.2), size)
    contacts = all_pairs(len(made), laws(random))
    return Case(made, (*first, *starts), contacts, (), 0.0 if afloat else 9.81, 0.04, apart)
