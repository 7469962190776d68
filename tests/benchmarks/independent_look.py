"""Do others find our gaps?  ``python -m tests.benchmarks.independent_look [PAIR] COUNT`` looks at COUNT poses a pair.

For every pair of kinds of bodies, of half-sizes of 4 to 10 mm, at random places and turns, apart, near and far: the
least gap of the contacts whose features face each other, beside the distance of their convex parts, FCL, and coal where
it is installed.  PAIR is one of them, or a kind, as "mesh", for its pairs with all others.

Sharp edges and corners have contacts where their nearest features stay the nearest under small motions: a face and a
corner, edges that cross.  Of a corner beside a corner or an edge there is none, as bodies that meet there meet by
others before; then the least gap that faces is another, or there is none.  Nor is there one of an edge and a rim less
than 0.01 rad from parallel.  Such poses, told by nearest points that hardly move on either body while their normal
makes small turns about some axis, are counted apart.
"""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from bodies import Plane, TriangleMesh
from bodies.queries.coal import Coal
from nonsmooth.errors import DoubtfulDistance, InvalidInput, NoDistance
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.pair import ShapePair
from nonsmooth.queries.result import DistanceResult
from nonsmooth.rotations import rotation
from tests.benchmarks import touches
from tests.benchmarks.contact_accuracy import NAMES
from tests.benchmarks.contact_gaps import Contacts
from tests.benchmarks.mesh_pairs import any_mesh
from tests.benchmarks.swept_pairs import capsule, hull

Array = NDArray[np.float64]
WRONG = 1e-9
"""Error of ours that counts [m]."""
_PER_SHAPES = 50
_BORDER = 1e-8
"""Way within which nearest points at the end of an edge may be told as points of the edge [m]."""
_SMALL, _PARALLEL = 1e-6, 0.01
"""Radius of curvature that counts as none [m], and angle of an edge and a rim, or of two, below which they do [rad]."""
DRAWN: dict[str, Callable[[Generator], Shape]] = {
    "plane": lambda rng: Plane(float(rng.uniform(-0.01, 0.01))),
    "sphere": touches.sphere,
    "ellipsoid": touches.ellipsoid,
    "superellipsoid": touches.superellipsoid,
    "boxy": touches.boxy,
    "mixed": touches.mixed,
    "capsule": capsule,
    "box": touches.box,
    "rounded box": touches.rounded(touches.box),
    "hull": hull,
    "rounded hull": touches.rounded(hull),
    **{name: draw for name, (draw, _) in {**touches.ROUND, **touches.ROUNDED_ROUND}.items()},
    "mesh": any_mesh,
}
PAIRS = [f"{one}-{two}" for one, two in itertools.combinations_with_replacement(DRAWN, 2) if two != "plane"]


@dataclass
class Library:
    """What a library says: poses compared, in doubt, off by more than it states, the largest difference [m]."""

    compared: int = 0
    doubtful: int = 0
    off: int = 0
    worst: float = 0.0


@dataclass
class Tally:
    """What was found of a pair.

    Attributes
    ----------
    poses, told, apart : int
        Looked at; with a gap that faces and is the distance; of corners that have no contact.
    wrong : list
        Poses whose gap is off: shapes, places, our gap, what is proved of the distance.
    worst : float
        Largest difference from what is proved [m], of those told.
    libraries : dict of str to Library
        By name.
    """

    poses: int = 0
    told: int = 0
    apart: int = 0
    wrong: list[tuple[Shape, Shape, Place, Place, float, DistanceResult]] = field(default_factory=list)
    worst: float = 0.0
    libraries: dict[str, Library] = field(default_factory=dict)


def table_pairs() -> set[frozenset[str]]:
    """Return the pairs of kinds that the table of accuracy lists."""
    return {frozenset(name.partition(",")[0].split("-")) for name in NAMES}


def _turn(rng: Generator) -> Array:
    q = rng.normal(size=4)
    return rotation(q / np.linalg.norm(q))


