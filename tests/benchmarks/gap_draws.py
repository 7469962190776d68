"""Shapes and poses for :mod:`tests.benchmarks.gap_poses`: anywhere, aligned, and where one feature ends."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from bodies import Capsule, Cone, Cylinder, Disc, Ellipsoid, Sphere, Superellipsoid
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexShape
from tests.benchmarks.outlines import Outline

Array = NDArray[np.float64]
Pose = tuple[Array, Array]
"""Places, shape [k, 3], and rotations, shape [k, 3, 3]."""


def _size(rng: Generator) -> float:
    return float(np.exp(rng.uniform(np.log(2e-3), np.log(2e-2))))


def _rounding(rng: Generator, rounded: bool, least: float) -> float:
    return float(rng.uniform(0.05, 0.6) * least) if rounded else 0.0


def _cylinder(rng: Generator, rounded: bool = False) -> ConvexShape:
    radius, half = _size(rng), _size(rng)
    return Cylinder(radius, half, rounding=_rounding(rng, rounded, min(radius, half)))


def _cone(rng: Generator, rounded: bool = False) -> ConvexShape:
    radius, height = _size(rng), 2.0 * _size(rng)
    return Cone(radius, height, rounding=_rounding(rng, rounded, 0.4 * min(radius, 0.5 * height)))


def _disc(rng: Generator, rounded: bool = False) -> ConvexShape:
    radius = _size(rng)
    return Disc(radius, rounding=_rounding(rng, rounded, radius))


def _ellipsoid(rng: Generator, rounded: bool = False) -> ConvexShape:
    assert not rounded
    return Ellipsoid(_size(rng), _size(rng), _size(rng))


def _sphere(rng: Generator, rounded: bool = False) -> ConvexShape:
    assert not rounded
    return Sphere(_size(rng))


def _capsule(rng: Generator, rounded: bool = False) -> ConvexShape:
    assert not rounded
    return Capsule(_size(rng), _size(rng))


def _super(along: tuple[float, float], across: tuple[float, float]) -> Callable[..., ConvexShape]:
    def draw(rng: Generator, rounded: bool = False) -> ConvexShape:
        sizes = _size(rng), _size(rng), _size(rng)
        exponents = float(rng.uniform(*along)), float(rng.uniform(*across))
        if sum(along) != sum(across) and rng.uniform() < 0.5:
            exponents = exponents[1], exponents[0]
        return Superellipsoid(*sizes, *exponents, _rounding(rng, rounded, min(sizes)))

    return draw


SMOOTH: dict[str, Callable[..., ConvexShape]] = {
    "ellipsoid": _ellipsoid,
    "sharp": _super((1.0, 1.6), (1.0, 1.6)),
    "boxy": _super((0.2, 1.0), (0.2, 1.0)),
    "mixed": _super((0.2, 1.0), (1.0, 1.6)),
}
"""Ellipsoids and superellipsoids, by exponents over and under 1; next to 2 they are sharp as cones."""
ROUND: dict[str, Callable[..., ConvexShape]] = {
    "sphere": _sphere,
    "capsule": _capsule,
    "cylinder": _cylinder,
    "cone": _cone,
    "disc": _disc,
}
_UNSWEPT = "ellipsoid", "sphere", "capsule"
DRAWN: dict[str, Callable[[Generator], ConvexShape]] = {
    **SMOOTH,
    **ROUND,
    **{
        f"rounded {name}": partial(draw, rounded=True)
        for name, draw in {**SMOOTH, **ROUND}.items()
        if name not in _UNSWEPT
    },
}
_SMOOTHS = [name for name in DRAWN if name.removeprefix("rounded ") in SMOOTH]
_ROUNDS = [name for name in DRAWN if name.removeprefix("rounded ") in ROUND]
SMOOTH_PAIRS = [f"{one}-{two}" for one in _ROUNDS for two in _SMOOTHS] + [
    f"{one}-{two}" for i, one in enumerate(_SMOOTHS) for two in _SMOOTHS[i:]
]
ROUND_PAIRS = [f"{one}-{two}" for i, one in enumerate(_ROUNDS) for two in _ROUNDS[i:]]
PAIRS = (*SMOOTH_PAIRS, *ROUND_PAIRS)


def directions(rng: Generator, k: int) -> Array:
    n = rng.normal(size=(k, 3))
    return np.asarray(n / np.linalg.norm(n, axis=1)[:, None])


def _turns(q: Array) -> Array:
    """Return the rotations of quaternions, shapes [k, 4] and [k, 3, 3]."""
    a, b, c, d = (q / np.linalg.norm(q, axis=1)[:, None]).T
    rows = [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    return np.ascontiguousarray(np.moveaxis(np.array(rows), -1, 0))


def _tiny(rng: Generator, k: int) -> Array:
    """Return numbers of any order of magnitude down to round-off, many of them 0, shape [k, 1]."""
    return np.where(rng.uniform(size=(k, 1)) < 0.25, 0.0, 10.0 ** rng.uniform(-16.0, -0.5, (k, 1)))


def mul(matrices: Array, vectors: Array) -> Array:
    return np.asarray(np.einsum("kij,kj->ki", matrices, vectors))


def back(matrices: Array, vectors: Array) -> Array:
    return np.asarray(np.einsum("kji,kj->ki", matrices, vectors))


def _onto(one: Array, two: Array, rng: Generator) -> Array:
    """Return rotations that turn unit vectors into others, with any turn about these."""

    def frames(n: Array) -> Array:
        t = np.cross(n, directions(rng, len(n)))
        t /= np.linalg.norm(t, axis=1)[:, None]
        return np.stack([n, t, np.cross(n, t)], axis=2)

    return np.asarray(frames(two) @ np.swapaxes(frames(one), 1, 2))


def _special(outline: Outline, rng: Generator, k: int) -> tuple[Array, Array]:
    """Return normals next to those at which one feature ends, and points of the core there, shapes [k, 3]."""
    pick, angle = rng.integers(0, 4, (k, 1)), rng.uniform(0.0, 2.0 * np.pi, (k, 1))
    quarter = rng.uniform(size=(k, 1)) < 0.5
    angle = np.where(quarter, np.round(angle / (0.25 * np.pi)) * 0.25 * np.pi, angle)
    ring = np.hstack([np.cos(angle), np.sin(angle), np.zeros((k, 1))])
    axial = np.copysign(1.0, rng.uniform(-1.0, 1.0, (k, 1))) * np.array([[0.0, 0.0, 1.0]])
    lean = rng.normal(size=(k, 1))
    if outline.circles:
        low, high, below, above = outline.circles
        lean = np.full((k, 1), (low - high) / max(above - below, 1e-300) if above > below else 0.0)
    n = np.where(pick <= 1, axial, ring + np.where(pick == 2, lean, 0.0) * np.array([[0.0, 0.0, 1.0]]))
    n = n + _tiny(rng, k) * directions(rng, k)
    n /= np.linalg.norm(n, axis=1)[:, None]
    points = outline.support(n)
    if outline.circles:
        # on a cap next to its edge the normal is the axis
        low, high, below, above = outline.circles
        upper = n[:, 2] > 0.0
        radius, height = np.where(upper, high, low), np.where(upper, above, below)
        inner = np.column_stack([radius[:, None] * (1.0 - _tiny(rng, k)) * ring[:, :2], height])
        on_cap = (pick[:, 0] == 0) & (radius > 0.0)
        points = np.where(on_cap[:, None], inner, points)
        n = np.where(on_cap[:, None], np.copysign(1.0, n[:, 2:]) * np.array([[0.0, 0.0, 1.0]]), n)
    return n, points


def _first(rng: Generator, k: int) -> Pose:
    q = rng.normal(size=(k, 4))
    q[rng.uniform(size=k) < 0.2] = [1.0, 0.0, 0.0, 0.0]
    return rng.uniform(-0.1, 0.1, (k, 3)), _turns(q)


def _anywhere(a: Outline, b: Outline, rng: Generator, k: int) -> tuple[Pose, Pose]:
    place, turn = _first(rng, k)
    away = (a.size + b.size) * rng.uniform(0.05, 1.3, (k, 1))
    away = np.where(rng.uniform(size=(k, 1)) < 0.1, 0.5 * rng.uniform(size=(k, 1)), away)
    return (place, turn), (place + away * directions(rng, k), _turns(rng.normal(size=(k, 4))))


def _aligned(a: Outline, b: Outline, rng: Generator, k: int) -> tuple[Pose, Pose]:
    place, turn = _first(rng, k)
    halves = 0.125 * np.pi * rng.integers(0, 8, (k, 1))
    axis = np.eye(3)[rng.integers(0, 3, k)]
    second = _turns(np.hstack([np.cos(halves), np.sin(halves) * axis]))
    second = second @ _turns(np.hstack([np.ones((k, 1)), _tiny(rng, k) * rng.normal(size=(k, 3))]))
    way = rng.integers(-1, 2, (k, 3)) * rng.choice([1.0, 1.0, 0.5], (k, 3)) + _tiny(rng, k) * rng.normal(size=(k, 3))
    way *= (a.size + b.size) * rng.uniform(0.3, 1.1, (k, 1))
    return (place, turn), (place + mul(turn, way), turn @ second)


def _bordering(a: Outline, b: Outline, rng: Generator, k: int) -> tuple[Pose, Pose]:
    place, turn = _first(rng, k)
    (n, p), (m, q) = _special(a, rng, k), _special(b, rng, k)
    anyhow = rng.uniform(size=(k, 1)) < 0.5
    m = np.where(anyhow, directions(rng, k), m)
    q = np.where(anyhow, b.support(m), q)
    second = _onto(m, -n, rng)
    gap = 10.0 ** rng.uniform(-4.0, -1.0, (k, 1))
    way = p + (a.radius + b.radius + gap) * n - mul(second, q)
    return (place, turn), (place + mul(turn, way), turn @ second)


MODES = {"anywhere": _anywhere, "aligned": _aligned, "bordering": _bordering}


def shapes_of(pair: str, rng: Generator) -> tuple[ConvexShape, ConvexShape]:
    """Draw the shapes of a pair; a boxy one is not thinner than it may be."""
    one, two = pair.split("-")
    while True:
        try:
            return DRAWN[one](rng), DRAWN[two](rng)
        except InvalidInput:
            continue
