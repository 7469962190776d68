"""How exact the contact pairs are: ``python -m tests.benchmarks.contact_accuracy`` prints the table of the docs.

Every pose is made from a point on the first body with a normal there, and the point of the second that lies farthest
against it, put the gap apart: gap, normal and witness points are known to round-off.  Bodies are of 1 cm, half-sizes of
4 to 10 mm, and anywhere within 0.1 m of the origin.  The rates are those of the engine, against differences of the gap
itself over seven places along a motion with constant velocity and spin.

A pair of shapes is one line of :data:`PAIRS`, or, where features are chosen on both sides, of
:data:`tests.benchmarks.swept_pairs.SWEPT` and :data:`tests.benchmarks.mesh_pairs.MESHES`.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from bodies import Box, Capsule, Cone, ConvexHull, Cylinder, Disc, Ellipsoid, Frustum, Plane, Sphere, Superellipsoid
from bodies.shapes.polyhedron import Polyhedron
from nonsmooth.engine.kernel import PLAIN
from nonsmooth.interfaces import ContactKinematics, ConvexShape, Shape
from nonsmooth.model.layout import FRAME, GEOMETRY, PAST_END
from nonsmooth.plugins import registry
from nonsmooth.plugins.compile import bind
from nonsmooth.system.pairing import nearest_pair
from nonsmooth.testing.rig import Rig, rotation, turned
from tests.benchmarks.mesh_pairs import MESHES
from tests.benchmarks.swept_pairs import SWEPT

Array = NDArray[np.float64]
Touch = tuple[Shape, Array, Array]
"""A shape, a point of its surface and an outward normal there, in the frame of its body."""

GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-4)
"""[m]"""
_SMALL, _LARGE = 4e-3, 10e-3
_STEPS = 1e-3, 5e-4, 2.5e-4
"""Of the differences [s]; the first is taken with which they are smooth."""
_FIRST = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60.0
_SECOND = np.array([2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0]) / 180.0
_SPEED, _SPIN = 0.1, 3.0
_SMOOTH = 1e-9
"""The differences count where those of half the step agree, in units of the value; where not, a feature has changed."""


@dataclass(frozen=True)
class Pose:
    """Two shapes somewhere, and what is between them."""

    shapes: tuple[Shape, Shape]
    poses: tuple[tuple[Array, Array], tuple[Array, Array]]
    gap: float
    normal: Array
    witness: Array
    contact: int = 0


@dataclass(frozen=True)
class Errors:
    """The largest errors met, and what a query costs.

    Attributes
    ----------
    gap, normal, witness : float
        [m], [rad], [m].
    rate, acceleration : float
        Of g' and g'', in units of the largest that were met.
    differences : int
        Poses of which both were looked at.
    cost : float
        Of a call from Python [us]; nan in plain mode.
    """

    gap: float
    normal: float
    witness: float
    rate: float
    acceleration: float
    differences: int
    cost: float


def _quaternion(rng: Generator) -> Array:
    q = rng.normal(size=4)
    return np.asarray(q / np.linalg.norm(q))


def _place(rng: Generator) -> dict[str, float]:
    q = _quaternion(rng)
    place = dict(zip("xyz", rng.uniform(-2e-3, 2e-3, 3).tolist(), strict=True))
    return place | {f"orientation_{name}": float(value) for name, value in zip("wxyz", q, strict=True)}


def _sizes(rng: Generator) -> list[float]:
    return [float(x) for x in rng.uniform(_SMALL, _LARGE, 3)]


def ellipsoid(rng: Generator) -> ConvexShape:
    """Return an ellipsoid of any size and place."""
    return Ellipsoid(*_sizes(rng), **_place(rng))


def superellipsoid(rng: Generator) -> ConvexShape:
    """Return a superellipsoid, in half of the cases a rounded one."""
    (a, b, c), (along, across) = _sizes(rng), rng.uniform(1.1, 1.5, 2).tolist()
    return Superellipsoid(a, b, c, along, across, float(rng.choice([0.0, 1e-3])), **_place(rng))


def boxy(rng: Generator) -> ConvexShape:
    """Return a boxy superellipsoid."""
    return Superellipsoid(*_sizes(rng), *rng.uniform(0.2, 0.9, 2).tolist(), **_place(rng))


def mixed(rng: Generator) -> ConvexShape:
    """Return a superellipsoid with flat places along its third axis and sharp ones across, or the other way round."""
    exponents = [float(rng.uniform(0.2, 0.9)), float(rng.uniform(1.1, 1.5))]
    (a, b, c), (along, across) = _sizes(rng), exponents if rng.uniform() < 0.5 else exponents[::-1]
    return Superellipsoid(a, b, c, along, across, **_place(rng))


def sphere(rng: Generator) -> ConvexShape:
    """Return a sphere."""
    return Sphere(float(rng.uniform(_SMALL, _LARGE)), *rng.uniform(-2e-3, 2e-3, 3).tolist())


def anywhere(draw: Callable[[Generator], ConvexShape]) -> Callable[[Generator], Touch]:
    """Return a way to touch a smooth shape: at any normal."""

    def touch(rng: Generator) -> Touch:
        shape, n = draw(rng), rng.normal(size=3)
        n /= np.linalg.norm(n)
        return shape, shape.support(n), n

    return touch


def on_plane(rng: Generator) -> Touch:
    """Touch a plane."""
    plane = Plane(float(rng.uniform(-0.01, 0.01)))
    return plane, np.array([*rng.uniform(-0.1, 0.1, 2), plane.height]), np.array([0.0, 0.0, 1.0])


def box(rng: Generator) -> Polyhedron:
    """Return a box."""
    return Box(*_sizes(rng), **_place(rng))


def hull(rng: Generator) -> Polyhedron:
    """Return the hull of twelve points on an ellipsoid."""
    points = rng.normal(size=(12, 3))
    points *= np.array(_sizes(rng)) / np.linalg.norm(points, axis=1)[:, None]
    return ConvexHull(points.tolist(), **_place(rng))


def rounded(draw: Callable[[Generator], Polyhedron]) -> Callable[[Generator], Polyhedron]:
    """Return a way to draw polyhedra with a rounding of 0.5 to 2 mm."""
    return lambda rng: replace(draw(rng), rounding=float(rng.uniform(5e-4, 2e-3)))  # type: ignore[type-var]


def on(draw: Callable[[Generator], Polyhedron], part: str) -> Callable[[Generator], Touch]:
    """Return a way to touch a polyhedron on a face, an edge or a vertex, with any normal that belongs to it."""

    def touch(rng: Generator) -> Touch:
        shape = draw(rng)
        vertices, normals = np.array(shape.core.vertices), np.array(shape.core.planes)[:, :3]
        counts = {"face": len(normals), "edge": len(shape.core.edges), "vertex": len(vertices)}
        number = int(rng.integers(counts[part]))
        if part == "face":
            corners, faces = list(shape.core.faces[number]), [number]
        elif part == "edge":
            corners, faces = list(shape.core.edges[number][:2]), list(shape.core.edges[number][2:])
        else:
            corners, faces = [number], [i for i, loop in enumerate(shape.core.faces) if number in loop]
        shares, weights = rng.uniform(0.1, 1.0, len(corners)), rng.uniform(0.1, 1.0, len(faces))
        n = weights @ normals[faces]
        n /= np.linalg.norm(n)
        return shape, shares @ vertices[corners] / np.sum(shares) + shape.rounding * n, n

    return touch


def on_capsule(rng: Generator) -> Touch:
    """Touch a capsule, on its side in half of the cases."""
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    center = rng.uniform(-2e-3, 2e-3, 3)
    shape = Capsule(float(rng.uniform(1e-3, _SMALL)), float(rng.uniform(_SMALL, _LARGE)), *center, *axis.tolist())
    n = rng.normal(size=3)
    along = 1.0 if n @ axis > 0.0 else -1.0
    if rng.uniform() < 0.5:
        n -= n @ axis * axis
        along = float(rng.uniform(-0.95, 0.95))
    n /= np.linalg.norm(n)
    return shape, center + along * shape.half_length * axis + shape.radius * n, n


def _along(rng: Generator) -> dict[str, float]:
    names = [f"{kind}{c}" for kind in ("", "axis_") for c in "xyz"]
    axis = rng.normal(size=3)
    numbers = [*rng.uniform(-2e-3, 2e-3, 3), *axis / np.linalg.norm(axis)]
    return dict(zip(names, map(float, numbers), strict=True))


def cylinder(rng: Generator) -> Frustum:
    """Return a cylinder."""
    return Cylinder(*_sizes(rng)[:2], **_along(rng))


def cone(rng: Generator) -> Frustum:
    """Return a cone."""
    radius, half, _ = _sizes(rng)
    return Cone(radius, 2.0 * half, **_along(rng))


def disc(rng: Generator) -> Frustum:
    """Return a disc."""
    return Disc(_sizes(rng)[0], **_along(rng))


def on_round(draw: Callable[[Generator], Frustum], part: str) -> Callable[[Generator], Touch]:
    """Return a way to touch a cylinder, a cone or a disc on a cap, a rim, the side or the apex."""

    def touch(rng: Generator) -> Touch:
        shape = draw(rng)
        low, high, below, above, _, _, *rest = shape.frustum
        center, axes, (cos, sin) = np.array(rest[:3]), np.array(rest[3:12]).reshape(3, 3), rest[12:]
        angle, upper = rng.uniform(0.0, 2.0 * np.pi), bool(rng.integers(2)) and high > 0.0
        if part == "apex":
            upper = True
        radius, height, up = (high, above, 1.0) if upper else (low, below, -1.0)
        share = float(rng.uniform(0.05, 0.95))
        if part == "cap":
            away, along, radial, axial = share * radius, height, 0.0, up
        elif part == "side":
            away, along, radial, axial = low + share * (high - low), below + share * (above - below), cos, sin
        else:
            # between the normals of cap and side; a disc has no side, but another face
            flat = above == below
            start = -0.5 * np.pi if flat else float(np.arctan2(sin, cos))
            turn = start + share * (0.5 * np.pi if flat or upper else -0.5 * np.pi - start) * (2.0 if flat else 1.0)
            if upper and not flat:
                turn = start + share * (0.5 * np.pi - start)
            away, along, radial, axial = radius, height, float(np.cos(turn)), float(np.sin(turn))
        outward = np.array([np.cos(angle), np.sin(angle), 0.0])
        point = away * outward + np.array([0.0, 0.0, along])
        return shape, center + axes @ point, axes @ (radial * outward + np.array([0.0, 0.0, axial]))

    return touch


SMOOTH = {"sphere": sphere, "ellipsoid": ellipsoid, "superellipsoid": superellipsoid, "boxy": boxy}
PARTS = "face", "edge", "vertex"
ROUND: dict[str, tuple[Callable[[Generator], Frustum], tuple[str, ...]]] = {
    "cylinder": (cylinder, ("cap", "rim", "side")),
    "cone": (cone, ("cap", "rim", "side", "apex")),
    "disc": (disc, ("cap", "rim")),
}
PAIRS: dict[str, tuple[Callable[[Generator], Touch], Callable[[Generator], ConvexShape]]] = {
    "plane-ellipsoid": (on_plane, ellipsoid),
    "plane-superellipsoid": (on_plane, superellipsoid),
    "ellipsoid-sphere": (anywhere(ellipsoid), sphere),
    "ellipsoid-ellipsoid": (anywhere(ellipsoid), ellipsoid),
    "superellipsoid-sphere": (anywhere(superellipsoid), sphere),
    "superellipsoid-ellipsoid": (anywhere(superellipsoid), ellipsoid),
    "superellipsoid-superellipsoid": (anywhere(superellipsoid), superellipsoid),
    "plane-boxy": (on_plane, boxy),
    "plane-mixed": (on_plane, mixed),
    "boxy-sphere": (anywhere(boxy), sphere),
    "boxy-ellipsoid": (anywhere(boxy), ellipsoid),
    "boxy-superellipsoid": (anywhere(boxy), superellipsoid),
    "boxy-boxy": (anywhere(boxy), boxy),
    **{f"mixed-{name}": (anywhere(mixed), draw) for name, draw in SMOOTH.items()},
    "mixed-mixed": (anywhere(mixed), mixed),
    **{f"box-mixed, {part}": (on(box, part), mixed) for part in PARTS},
    **{
        f"{kind}-mixed, {part}": (on_round(touched, part), mixed)
        for kind, (touched, parts) in ROUND.items()
        for part in parts
    },
    "capsule-mixed": (on_capsule, mixed),
    **{f"box-{name}, {part}": (on(box, part), draw) for name, draw in SMOOTH.items() for part in PARTS},
    **{f"hull-{name}, {part}": (on(hull, part), draw) for name, draw in SMOOTH.items() for part in PARTS},
    **{
        f"{kind}-{name}, {part}": (on_round(touched, part), draw)
        for kind, (touched, parts) in ROUND.items()
        for name, draw in SMOOTH.items()
        for part in parts
    },
    **{f"rounded box-{name}, {part}": (on(rounded(box), part), SMOOTH[name]) for name in SMOOTH for part in PARTS},
    **{f"rounded hull-ellipsoid, {part}": (on(rounded(hull), part), ellipsoid) for part in PARTS},
    "capsule-ellipsoid": (on_capsule, ellipsoid),
    "capsule-superellipsoid": (on_capsule, superellipsoid),
    "capsule-boxy": (on_capsule, boxy),
}
"""How the first shape is touched, and the second, which has one farthest point in every direction."""
CHOSEN = {**SWEPT, **MESHES}
NAMES = (*PAIRS, *CHOSEN)
"""All lines."""


def _least_radius(shape: ConvexShape, n: Array) -> float:
    """Return the least radius of curvature where ``n`` is the normal [m], by differences."""
    first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    first /= np.linalg.norm(first)
    tangents, e = (first, np.cross(n, first)), 1e-4
    rows = [[t @ (shape.support(n + e * s) - shape.support(n - e * s)) / (2.0 * e) for s in tangents] for t in tangents]
    return float(np.linalg.eigvalsh(np.array(rows))[0])


def pose(pair: str, gap: float, rng: Generator) -> Pose:
    """Return a pose of a pair; one that overlaps more than its second shape is round there is drawn again."""
    if pair in CHOSEN:
        return Pose(*CHOSEN[pair](gap, rng))
    touch, draw = PAIRS[pair]
    while True:
        (first, point, normal), second = touch(rng), draw(rng)
        q = _quaternion(rng), _quaternion(rng)
        a, b = (rotation(one) for one in q)
        n = a @ normal
        if gap >= 0.0 or _least_radius(second, -b.T @ n) > -4.0 * gap:
            break
    place = rng.uniform(-0.1, 0.1, 3)
    witness = place + a @ point
    other = witness + gap * n - b @ second.support(-b.T @ n)
    return Pose((first, second), ((place, q[0]), (other, q[1])), gap, n, np.array([witness, witness + gap * n]))


def kinematics_of(shapes: tuple[Shape, Shape]) -> tuple[ContactKinematics, ...]:
    """Return the contacts of two shapes, by what is installed."""
    found = nearest_pair(registry.load_all("kinematics").values(), *shapes)
    if found is None or not found[1]:
        raise LookupError(f"no kinematics for {shapes}")
    return tuple(found[0].between(*shapes))


def _deviations(found: Pose, rng: Generator) -> tuple[tuple[float, float, float], tuple[float, ...] | None]:
    """Return errors of gap, normal and witness; rate, its error, acceleration, its error, if the motion is smooth."""
    contact = kinematics_of(found.shapes)[found.contact]
    rig = Rig(contact, found.shapes)
    u = np.concatenate([rng.normal(size=3) * size for size in (_SPEED, _SPIN, _SPEED, _SPIN)])
    rig.put(found.poses, u)
    block, rate, acceleration = rig.geometry, float(rig.rate[0]), float(rig.bias[0])
    normal = float(np.linalg.norm(np.cross(block[1:4], found.normal)))
    if block[1:4] @ found.normal < 0.0:
        normal = math.pi
    place = float(np.max(np.linalg.norm(block[7:13].reshape(2, 3) - found.witness, axis=1)))

    def differences(step: float) -> tuple[float, float, set[float]]:
        gaps, features = [], set()
        for i in range(-3, 4):
            t = i * step
            moved = [
                (p + t * u[6 * s : 6 * s + 3], turned(q, t * u[6 * s + 3 : 6 * s + 6]))
                for s, (p, q) in enumerate(found.poses)
            ]
            rig.put(moved, u)
            gaps.append(float(rig.geometry[0]))
            features.add(-1.0 if rig.geometry[PAST_END] > 0.0 else float(rig.geometry[29]))
        return float(_FIRST @ gaps) / step, float(_SECOND @ gaps) / step**2, features

    smooth = False
    for step in _STEPS:
        fine, coarse = differences(0.5 * step), differences(step)
        off = (abs(f - c) - _SMOOTH * abs(f) for f, c in zip(fine[:2], coarse[:2], strict=True))
        bounds = _SMOOTH * _SPEED, 100.0 * _SMOOTH * _SPEED * _SPIN
        smooth = len(coarse[2]) == 1 and all(one <= bound for one, bound in zip(off, bounds, strict=True))
        if smooth:
            break
    rates = rate, abs(fine[0] - rate), acceleration, abs(fine[1] - acceleration)
    return (abs(float(block[0]) - found.gap), normal, place), rates if smooth else None


def _cost(poses: list[Pose], times: int = 5, rounds: int = 4) -> float:
    """Return what a call from Python costs [us], of every pose the least of several times."""
    if PLAIN:
        return math.nan
    total = 0.0
    for one in poses:
        contact = kinematics_of(one.shapes)[one.contact]
        address, heap = bind(contact.evaluator, "pair", contact.parameters(), "benchmark")
        function = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(address)
        numbers, out = np.array(heap), np.zeros(GEOMETRY)
        frames = [np.concatenate([place, rotation(q).ravel(), np.zeros(FRAME - 12)]) for place, q in one.poses]
        given = [x.ctypes.data for x in (*frames, numbers, out)]
        function(*given)
        least = math.inf
        for _ in range(times):
            begin = time.perf_counter()
            for _ in range(rounds):
                function(*given)
            least = min(least, time.perf_counter() - begin)
        total += least / rounds
    return 1e6 * total / len(poses)


def measure(pair: str, draws: int, seed: int = 0) -> Errors:
    """Return the errors of a pair over ``draws`` poses at each of :data:`GAPS`."""
    rng = np.random.default_rng(seed)
    poses = [pose(pair, gap, rng) for gap in GAPS for _ in range(draws)]
    found = [_deviations(one, rng) for one in poses]
    statics = np.max([errors for errors, _ in found], axis=0)
    rates = np.array([rates for _, rates in found if rates is not None]).reshape(-1, 4)
    largest = np.max(np.abs(rates), axis=0)
    return Errors(
        float(statics[0]),
        float(statics[1]),
        float(statics[2]),
        float(largest[1] / largest[0]),
        float(largest[3] / largest[2]),
        len(rates),
        _cost(poses),
    )


def table(draws: int = 40) -> str:
    """Return the table of all pairs in Markdown."""
    titles = "pair", "gap [m]", "normal [rad]", "witness [m]", "$g'$", "$g''$", "query [µs]"
    lines = ["| " + " | ".join(titles) + " |", "|---" * len(titles) + "|"]
    for name in NAMES:
        e = measure(name, draws)
        numbers = [f"{x:.0e}" for x in (e.gap, e.normal, e.witness, e.rate, e.acceleration)]
        lines.append("| " + " | ".join([name, *numbers, f"{e.cost:.1f}"]) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
