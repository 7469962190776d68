"""Balls over hills of many triangles: ``python -m tests.benchmarks.large_mesh [EDGES ...] [--radius R] ...``.

One row for each number of edges along a side of 2 m: triangles, time to make mesh and contacts, patches, time of a run
in which a ball, or an ellipsoid, falls into a valley and rolls there, its impacts, the memory that all took, which is
the highest so far, so that numbers of edges should rise, and what was told of the contacts beforehand.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import re
import resource
import time
import warnings

import nonsmooth as ns
from bodies import Ball, DrivenBody, EllipsoidBody, TriangleMesh, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import entry_addresses
from tests.bodies.meshes.parts import hills


def main(sides: list[int], radius: float, ellipsoid: bool, t_end: float) -> None:
    """Print the rows."""
    warnings.simplefilter("ignore")
    entry_addresses()
    print("| triangles | mesh | contacts | patches | run | impacts | residual | memory | told |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    before, told = _memory(), io.StringIO()
    for n in sides:
        start = time.perf_counter()
        ground = DrivenBody(carried=(TriangleMesh(Triangles(*hills(n))),))
        ball = EllipsoidBody(radius, 0.8 * radius, 0.6 * radius) if ellipsoid else Ball(radius)
        made = time.perf_counter()
        system = ns.System([ground, ball], 9.81)
        with contextlib.redirect_stderr(told):
            contacts = system.contact(
                ground, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5)
            )
        system.place(ball, position=(0.1, 0.1, 0.18 + radius))
        paired = time.perf_counter()
        solution = ns.simulate(system, t_end)
        run = time.perf_counter() - paired
        impacts = int((solution.events.cause == Cause.IMPACT).sum())
        size, memory = 4 * n * n + 8 * n, _memory() - before
        said = re.findall(rf" {size} .*some (.*) of memory.* and (.*), longer", told.getvalue())
        print(
            f"| {size} | {made - start:.1f} s | {paired - made:.1f} s | {len(contacts)} | {run:.2f} s "
            f"| {impacts} | {solution.energy.residual:.0e} | {memory:.0f} MB | {' and '.join(sum(said, ()))} |",
            flush=True,
        )


def _memory() -> float:
    """Return the most that the process has had [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("edges", nargs="*", type=int, default=[20, 50, 100, 220])
    parser.add_argument("--radius", type=float, default=0.02)
    parser.add_argument("--ellipsoid", action="store_true")
    parser.add_argument("--time", type=float, default=1.0)
    chosen = parser.parse_args()
    main(chosen.edges, chosen.radius, chosen.ellipsoid, chosen.time)
