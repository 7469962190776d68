"""A heap in a box."""

from __future__ import annotations

import itertools

import numpy as np

from bodies import OpenBox
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families.aligned import (
    DOWN,
    UP,
    all_pairs,
    face,
    interval,
    laws,
    lay,
    shift,
    size_of,
    start,
    tiny,
)
from tests.benchmarks.random_systems.families.bodies import bodies
from tests.benchmarks.random_systems.solids import Random


def draw(random: Random) -> Case:
    """Draw five to twelve bodies in layers of up to four in an open box, with walls and sides parallel.

    Gaps are 0 or 1e-12 to 1e-3 of a size, or 0.02 to 0.3 of it: a packed box at rest, or a heap that falls.
    """
    size, n = size_of(random), int(random.integers(5, 13))
    laid = lay(random, bodies(random, size, n), face(random, 0.8), UP)
    packed = random.random() < 0.4
    gap = tiny(random, size) if packed else size * random.uniform(0.02, 0.3)
    half = [max(max(one.reach(way), one.reach(-way)) for one in laid) + 0.5 * gap for way in np.eye(3)]
    columns = (2, 2) if random.random() < 0.6 else (2, 1)
    grid = list(itertools.product(range(n), range(columns[0]), range(columns[1])))[:n]
    starts = []
    for one, (layer, i, j) in zip(laid, grid, strict=True):
        x, y = (2 * i + 1 - columns[0]) * half[0], (2 * j + 1 - columns[1]) * half[1]
        z = 2 * layer * half[2] + one.reach(DOWN)
        aside, above = (0.0, 0.0) if packed else (shift(random, 0.5 * gap), 0.5 * gap)
        starts.append(start(one, np.array([x + aside, y, z + above])))
    box = OpenBox(columns[0] * half[0], columns[1] * half[1])
    contacts = all_pairs(n + 1, laws(random))
    return Case(
        (box, *(one.body for one in laid)), (None, *starts), contacts, (), 9.81, 0.03, interval(laid, UP, 0.3, size)
    )