class _Asked:
    """Two shapes, asked in every way."""

    def __init__(self, first: Shape, second: Shape) -> None:
        self.shapes = first, second
        self.ours = Contacts(first, second, of_all=True)
        self._pair = ShapePair(first, second)
        self.libraries: dict[str, ShapePair] = {}
        for name in ("fcl", "coal") if Coal().installed else ("fcl",):
            try:
                self.libraries[name] = ShapePair(first, second, name)
            except InvalidInput:
                continue

    def proved(self, one: Place, two: Place) -> DistanceResult:
        """Return the distance by support functions alone."""
        return self._pair.at(one, two)


def _corners(shape: Shape, place: Place, point: Array) -> Callable[[Array], Array]:
    """Return the support of a shape in the world, next to a point: of a mesh that of the triangles that have it."""
    if isinstance(shape, TriangleMesh):
        vertices, faces = shape.drawing()
        own = place[1].T @ (point - place[0])
        a, b, c = np.moveaxis(vertices[faces], 1, 0)
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        inside = np.abs(np.einsum("ni,ni->n", own - a, normals)) < 1e-9
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.einsum("ni,ni->n", np.cross(q - p, own - p), normals) > -1e-9 * np.linalg.norm(q - p, axis=1)
        near = vertices[np.unique(faces[inside])] if np.any(inside) else vertices
        return lambda n: np.asarray(place[1] @ near[int(np.argmax(near @ (place[1].T @ n)))])
    assert shape.solid is not None
    support = shape.solid.support
    return lambda n: np.asarray(place[1] @ support(place[1].T @ n))


def has_no_contact(shapes: tuple[Shape, Shape], one: Place, two: Place, found: DistanceResult) -> bool:
    """Return whether the nearest points hardly move for some turn of the normal."""
    if shapes[0].solid is None:
        return False
    first, second = (
        _corners(shape, place, point)
        for shape, place, point in zip(shapes, (one, two), (found.first, found.second), strict=True)
    )
    n = found.normal
    t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    t /= np.linalg.norm(t)
    ways, e = (t, np.cross(n, t)), 1e-8
    own, other = np.zeros((2, 2)), np.zeros((2, 2))
    for j, way in enumerate(ways):
        up, down = n + e * way, n - e * way
        own[:, j] = [w @ (first(up) - first(down)) / (2.0 * e) for w in ways]
        other[:, j] = [w @ (second(-down) - second(-up)) / (2.0 * e) for w in ways]
    # along an edge the point jumps, the same way for all normals to one side: what counts is the way that it goes
    (ways_of, radii), (others_ways, others_radii) = (np.linalg.svd(rows)[:2] for rows in (own, other))
    both = (ways_of * radii) @ ways_of.T + (others_ways * others_radii) @ others_ways.T
    # of two lines at an angle the least radius is that of the rounder one times the square of the sine
    least = np.linalg.svd(both)[1][1]
    return bool(least < max(_SMALL, _PARALLEL**2 * min(radii[0], others_radii[0])))


def _is_corner(asked: _Asked, one: Place, two: Place, found: DistanceResult) -> bool:
    """Return whether there is no contact by design, here or beside: what ends here ends there, to :data:`_BORDER`."""
    beside = [(two[0] + way, two[1]) for way in _BORDER * np.vstack([np.eye(3), -np.eye(3)])]
    return has_no_contact(asked.shapes, one, two, found) or any(
        has_no_contact(asked.shapes, one, place, asked.proved(one, place)) for place in beside
    )


