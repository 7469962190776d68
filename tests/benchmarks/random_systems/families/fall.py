"""A body that falls flat onto one that lies on a plate."""

from __future__ import annotations

import math

import numpy as np

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
)
from tests.benchmarks.random_systems.families.bodies import bodies
from tests.benchmarks.random_systems.solids import Random


def draw(random: Random) -> Case:
    """Draw two bodies: one lies on a plate, the other falls on it from 1e-4 to 2 sizes, or is thrown down at 1 m/s.

    Of three systems one is shifted along an axis by a part of a size, so that the faces meet in part.
    """
    size = size_of(random)
    one, other = lay(random, bodies(random, size, 2), face(random, 0.6), UP)
    below = one.reach(DOWN) * UP
    height = size * 10.0 ** random.uniform(-4.0, 0.3)
    place = next_to(random, below, one, other, UP, height)
    if random.random() < 0.3:
        place = place + float(random.choice([0.25, 0.5, 1.0])) * size * np.eye(3)[random.integers(2)]
    thrown = 0.0 if random.random() < 0.7 else random.uniform(0.0, 1.0)
    speed = math.sqrt(thrown**2 + 2.0 * 9.81 * height)
    until = (speed - thrown) / 9.81
    t_end = until + min(size / max(speed, 0.1), 0.04)
    starts = (None, start(one, below), start(other, place, thrown * DOWN))
    contacts = all_pairs(3, laws(random))
    apart = interval([one, other], UP, max(speed, 0.1), size)
    return Case((Plate(), one.body, other.body), starts, contacts, (), 9.81, t_end, apart)
