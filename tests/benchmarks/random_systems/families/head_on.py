"""Two bodies that meet face to face in free flight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families.aligned import (
    all_pairs,
    face,
    interval,
    laws,
    lay,
    next_to,
    product,
    size_of,
    start,
)
from tests.benchmarks.random_systems.families.bodies import bodies
from tests.benchmarks.random_systems.families.tumbling import turn
from tests.benchmarks.random_systems.pieces import rotations
from tests.benchmarks.random_systems.solids import Random, number


def draw(random: Random) -> Case:
    """Draw two bodies without weight: one flies along an axis at the other, which is at rest or comes towards it.

    The speed is 0.1 to 5 m/s and the gap 0.05 to 1 of a size.  Of three systems one is turned as a whole.
    """
    size = size_of(random)
    way = np.eye(3)[random.integers(3)] * random.choice([-1.0, 1.0])
    one, other = lay(random, bodies(random, size, 2), face(random, 0.4), way)
    gap, speed = size * random.uniform(0.05, 1.0), float(f"{10.0 ** random.uniform(-1.0, 0.7):.3g}")
    place = next_to(random, np.zeros(3), one, other, way, gap)
    back = -speed * way if random.random() < 0.2 else np.zeros(3)
    closing = speed + float(np.linalg.norm(back))
    # long enough for bodies that miss each other to be well inside of each other
    t_end = (gap + 0.5 * min(one.reach(way) + other.reach(-way), 2.0 * size)) / closing
    apart = interval([one, other], way, closing, size)
    world = turn(random) if random.random() < 0.3 else (1.0, 0.0, 0.0, 0.0)
    axes = rotations(np.array([world]))[0]
    one, other = (replace(laid, turn=product(world, laid.turn)) for laid in (one, other))  # type: ignore[arg-type]
    starts = start(one, np.zeros(3), axes @ (speed * way)), start(other, axes @ place, axes @ back)
    contacts = all_pairs(2, laws(random))
    return Case((one.body, other.body), starts, contacts, (), 0.0, number(random, 1.0, 1.5) * t_end, apart)
