"""The search for features that may touch, beside FCL's trees: ``python -m tests.benchmarks.candidate_search [EDGES]``.

A box of 12 cm by 10 by 8 and a ring of 5000 triangles lie at random poses on hills with so many edges along a side of
2 m.  Printed are the median time in which the engine's search finds the pairs of features within 5 mm that may touch,
and that in which FCL finds all pairs of triangles of the hills and of the body, wider by as much, that meet; with the
time and the memory of FCL's tree of the hills.
"""

from __future__ import annotations

import argparse
import resource
import time
import warnings
from collections.abc import Callable
from typing import Any

import fcl
import numpy as np
from scipy.spatial.transform import Rotation

from bodies import Box, SurfaceSurface, TriangleMesh, Triangles
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Shape
from tests.bodies.meshes.parts import box, hills, torus
from tests.contact_calls import pair_caller

_POSES, _REACH = 40, 0.005


def _tree(points: Any, triangles: Any) -> Any:
    tree = fcl.BVHModel()
    tree.beginModel(len(points), len(triangles))
    tree.addSubModel(np.asarray(points, float), np.asarray(triangles))
    tree.endModel()
    return tree


def _timed(function: Callable[..., Any], *arguments: Any) -> float:
    start = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - start


def _row(
    ground: tuple[Any, Any], name: str, shape: Shape, wider: tuple[Any, Any], height: Callable[[Any], float]
) -> str:
    """Return the row of a body; ``height`` is what its frame is over the hills, for its axes [m]."""
    surface = TriangleMesh(Triangles(*ground))
    contacts = SurfaceSurface.between(surface, shape)
    search = contacts[0].candidates
    assert search is not None
    find = pair_caller(search.function, search.values, name)
    trees = _tree(*ground), _tree(*wider)
    rng, own, theirs, counts = np.random.default_rng(0), [], [], []
    for _ in range(_POSES):
        axes, (x, y) = Rotation.random(random_state=rng).as_matrix(), rng.uniform(-0.5, 0.5, 2)
        place = np.array([x, y, 0.03 * np.sin(9.0 * x) * np.cos(7.0 * y) + height(axes) + rng.uniform(0.0, 0.01)])
        objects = fcl.CollisionObject(trees[0]), fcl.CollisionObject(trees[1], fcl.Transform(axes, place))
        result = fcl.CollisionResult()
        request = fcl.CollisionRequest(num_max_contacts=100_000, enable_contact=True)
        theirs.append(_timed(fcl.collide, *objects, request, result))
        a, b, out = np.zeros(FRAME), np.zeros(FRAME), np.zeros(1 + 3 * (len(contacts) + 1))
        a[3:12], b[:3], b[3:12], out[0] = np.eye(3).ravel(), place, axes.ravel(), _REACH
        own.append(_timed(find, a, b, out))
        counts.append((out[0], len(result.contacts)))
    found, met = np.median(counts, axis=0)
    return f"| {name} | {1e3 * np.median(own):.2f} | {found:.0f} | {1e3 * np.median(theirs):.2f} | {met:.0f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("edges", type=int, nargs="?", default=220)
    warnings.simplefilter("ignore")
    ground = hills(parser.parse_args().edges)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    built = _timed(_tree, *ground)
    memory = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1e3
    print(f"{len(ground[1])} triangles: FCL's tree takes {built:.1f} s and {memory:.0f} MB")
    print("| body | search [ms] | pairs of features | FCL [ms] | pairs of triangles |")
    print("| --- | --- | --- | --- | --- |")
    halves = np.array([0.06, 0.05, 0.04])
    wider = box(*(2.0 * (halves + _REACH)))
    print(_row(ground, "box", Box(*halves), wider, lambda axes: float(np.abs(axes[2]) @ halves)))
    points, triangles = torus(50, 50, 0.08, 0.03)
    ring = TriangleMesh(Triangles(points, triangles))
    print(_row(ground, "ring", ring, (1.05 * np.asarray(points), triangles), lambda axes: 0.09))


if __name__ == "__main__":
    main()
