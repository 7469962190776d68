"""How far gaps of convex pairs are from the truth: ``python -m tests.benchmarks.gap_poses [PAIR] COUNT``.

Poses are drawn anywhere, aligned up to tiny angles, and next to where one feature ends and another begins; then the
bodies are brought to known gaps from a millimetre to an overlap of a micrometre.  Nothing here follows the contact
pairs: the least gap of the contacts whose features face each other is proved by outlines of the bodies alone.

Along any unit vector n the gap of the support functions n . X - h_A(n) - h_B(-n) is a lower bound of the distance of
bodies apart, and the way between any two points of theirs an upper one; both are looked at for the normal and the
points of the contact.  Of an overlap, a point that both bodies have is looked for, and the gap has to be that of the
support functions along its normal and no less than that along any direction tried.  Every pose is looked at again a
way of 1e-7 m aside, over which a gap changes by no more.
"""

from __future__ import annotations

import ctypes
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.optimize import minimize

from nonsmooth.binding.compile import bind
from nonsmooth.engine.memory.blocks import FRAME, GEOMETRY, PAST_END
from nonsmooth.interfaces import ConvexShape
from nonsmooth.plugins import registry
from nonsmooth.system.pairing import nearest_pair
from tests.benchmarks.gap_draws import MODES, PAIRS, Array, Pose, back, directions, shapes_of
from tests.benchmarks.outlines import Outline, outline_of
from tests.bodies.every_pair import every_pair

WRONG = 1e-9
"""Error of a gap that counts [m]."""
WAY = 1e-7
"""Way over which no gap jumps [m]."""
TARGETS = 1e-3, 1e-6, 1e-9, 0.0, -1e-9, -1e-7, -1e-6
"""Gaps to which bodies apart are brought [m]."""
_SLIGHT = 1.5e-6
"""Overlap beyond which it is deep [m]."""
_PER_SHAPES = 250
_NONE = 1e-11
"""Distance of a point from a body that has it [m]."""


class Gaps:
    """The least gap that faces of all contacts of two shapes.

    Parameters
    ----------
    first, second : ConvexShape
        The shapes, in the order of their kinematics.
    """

    def __init__(self, first: ConvexShape, second: ConvexShape) -> None:
        found = nearest_pair(registry.load_all("kinematics").values(), first, second)
        assert found is not None
        kinematics, self._in_order = found
        shapes = (first, second) if self._in_order else (second, first)
        function = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)
        self._calls = []
        for contact in every_pair(kinematics.between(*shapes)):
            address, heap = bind(contact.evaluator, "pair", contact.parameters(), "gap_poses")
            self._calls.append((function(address), np.array(heap)))

    def __call__(self, first: Pose, second: Pose) -> Array:
        """Return gap, normal from the first and points of both, shape [k, 10]; inf where none faces."""
        if not self._in_order:
            out = self._of(second, first)
            out[:, 1:4] *= -1.0
            return out[:, [0, 1, 2, 3, 7, 8, 9, 4, 5, 6]]
        return self._of(first, second)

    def _of(self, first: Pose, second: Pose) -> Array:
        frames = [np.zeros((len(first[0]), FRAME)) for _ in range(2)]
        for frame, (place, turn) in zip(frames, (first, second), strict=True):
            frame[:, :3], frame[:, 3:12] = place, turn.reshape(-1, 9)
        k, block = len(first[0]), np.zeros(GEOMETRY)
        best = np.full((k, 10), np.nan)
        best[:, 0] = np.inf
        one, two, out, row = frames[0].ctypes.data, frames[1].ctypes.data, block.ctypes.data, 8 * FRAME
        for call, numbers in self._calls:
            heap = numbers.ctypes.data
            for i in range(k):
                block[PAST_END] = 0.0
                call(one + i * row, two + i * row, heap, out)
                # what is not a number is none of the right gaps
                if block[PAST_END] <= 0.0 and not block[0] >= best[i, 0]:
                    best[i, :4], best[i, 4:] = block[:4], block[7:13]
        return best


@dataclass(frozen=True)
class Found:
    """What was found at some poses, each of shape [k]: error of a proved gap [m], and what it is of.

    Attributes
    ----------
    gap, error : Array
        The gap, and how far it is off at most [m]; infinite if it is not proved.
    apart : Array
        Whether the gap is above 0.
    """

    gap: Array
    error: Array
    lower: Array
    common: NDArray[np.bool_]


def along(a: Outline, b: Outline, first: Pose, second: Pose, n: Array) -> Array:
    """Return the gap of the support functions along unit vectors, shape [k]."""
    way = np.einsum("ki,ki->k", n, second[0] - first[0])
    return np.asarray(way - a.height(back(first[1], n)) - b.height(-back(second[1], n)))


