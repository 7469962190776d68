"""Bodies on hills of many triangles: ``python -m tests.benchmarks.bodies_on_hills [EDGES BALLS BOXES RINGS]``.

Balls of 3 cm, boxes of 12 cm by 10 by 8 and rings of 5000 triangles fall on hills with so many edges along a side of
2 m, and roll and tumble there for a second, or for ``--time``.  Printed are triangles, contacts, time to make the
system and of its run, steps, impacts, when and how it ended, the open share of the energy, and the memory of the
process.  That no gap is deeper than the gap tolerance at an event the run looks at itself, and ends where one is.
"""

from __future__ import annotations

import argparse
import itertools
import resource
import time
import warnings

import numpy as np

import nonsmooth as ns
from bodies import Ball, BoxBody, DrivenBody, MeshBody, TriangleMesh, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.interfaces import Body
from tests.bodies.meshes.parts import hills, torus

_CELLS = [(x, y, z) for z in (0.2, 0.45, 0.7) for x in (-0.35, -0.12, 0.12, 0.35) for y in (-0.35, -0.12, 0.12, 0.35)]
"""Where bodies start, apart from each other however they are turned [m]."""


def scene(edges: int, balls: int, boxes: int, rings: int, seed: int) -> ns.System:
    """Return hills and bodies over them, each pair of them in contact."""
    rng = np.random.default_rng(seed)
    ground = DrivenBody(carried=(TriangleMesh(Triangles(*hills(edges))),))
    movers: list[Body] = [
        *(Ball(0.03) for _ in range(balls)),
        *(BoxBody(0.06, 0.05, 0.04, mass=1.0) for _ in range(boxes)),
        *(MeshBody(Triangles(*torus(50, 50, 0.08, 0.03)), mass=1.0) for _ in range(rings)),
    ]
    system = ns.System([ground, *movers])
    for one, two in itertools.combinations(system.bodies, 2):
        system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    order = rng.permutation(16 if len(movers) <= 16 else len(_CELLS))
    for body, cell in zip(movers, order[: len(movers)], strict=True):
        turn = rng.normal(size=4)
        system.place(
            body,
            position=_CELLS[cell],
            orientation=turn / np.linalg.norm(turn),
            velocity=0.2 * rng.normal(size=3),
            angular_velocity=rng.normal(size=3),
        )
    return system


def main() -> None:
    """Print the row."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("edges", 60), ("balls", 20), ("boxes", 5), ("rings", 2)):
        parser.add_argument(name, type=int, nargs="?", default=default)
    parser.add_argument("--time", type=float, default=1.0, help="time of the run [s]")
    parser.add_argument("--seed", type=int, default=7)
    given = parser.parse_args()
    if given.balls + given.boxes + given.rings > len(_CELLS):
        parser.error(f"there is room for {len(_CELLS)} bodies")
    warnings.simplefilter("ignore")
    entry_addresses()
    start = time.perf_counter()
    system = scene(given.edges, given.balls, given.boxes, given.rings, given.seed)
    made = time.perf_counter()
    try:
        solution = ns.simulate(system, given.time)
    except ns.RunFailed as failure:
        if not isinstance(failure.solution, ns.Solution):
            raise
        solution = failure.solution
    run = time.perf_counter() - made
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print("| triangles | contacts | made | run | steps | impacts | end | residual | memory |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    print(
        f"| {4 * given.edges**2 + 8 * given.edges} | {len(system.contacts)} | {made - start:.0f} s | {run:.0f} s "
        f"| {solution.counters.steps} | {int((solution.events.cause == Cause.IMPACT).sum())} "
        f"| {solution.t_end:.3f} s: {solution.message} | {solution.energy.residual:.0e} | {memory:.2f} GB |"
    )


if __name__ == "__main__":
    main()
