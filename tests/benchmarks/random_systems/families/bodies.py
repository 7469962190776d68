"""Bodies with flat faces, or with axes along which they meet."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    Compound,
    ConeBody,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    HullBody,
    MeshBody,
    Part,
    Triangles,
)
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.solids import Random, prism, upright

_SIDES = ((0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7))
_FACES = ((0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), *_SIDES)
Corners = tuple[tuple[float, float, float], ...]


def _corners(x: float, y: float, z: float) -> Corners:
    ring = ((-x, -y), (x, -y), (x, y), (-x, y))
    return tuple((i, j, k) for k in (-z, z) for i, j in ring)


def _halves(random: Random, size: float) -> tuple[float, float, float]:
    ratios = random.choice([0.4, 0.6, 0.8, 1.0], 2)
    return size, float(ratios[0]) * size, float(ratios[1]) * size


def _prism(random: Random, size: float) -> Body:
    n = int(random.choice([3, 5, 6, 8]))
    ring = [(size * math.cos(2.0 * math.pi * k / n), size * math.sin(2.0 * math.pi * k / n)) for k in range(n)]
    return HullBody(tuple((x, y, z) for z in (-0.8 * size, 0.8 * size) for x, y in ring))


def _outline(random: Random, size: float, name: str) -> Body:
    return MeshBody(prism(name, 1.5 * size * upright(name, float(random.choice([0.3, 0.7])))))


def _compound(random: Random, size: float) -> Body:
    bar, block = BoxBody(size, 0.4 * size, 0.4 * size), BoxBody(0.5 * size, 0.5 * size, 0.5 * size)
    if random.random() < 0.5:
        return Compound((Part(block), Part(block, (size, 0.0, 0.0))))
    return Compound((Part(bar), Part(bar, (0.0, 0.0, 0.8 * size), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))))


def _feet(random: Random) -> dict[str, float]:
    return {"foot_height": 0.0} if random.random() < 0.4 else {}


_MADE: dict[str, Callable[[Random, float], Body]] = {
    "cube": lambda random, size: BoxBody(size, size, size),
    "brick": lambda random, size: BoxBody(*_halves(random, size)),
    "rounded brick": lambda random, size: BoxBody(*_halves(random, size), rounding=0.1 * size),
    "hull": lambda random, size: HullBody(_corners(*_halves(random, size))),
    "prism": _prism,
    "mesh": lambda random, size: MeshBody(Triangles(_corners(*_halves(random, size)), _FACES, "box")),
    "L": lambda random, size: _outline(random, size, "L"),
    "U": lambda random, size: _outline(random, size, "U"),
    "compound": _compound,
    "cylinder": lambda random, size: CylinderBody(size, float(random.choice([0.7, 1.0, 1.4])) * size, **_feet(random)),
    "rounded cylinder": lambda random, size: CylinderBody(size, size, rounding=0.1 * size, **_feet(random)),
    "coin": lambda random, size: CylinderBody(size, 0.1 * size, **_feet(random)),
    "cone": lambda random, size: ConeBody(size, 2.0 * size, **_feet(random)),
    "disc": lambda random, size: DiscBody(size, **_feet(random)),
    "rounded disc": lambda random, size: DiscBody(size, rounding=0.1 * size, **_feet(random)),
    "capsule": lambda random, size: CapsuleBody(0.6 * size, size),
    "ball": lambda random, size: Ball(size),
    "ellipsoid": lambda random, size: EllipsoidBody(*_halves(random, size)),
}
_SHARP = ("cube", "brick", "hull", "mesh", "prism")
"""The commonest ones, of which half of all bodies are."""


def bodies(random: Random, size: float, n: int) -> list[Body]:
    """Return ``n`` bodies of about a size [m], equal mostly; else one differs in size, or all in kind."""
    choice = random.random()

    def one(scale: float = 1.0) -> Body:
        kind = str(random.choice(_SHARP if random.random() < 0.5 else list(_MADE)))
        return _MADE[kind](random, scale * size)

    if choice < 0.08:
        return [one() for _ in range(n)]
    first = one()
    equal: list[Body] = [dataclasses.replace(first) for _ in range(n)]  # type: ignore[type-var]
    if choice < 0.2 and isinstance(first, BoxBody):
        wide = first.half_x, float(random.choice([0.5, 1.2, 2.0])) * first.half_y, first.half_z
        equal[int(random.integers(n))] = BoxBody(*wide, rounding=first.rounding)
    return equal
