"""Balls over hills of many triangles: ``python -m tests.benchmarks.large_mesh [EDGES ...]``.

One row for each number of edges along a side of 2 m: triangles, time to make mesh and contacts, patches, time of a run
of a second in which a ball falls into a valley and rolls there, its impacts, and the memory of the process.
"""

from __future__ import annotations

import resource
import sys
import time
import warnings

import nonsmooth as ns
from bodies import Ball, DrivenBody, TriangleMesh, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.kernel import room_addresses
from nonsmooth.engine.modes import IMPACT
from tests.bodies.meshes.parts import hills

RADIUS = 0.02


def main(sides: list[int]) -> None:
    """Print the rows."""
    warnings.simplefilter("ignore")
    room_addresses()
    print("| triangles | mesh | contacts | patches | run | impacts | residual | memory |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for n in sides:
        start = time.perf_counter()
        ground, ball = DrivenBody(carried=(TriangleMesh(Triangles(*hills(n))),)), Ball(RADIUS)
        made = time.perf_counter()
        system = ns.System([ground, ball], 9.81)
        contacts = system.contact(ground, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
        system.place(ball, position=(0.1, 0.1, 0.2))
        paired = time.perf_counter()
        solution = ns.simulate(system, 1.0)
        run = time.perf_counter() - paired
        impacts = int((solution.events.cause == IMPACT).sum())
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
        print(
            f"| {4 * n * n + 8 * n} | {made - start:.1f} s | {paired - made:.1f} s | {len(contacts)} | {run:.2f} s "
            f"| {impacts} | {solution.energy.residual:.0e} | {memory:.2f} GB |",
            flush=True,
        )


if __name__ == "__main__":
    main([int(word) for word in sys.argv[1:]] or [20, 50, 100, 220])
