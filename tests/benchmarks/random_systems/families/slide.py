"""A body that slides on a plate into others."""

from __future__ import annotations

import math

import numpy as np

from bodies import Plate
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families.aligned import (
    DOWN,
    UP,
    about,
    all_pairs,
    face,
    interval,
    laws,
    lay,
    next_to,
    product,
    size_of,
    start,
    tiny,
)
from tests.benchmarks.random_systems.families.bodies import bodies
from tests.benchmarks.random_systems.pieces import rotations
from tests.benchmarks.random_systems.solids import Random


def draw(random: Random) -> Case:
    """Draw two or three bodies on a plate: the first slides along an axis of theirs into a row of the others.

    The speed is 0.2 to 2 m/s, the gap as long as friction lets the body slide.  The others touch or nearly do.  Of
    three systems one slides along any direction of the plate.
    """
    size, n = size_of(random), 2 if random.random() < 0.75 else 3
    yaw = random.uniform(0.0, 2.0 * math.pi) if random.random() < 0.3 else 0.0
    spin = about(UP, yaw)
    way = rotations(np.array([spin]))[0] @ np.eye(3)[random.integers(2)]
    laid = lay(random, bodies(random, size, n), product(spin, face(random, 0.6)), UP)
    speed = float(f"{10.0 ** random.uniform(-0.7, 0.3):.3g}")
    gap = min(size * random.uniform(0.05, 0.5), 0.02 * speed**2)
    places = [np.zeros(3)]
    for k in range(1, n):
        ahead = gap if k == 1 else tiny(random, size)
        places.append(next_to(random, places[-1], laid[k - 1], laid[k], way, ahead))
    places = [np.array([*place[:2], one.reach(DOWN)]) for place, one in zip(places, laid, strict=True)]
    starts = (
        None,
        *(start(one, p, None if k else speed * way) for k, (one, p) in enumerate(zip(laid, places, strict=True))),
    )
    t_end = min((2.0 * gap + 0.5 * size) / speed, 0.08)
    contacts = all_pairs(n + 1, laws(random))
    made = (Plate(), *(one.body for one in laid))
    return Case(made, starts, contacts, (), 9.81, t_end, interval(laid, way, speed, size))
