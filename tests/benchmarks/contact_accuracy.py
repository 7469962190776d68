"""Errors of all contact pairs, as CSV: ``python -m tests.benchmarks.contact_accuracy``.

The page on accuracy shows what is stored in docs/pages/figures/contact_accuracy.csv.

Every pose is made from a point on the first body with a normal there, and the point of the second that lies farthest
against it, put the gap apart: gap, normal and witness points are known to round-off.  Bodies are of 1 cm, half-sizes of
4 to 10 mm, and anywhere within 0.1 m of the origin.  The rates are those of the engine, against differences of the gap
itself over seven places along a motion with constant velocity and spin.  How a gap is found is what the kinematics say
of their evaluator; beside it stands the error that FCL states where a question for a distance goes to it.

A pair of shapes is one line of :data:`PAIRS`, or, where features are chosen on both sides, of
:data:`tests.benchmarks.swept_pairs.SWEPT`, :data:`tests.benchmarks.round_pairs.ROUND_PAIRS` and
:data:`tests.benchmarks.mesh_pairs.MESHES`.
"""

from __future__ import annotations

import contextlib
import csv
import ctypes
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.binding.compile import bind
from nonsmooth.engine.memory.blocks import FRAME, GEOMETRY, PAST_END
from nonsmooth.errors import InvalidInput, NoDistance
from nonsmooth.interfaces import ConvexShape, FeaturePair, Shape
from nonsmooth.plugins import registry
from nonsmooth.rotations import rotation, turned
from nonsmooth.system.pairing import nearest_pair
from nonsmooth.testing.puck import ContactRig
from tests.benchmarks.mesh_pairs import MESHES
from tests.benchmarks.round_pairs import ROUND_PAIRS
from tests.benchmarks.swept_pairs import SWEPT
from tests.benchmarks.touches import (
    ROUND,
    ROUNDED_ROUND,
    Touch,
    anywhere,
    box,
    boxy,
    ellipsoid,
    hull,
    mixed,
    on,
    on_capsule,
    on_plane,
    on_round,
    quaternion,
    rounded,
    sphere,
    superellipsoid,
)
from tests.bodies.every_pair import every_pair

Array = NDArray[np.float64]
COLUMNS = (
    "pair",
    "found by",
    "gap [m]",
    "normal [rad]",
    "witness [m]",
    "first rate",
    "second rate",
    "query [µs]",
    "FCL [m]",
)
"""Rates are relative to the largest one of the pair."""
GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-4)
"""[m]"""
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
    """The largest errors met.

    Attributes
    ----------
    gap, normal, witness : float
        [m], [rad], [m].
    rate, acceleration : float
        Of g' and g'', in units of the largest that were met.
    differences : int
        Poses of which both were looked at.
    """

    gap: float
    normal: float
    witness: float
    rate: float
    acceleration: float
    differences: int


SMOOTH = {"sphere": sphere, "ellipsoid": ellipsoid, "superellipsoid": superellipsoid, "boxy": boxy}
ROUNDED_AND_SMOOTH = (
    ("rounded cylinder", "ellipsoid"),
    ("rounded cone", "superellipsoid"),
    ("rounded disc", "sphere"),
    ("rounded cylinder", "boxy"),
)
PARTS = "face", "edge", "vertex"
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
    **{
        f"{kind}-{name}, {part}": (on_round(ROUNDED_ROUND[kind][0], part), SMOOTH[name])
        for kind, name in ROUNDED_AND_SMOOTH
        for part in ROUNDED_ROUND[kind][1]
    },
    **{f"rounded box-{name}, {part}": (on(rounded(box), part), SMOOTH[name]) for name in SMOOTH for part in PARTS},
    **{f"rounded hull-ellipsoid, {part}": (on(rounded(hull), part), ellipsoid) for part in PARTS},
    "capsule-ellipsoid": (on_capsule, ellipsoid),
    "capsule-superellipsoid": (on_capsule, superellipsoid),
    "capsule-boxy": (on_capsule, boxy),
}
"""How the first shape is touched, and the second, which has one farthest point in every direction."""
CHOSEN = {**SWEPT, **MESHES, **ROUND_PAIRS}
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
        q = quaternion(rng), quaternion(rng)
        a, b = (rotation(one) for one in q)
        n = a @ normal
        if gap >= 0.0 or _least_radius(second, -b.T @ n) > -4.0 * gap:
            break
    place = rng.uniform(-0.1, 0.1, 3)
    witness = place + a @ point
    other = witness + gap * n - b @ second.support(-b.T @ n)
    return Pose((first, second), ((place, q[0]), (other, q[1])), gap, n, np.array([witness, witness + gap * n]))


def kinematics_of(shapes: tuple[Shape, Shape]) -> tuple[FeaturePair, ...]:
    """Return every pair of features of two shapes as a contact, by the installed kinematics."""
    found = nearest_pair(registry.load_all("kinematics").values(), *shapes)
    if found is None or not found[1]:
        raise LookupError(f"no kinematics for {shapes}")
    return every_pair(found[0].between(*shapes))


def _deviations(found: Pose, rng: Generator) -> tuple[tuple[float, float, float], tuple[float, ...] | None]:
    """Return errors of gap, normal and witness; rate, its error, acceleration, its error, if the motion is smooth."""
    contact = kinematics_of(found.shapes)[found.contact]
    rig = ContactRig(contact, found.shapes)
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


def _drawn(pair: str, draws: int, rng: Generator) -> list[Pose]:
    return [pose(pair, gap, rng) for gap in GAPS for _ in range(draws)]


def _way(pose: Pose) -> str:
    """Return how a gap is found, as the kinematics say it of their evaluator."""
    owner = type(kinematics_of(pose.shapes)[pose.contact])
    return (owner.evaluator.__doc__ or "").rstrip(".").removeprefix("The ").removeprefix("A ")


def _library(poses: list[Pose]) -> str:
    """Return the largest error that FCL states at poses apart [m]; nothing if it does not know the shapes."""
    errors = []
    for one in poses:
        with contextlib.suppress(InvalidInput, NoDistance):
            errors.append(ns.distance(*one.shapes, at=one.poses, by="fcl").error)
    return f"{max(errors):.0e}" if errors else ""


def measure(pair: str, draws: int, seed: int = 0) -> Errors:
    """Return the errors of a pair over ``draws`` poses at each of :data:`GAPS`."""
    rng = np.random.default_rng(seed)
    poses = _drawn(pair, draws, rng)
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
    )


def rows(draws: int = 40) -> Iterator[list[str]]:
    """Yield the columns and then the numbers of each pair, as soon as it is measured."""
    yield list(COLUMNS)
    for name in NAMES:
        poses = _drawn(name, draws, np.random.default_rng(0))
        e, cost = measure(name, draws), _cost(poses)
        numbers = [f"{x:.0e}" for x in (e.gap, e.normal, e.witness, e.rate, e.acceleration)]
        yield [name, _way(poses[0]), *numbers, f"{cost:.1f}", _library(poses[::9])]


if __name__ == "__main__":
    writer = csv.writer(sys.stdout, lineterminator="\n")
    for row in rows():
        writer.writerow(row)
        sys.stdout.flush()
