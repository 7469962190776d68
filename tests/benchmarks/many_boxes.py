"""Boxes in an open box: ``python -m tests.benchmarks.many_boxes [BOXES] [--spacing M] [--time S]``.

Boxes of 4 cm stand apart from each other over a plate between four walls, and all may touch all. Printed are the number
of declared contacts, processor time [s] and largest memory of the process so far [MB] after each stage: declaration,
assembly, and the run.
"""

from __future__ import annotations

import argparse
import itertools
import resource
import time

import nonsmooth as ns
from bodies import BoxBody, Plate, Wall
from laws import Coulomb, EnergeticImpact, Unilateral

_LAWS = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.3))
_HALF = 0.02
"""Half of the edge of a box [m]."""


def scene(n: int, spacing: float) -> ns.System:
    """Boxes in layers of five by five, whose centres are ``spacing`` apart [m], and walls behind them."""
    boxes = [BoxBody(_HALF, _HALF, _HALF, density=1000.0) for _ in range(n)]
    wall = 3.0 * spacing
    sides = ((wall, 0.0), (-wall, 0.0), (0.0, wall), (0.0, -wall))
    walls = [Wall(point=(x, y, 0.0), normal=(-x / wall, -y / wall, 0.0)) for x, y in sides]
    system = ns.System([Plate(), *walls, *boxes])
    for i, box in enumerate(boxes):
        layer, row, column = i // 25, i // 5 % 5, i % 5
        system.place(box, position=(spacing * (column - 2), spacing * (row - 2), spacing * (layer + 0.5)))
    for one, other in (*itertools.product(system.bodies[:5], boxes), *itertools.combinations(boxes, 2)):
        system.contact(one, other, normal=_LAWS.normal, friction=_LAWS.friction, impact=_LAWS.impact)
    return system


def _report(stage: str, began: float) -> float:
    now = time.process_time()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{stage:10} {now - began:6.2f} s {memory:6.0f} MB", flush=True)
    return now


def main() -> None:
    """Print time and memory of each stage."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("boxes", nargs="?", type=int, default=100)
    parser.add_argument("--spacing", type=float, default=0.1)
    parser.add_argument("--time", type=float, default=0.05)
    asked = parser.parse_args()
    now = time.process_time()
    system = scene(asked.boxes, asked.spacing)
    now = _report("declared", now)
    model = ns.assemble(system)
    now = _report("assembled", now)
    model.run(asked.time)
    _report("run", now)
    print(f"{len(system.contacts)} declared contacts")


if __name__ == "__main__":
    main()