def _common(a: Outline, b: Outline, first: Pose, second: Pose, points: Array) -> Array:
    """Return whether both bodies have the points."""
    one = a.outside(back(first[1], points - first[0])) - a.radius
    two = b.outside(back(second[1], points - second[0])) - b.radius
    return np.asarray(np.maximum(one, two) <= _NONE)


def _search_common(a: Outline, b: Outline, first: Pose, second: Pose, start: Array) -> bool:
    """Return whether a search ends at a point that both bodies have."""

    def outside(x: Array) -> float:
        one = a.outside(back(first[1], x - first[0])) - a.radius
        two = b.outside(back(second[1], x - second[0])) - b.radius
        return 1e3 * float(np.max(np.maximum([one, two], 0.0)))

    for begin in (start, first[0][0], second[0][0]):
        found = minimize(outside, begin, method="Nelder-Mead", options={"xatol": 1e-13, "fatol": 1e-13})
        if found.fun <= 1e3 * _NONE:
            return True
    return False


def proved(a: Outline, b: Outline, first: Pose, second: Pose, rows: Array, rng: Generator) -> Found:
    """Return by how much gaps are off at most, by outlines alone."""
    gap, n, p, q = rows[:, 0], rows[:, 1:4], rows[:, 4:7], rows[:, 7:10]
    # without a gap by the line of centres, or any of one centre
    lost, way = ~np.isfinite(gap)[:, None], second[0] - first[0]
    way = np.where(np.any(way != 0.0, axis=1)[:, None], way, 1.0)
    n = np.where(lost, way / np.linalg.norm(way, axis=1)[:, None], n)
    p, q = np.where(lost, first[0], p), np.where(lost, second[0], q)
    lower = along(a, b, first, second, n)
    m = back(first[1], n)
    off = a.outside(back(first[1], p - first[0]) - a.radius * m)
    off = np.maximum(off, b.outside(back(second[1], q - second[0]) + b.radius * back(second[1], n)))
    off = np.maximum(off, np.linalg.norm(q - p - gap[:, None] * n, axis=1))
    # behind a point of the core with the normal n the body has a radius of points; what it is off is an error
    common = (gap <= 0.0) & (gap + a.radius + b.radius >= 0.0) & (off <= WRONG)
    error = np.maximum(off, np.abs(gap - lower))
    error = np.maximum(error, np.abs(np.linalg.norm(n, axis=1) - 1.0))
    # of an overlap: a point of both, and no direction with a larger gap
    middle = np.stack([first[0], second[0]])
    for share in np.linspace(0.0, 1.0, 9):
        common |= _common(a, b, first, second, p + share * (q - p))
        common |= _common(a, b, first, second, middle[0] + share * (middle[1] - middle[0]))
    for i in np.flatnonzero(((gap < -_NONE) | lost[:, 0]) & ~common):
        common[i] = _search_common(a, b, _at(first, np.array([i])), _at(second, np.array([i])), p[i])
    error = np.where((gap < -_NONE) & ~common, np.inf, error)
    best = np.full(len(gap), -np.inf)
    for tried in _tried(first, second, n, rng):
        best = np.maximum(best, along(a, b, first, second, tried))
    error = np.maximum(error, np.maximum(best - gap, 0.0))
    return Found(gap, np.where(np.isfinite(error) & np.isfinite(gap), error, np.inf), np.maximum(best, lower), common)


def _tried(first: Pose, second: Pose, n: Array, rng: Generator) -> Iterator[Array]:
    for pose in (first, second):
        for i in range(3):
            yield pose[1][:, :, i]
            yield -pose[1][:, :, i]
    way = second[0] - first[0]
    apart = np.any(way != 0.0, axis=1)[:, None]
    yield np.where(apart, way / np.maximum(np.linalg.norm(way, axis=1), 1e-300)[:, None], n)
    for size in (1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0):
        for _ in range(3):
            near = n + size * directions(rng, len(n))
            yield near / np.linalg.norm(near, axis=1)[:, None]


@dataclass(frozen=True)
class Tally:
    """What was found at the poses of a pair.

    Attributes
    ----------
    poses : int
        Looked at.
    none, wrong, jumps : int
        Without a gap; with one that is off by more than 1e-9 m; whose gap changes by more than 1e-7 m over that way.
    deep, longer : int
        Overlaps by more than a micrometre, and those of them without a way out, or of which another one is shorter.
    worst : float
        Largest error of what is not wrong [m].
    cost : float
        Of a pose with all contacts, called from Python [us].
    """

    poses: int = 0
    none: int = 0
    wrong: int = 0
    jumps: int = 0
    deep: int = 0
    longer: int = 0
    worst: float = 0.0
    cost: float = 0.0

    def __add__(self, other: Tally) -> Tally:
        total = self.poses + other.poses
        return Tally(
            total,
            self.none + other.none,
            self.wrong + other.wrong,
            self.jumps + other.jumps,
            self.deep + other.deep,
            self.longer + other.longer,
            max(self.worst, other.worst),
            (self.cost * self.poses + other.cost * other.poses) / max(total, 1),
        )


