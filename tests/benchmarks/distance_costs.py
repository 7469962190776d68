"""What a question for a distance costs: ``python -m tests.benchmarks.distance_costs`` prints the table of the docs.

For two shapes of a centimetre: what the first question takes, in which search trees are built, and a later one, the
least of several; and FCL.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import nonsmooth as ns
from bodies import Sphere, TriangleMesh, Triangles
from nonsmooth.interfaces import Shape
from nonsmooth.queries.pair import ShapePair
from nonsmooth.queries.places import HERE
from tests.queries.shapes import SHAPES

CASES: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("sphere", "box", (0.0, 0.0, 0.03)),
    ("box", "box", (0.03, 0.001, 0.002)),
    ("box", "box", (0.03, 0.03, 0.03)),
    ("box", "box", (0.004, 0.001, 0.002)),
    ("cylinder", "cylinder", (0.03, 0.01, 0.02)),
    ("ellipsoid", "superellipsoid", (0.03, 0.01, 0.02)),
    ("ellipsoid", "superellipsoid", (0.004, 0.001, 0.002)),
    ("mesh", "sphere", (0.04, 0.01, 0.02)),
    ("mesh", "mesh", (0.05, 0.01, 0.02)),
    ("mesh", "box", (0.01, 0.01, 0.01)),
)
"""Shapes, and where the second is [m]."""


def _ball(fineness: int) -> TriangleMesh:
    import trimesh

    made = trimesh.creation.icosphere(fineness, 0.01)
    return TriangleMesh(Triangles(made.vertices, made.faces, "ball"))


def _least(ask: Callable[[], object], rounds: int = 20) -> float:
    """Return the least time of some calls [ms], of slow ones fewer."""
    ask()
    times: list[float] = []
    while len(times) < rounds and sum(times) < 1.0:
        began = time.perf_counter()
        ask()
        times.append(time.perf_counter() - began)
    return 1e3 * min(times)


def line(name: str, first: Shape, second: Shape, place: tuple[float, float, float]) -> str:
    """Return a row of the table."""
    began = time.perf_counter()
    found = ShapePair(first, second).at(HERE, (np.array(place), np.eye(3)))
    made = 1e3 * (time.perf_counter() - began)
    ways = []
    for by in ("fcl",):
        try:
            ns.distance(first, second, at=(None, place), by=by)
        except (ns.InvalidInput, ns.NoDistance):
            ways.append("")
            continue
        ways.append(f"{_least(lambda by=by: ns.distance(first, second, at=(None, place), by=by)):.2f}")  # type: ignore[misc]
    later = _least(lambda: ns.distance(first, second, at=(None, place)))
    cells = name, f"{1e3 * found.gap:.2f}", f"{found.error:.0e}", f"{made:.0f}", f"{later:.2f}", *ways
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Print the table in Markdown."""
    titles = "pair", "gap [mm]", "error [m]", "first [ms]", "later [ms]", "FCL [ms]"
    print("| " + " | ".join(titles) + " |")
    print("|---" * len(titles) + "|")
    # what is compiled once for a machine is none of the cost
    for one, two, place in CASES:
        ns.distance(SHAPES[two], SHAPES[one], at=(tuple(-np.array(place)), None))
    for one, two, place in CASES:
        print(line(f"{one}-{two}", SHAPES[one], SHAPES[two], place), flush=True)
    for fineness in (3, 5, 6):
        mesh = _ball(fineness)
        name = f"mesh of {len(mesh.drawing()[1])} triangles"
        print(line(f"{name}, ball", mesh, Sphere(0.01), (0.03, 0.001, 0.002)), flush=True)
        print(line(f"{name}, itself", mesh, mesh, (0.03, 0.001, 0.002)), flush=True)


if __name__ == "__main__":
    main()