def _poses(asked: _Asked, rng: Generator) -> Iterator[tuple[Place, Place, DistanceResult]]:
    """Yield a pose anywhere, and one next to touching, with what is proved of each."""
    size = sum(shape.extent for shape in asked.shapes if np.isfinite(shape.extent))
    way = rng.normal(size=3)
    way *= size * rng.uniform(0.5, 4.0) / np.linalg.norm(way)
    one = rng.uniform(-0.1, 0.1, 3), _turn(rng)
    two = one[0] + way, _turn(rng)
    found = asked.proved(one, two)
    if found.gap <= 1e-6:
        return
    yield one, two, found
    gap = 10.0 ** rng.uniform(-7.0, -3.0)
    two = two[0] - (found.gap - gap) * found.normal, two[1]
    found = asked.proved(one, two)
    if found.gap > 1e-9:
        yield one, two, found


def _look(asked: _Asked, one: Place, two: Place, found: DistanceResult, tally: Tally) -> None:
    tally.poses += 1
    facing = asked.ours.least(one, two)
    ours = np.inf if facing is None else facing.gap
    slack = sum(shape.solid.set_back for shape in asked.shapes if shape.solid is not None) + WRONG
    if found.lower - slack <= ours <= found.upper + slack:
        tally.told += 1
        tally.worst = max(tally.worst, found.lower - ours, ours - found.upper)
    elif ours > found.upper and _is_corner(asked, one, two, found):
        tally.apart += 1
    else:
        tally.wrong.append((*asked.shapes, one, two, ours, found))
    gap = ours if abs(ours - found.gap) <= slack else found.gap
    for name, pair in asked.libraries.items():
        library = tally.libraries.setdefault(name, Library())
        try:
            told = pair.at(one, two)
        except DoubtfulDistance:
            library.doubtful += 1
            continue
        except NoDistance:
            # it takes what nearly touches for an overlap
            library.off += found.gap > 1e-9
            continue
        library.compared += 1
        library.off += not told.lower <= gap <= told.upper
        library.worst = max(library.worst, abs(told.gap - gap))


def look(pair: str, count: int, seed: int = 0, per_shapes: int = _PER_SHAPES) -> Tally:
    """Return what is found at about so many poses of a pair."""
    rng, tally = np.random.default_rng([seed, *pair.encode()]), Tally()
    draws = [DRAWN[kind] for kind in pair.split("-")]
    while tally.poses < count:
        try:
            asked = _Asked(*(draw(rng) for draw in draws))
        except InvalidInput:  # of no kinematics: a boxy one too thin, or a mesh with too many features
            continue
        for _ in range(per_shapes):
            for one, two, found in _poses(asked, rng):
                _look(asked, one, two, found, tally)
            if tally.poses >= count:
                break
    return tally


def main() -> None:
    """Print a line for every pair, or for those with the kind given, and every pose whose gap is wrong."""
    *words, count = sys.argv[1:]
    chosen = [pair for pair in PAIRS if not words or words[0] in (pair, *pair.split("-"))]
    titles = "pair", "poses", "told", "corners", "wrong", "worst [m]"
    more = [f"{name}: {what}" for name in ("FCL", "coal") for what in ("compared", "doubtful", "off", "worst [m]")]
    print("| " + " | ".join([*titles, *more, "[s]"]) + " |")
    print("|---" * (len(titles) + len(more) + 1) + "|")
    for pair in chosen:
        began = time.perf_counter()
        t = look(pair, int(count))
        cells = [pair, t.poses, t.told, t.apart, len(t.wrong), f"{t.worst:.0e}"]
        for name in ("fcl", "coal"):
            one = t.libraries.get(name)
            cells += [one.compared, one.doubtful, one.off, f"{one.worst:.0e}"] if one is not None else [""] * 4
        print("| " + " | ".join(map(str, [*cells, f"{time.perf_counter() - began:.1f}"])) + " |", flush=True)
        for first, second, one_place, two_place, ours, found in t.wrong[:3]:
            print(f"  {ours!r} is not within {found.lower!r} and {found.upper!r}: {first}, {second},")
            print(f"  {[x.tolist() for x in one_place]}, {[x.tolist() for x in two_place]}", flush=True)


if __name__ == "__main__":
    main()
