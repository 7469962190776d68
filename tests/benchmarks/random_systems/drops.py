"""Drops past and onto a held or a falling body over a plate: the collision must not be missed.

    python -m tests.benchmarks.random_systems.drops FIRST COUNT [--workers N --seconds S --out FOLDER]

Two bodies of all kinds; one is dropped or thrown down so that it meets the other by less than all of its width, often
by as little as a hundredth of a millimetre, or straight on, and both may touch the plate.
"""

from __future__ import annotations

import numpy as np

from bodies import DrivenBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth import ContactLaws
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.campaign import Draws, campaign, parser_of
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.families.tumbling import turn
from tests.benchmarks.random_systems.pieces import pieces_of, rotations
from tests.benchmarks.random_systems.solids import KINDS, free_body, held_shape, number


def _widths(body: Body, q: tuple[float, ...], way: np.ndarray) -> tuple[float, float]:
    """Return how far a body in a pose reaches along a direction and downwards [m]."""
    from tests.benchmarks.random_systems.gaps import farthest

    return tuple(
        max(farthest(p, rotations(np.array([q]))[0].T @ d) for p in pieces_of(body))
        for d in (way, np.array([0.0, 0.0, -1.0]))
    )  # type: ignore[return-value]


def case_of(seed: int) -> Case:
    """Return the drop of a number."""
    random = np.random.default_rng([20_262, seed])
    size = float(random.choice([0.006, 0.012, 0.02]))
    held = random.random() < 0.5
    one, other = str(random.choice(KINDS)), str(random.choice(KINDS))
    falling = free_body(random, one, size)
    angle = random.uniform(0.0, 2.0 * np.pi)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    orientation, its = turn(random), turn(random)
    obstacle: Body = (
        DrivenBody(Rest(orientation=its), (held_shape(random, other, size),))  # type: ignore[arg-type]
        if held
        else free_body(random, other, size)
    )
    wide, low = _widths(falling, orientation, way)
    width, depth = _widths(obstacle, its, -way)
    tall = max(_widths(obstacle, its, way)[1], max(shape.extent for shapes in obstacle.frames for shape in shapes))
    # negative where the origin of a body is that far outside of it
    reach = wide + width
    overlap = 10.0 ** random.uniform(-5.0, np.log10(abs(reach))) if random.random() < 0.8 else reach
    place = (reach - overlap) * way
    base = depth + float(random.uniform(1e-3, 0.03))
    height = base + tall + low + float(random.uniform(2e-3, 0.1))
    spot = tuple(np.round([place[0], place[1], base], 6).tolist())
    if held:
        obstacle = DrivenBody(Rest(position=spot, orientation=its), obstacle.carried)  # type: ignore[arg-type,attr-defined]
    friction = Frictionless() if random.random() < 0.5 else Coulomb(number(random, 0.0, 0.8))
    laws = ContactLaws(Unilateral(), friction, EnergeticImpact(number(random, 0.0, 1.0)))
    spin = (0.0, 0.0, 0.0)
    if random.random() < 0.3:
        spin = tuple(np.round(10.0 * random.normal(size=3), 3).tolist())
    start = Start(
        "place",
        (
            ("position", (0.0, 0.0, round(height, 6))),
            ("orientation", orientation),
            ("velocity", (0.0, 0.0, -number(random, 0.0, 1.5))),
            ("angular_velocity", spin),
        ),
    )
    lies = None if held else Start("place", (("position", spot), ("orientation", its)))
    plate = Plate()
    contacts = ((0, 1, laws), (1, 2, laws)) if held else ((0, 1, laws), (0, 2, laws), (1, 2, laws))
    if random.random() < 0.5:
        contacts = contacts[::-1]
    return Case((plate, falling, obstacle), (None, start, lies), contacts, (), 9.81, 0.2, 2e-4)


if __name__ == "__main__":
    campaign(Draws(case_of, lambda seed: "drop"), parser_of(__doc__).parse_args())