Note = Callable[[str, ConvexShape, ConvexShape, Pose, Pose, float, float], None]
"""Told of a pose that is wrong: what, shapes, poses, gap and a lower bound."""


def _at(pose: Pose, chosen: NDArray[Any]) -> Pose:
    return pose[0][chosen], pose[1][chosen]


def look(shapes: tuple[ConvexShape, ConvexShape], mode: str, rng: Generator, k: int, note: Note | None = None) -> Tally:
    """Return what is found at k poses of two shapes, and as many at which they nearly touch."""
    gaps, (a, b) = Gaps(*shapes), [outline_of(shape) for shape in shapes]
    first, second = MODES[mode](a, b, rng, k)
    begin = time.perf_counter()
    rows = gaps(first, second)
    cost = 1e6 * (time.perf_counter() - begin) / k
    tally = replace(_judge(gaps, shapes, (a, b), first, second, rows, rng, note, mode), cost=cost)
    apart = np.isfinite(rows[:, 0]) & (rows[:, 0] > 1e-6)
    if not np.any(apart):
        return tally
    first, second, rows = _at(first, apart), _at(second, apart), rows[apart]
    target = rng.choice(TARGETS, (len(rows), 1))
    second = second[0] - (rows[:, :1] - target) * rows[:, 1:4], second[1]
    near = gaps(first, second)
    found = _judge(gaps, shapes, (a, b), first, second, near, rng, note, f"{mode}, near")
    # the way from the first pose to here is along the normal, so that the gap is known
    return tally + replace(found, cost=cost)


def _judge(
    gaps: Gaps,
    shapes: tuple[ConvexShape, ConvexShape],
    outlines: tuple[Outline, Outline],
    first: Pose,
    second: Pose,
    rows: Array,
    rng: Generator,
    note: Note | None,
    mode: str,
) -> Tally:
    a, b = outlines
    found = proved(a, b, first, second, rows, rng)
    lost = ~np.isfinite(found.gap)
    deep = (found.gap < -_SLIGHT) | (lost & found.common & (found.lower < -_SLIGHT))
    none = lost & ~deep
    right = found.error <= WRONG
    wrong = ~lost & ~right & ~(deep & found.common)
    aside = second[0] + WAY * directions(rng, len(rows)), second[1]
    after = gaps(first, aside)[:, 0]
    jumps = ~lost & (wrong | ~deep) & ~(np.abs(after - found.gap) <= WAY + 1e-12)
    longer = deep & ~right & ~wrong
    if note is not None:
        for kind, where in (("none", none), ("wrong", wrong), ("jump", jumps & ~wrong), ("longer", longer)):
            for i in np.flatnonzero(where):
                poses = _at(first, np.array([i])), _at(second, np.array([i]))
                note(f"{kind}, {mode}", *shapes, *poses, float(found.gap[i]), float(found.lower[i]))
    worst = float(np.max(found.error[right & ~deep], initial=0.0))
    none_, wrong_, jumps_, deep_, longer_ = (int(np.sum(x)) for x in (none, wrong, jumps, deep, longer))
    return Tally(len(rows), none_, wrong_, jumps_, deep_, longer_, worst)


def measure(pair: str, count: int, seed: int = 0, per_shapes: int = _PER_SHAPES, note: Note | None = None) -> Tally:
    """Return what is found at about so many poses of a pair."""
    rng, tally = np.random.default_rng([seed, *pair.encode()]), Tally()
    while tally.poses < count:
        shapes = shapes_of(pair, rng)
        for mode in MODES:
            tally += look(shapes, mode, rng, min(per_shapes, max(1, count // 6)), note)
    return tally


def main() -> None:
    """Print a line for every pair, or for those whose name has the word given."""
    *words, count = sys.argv[1:]
    chosen = [pair for pair in PAIRS if not words or words[0] in (pair, *pair.split("-"))]
    titles = "pair", "poses", "none", "wrong", "jumps", "deep", "longer", "worst [m]", "query [us]"
    print("| " + " | ".join(titles) + " |")
    print("|---" * len(titles) + "|")
    for pair in chosen:
        t = measure(pair, int(count))
        cells = pair, t.poses, t.none, t.wrong, t.jumps, t.deep, t.longer, f"{t.worst:.0e}", f"{t.cost:.1f}"
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
