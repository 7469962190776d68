"""Properties of the kinematics of a contact pair."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import FEATURE, FRAME, PAIR, PAST_END
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.rotations import rotation, turned
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.functions import OLD, ROOM, Function, Functions
from nonsmooth.testing.property import Broken, Property, Row, properties
from nonsmooth.testing.rig import Pose, Rig

Array = NDArray[np.float64]
_DRAWS = 40
_STEP = 5e-4
_PLACE = (0.31, -0.23, 0.37)
"""Where the second body is in the simplest input, in units of the reach: on no axis of the first."""
_DEEP = 0.1
"""Penetration in units of the reach, deeper than which nothing is looked at."""
_RATE, _BIAS = 1e-7, 1e-5
"""Deviation from differences that counts as none, in units of the speeds and accelerations."""


def check_contact_kinematics(
    kinematics: ContactKinematics, first: Shape, second: Shape, *, reach: float | None = None
) -> list[Property]:
    """Return the properties of one contact of two shapes.

    Parameters
    ----------
    kinematics : ContactKinematics
        The contact, one of ``between(first, second)``.
    first, second : Shape
        The shapes that it was made for.
    reach : float, optional
        Largest distance of the bodies that is tried [m]; by default what holds both shapes.

    Raises
    ------
    InvalidInput
        If features of the contact are searched for: then it holds none.
    """
    if kinematics.candidates is not None:
        raise InvalidInput(
            type(kinematics).__name__,
            "must be a contact of given features (`candidates` None)",
            kinematics.candidates,
            "Check the contacts of small shapes, whose features are given, and compare runs of both.",
        )
    lengths = [shape.extent for shape in (first, second) if math.isfinite(shape.extent)]
    pair = _Pair(kinematics, (first, second), reach or sum(lengths) or 1.0)
    functions = Functions(lambda: [_geometry(kinematics, pair)])

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: pair.examine(name, trial)

    rows = [
        ("pair", "`between` gives it, for shapes of the classes in `pair`", pair.check_between),
        row(
            "writes its block", "it writes every number that can be non-zero, and nothing beyond the block", pair.writes
        ),
        row("axes", "normal and first tangent are unit vectors at right angles", pair.axes),
        row("witness points", "they are the gap apart, along the normal", pair.witness),
        row("feature", "the number of the feature is one of those named", pair.feature),
        row("gap rate", "the rate of the gap is its derivative in time, by differences", pair.gap_rate),
        row(
            "second-order terms",
            "those of gap and slip are the derivatives of their rates while u' = 0, by differences",
            pair.bias,
        ),
        row(
            "tangent follows the first body", "where both bodies turn together, so does the first tangent", pair.follows
        ),
        row(
            "frame invariance",
            "where both bodies are moved together, the gap stays and the normal turns with them",
            pair.invariant,
        ),
    ]
    return properties(kinematics, [*component_rows(kinematics), *functions.rows(), *functions.guarded(rows)])


def _space(reach: float) -> list[Variable]:
    space = [Variable(f"place_{c}", -reach, reach, part * reach) for c, part in zip("xyz", _PLACE, strict=True)]
    # small bodies as slow as that, or differences over a step do not tell a rate
    speed = min(reach, 1.0)
    for name, size in (("turn_a", 3.0), ("turn_b", 3.0), ("velocity_a", speed), ("velocity_b", speed)):
        space += [Variable(f"{name}_{c}", -size, size) for c in "xyz"]
    return space + [Variable(f"{name}_{c}", -2.0, 2.0) for name in ("spin_a", "spin_b") for c in "xyz"]


def _three(case: Case, name: str) -> Array:
    return np.array([case[f"{name}_{c}"] for c in "xyz"])


def _poses(case: Case) -> list[Pose]:
    unit = np.array([1.0, 0.0, 0.0, 0.0])
    places = np.zeros(3), _three(case, "place")
    return [(place, turned(unit, _three(case, f"turn_{s}"))) for place, s in zip(places, "ab", strict=True)]


def _frame(pose: Pose) -> Array:
    block = np.zeros(FRAME)
    block[:3], block[3:12] = pose[0], rotation(pose[1]).ravel()
    return block


def _geometry(kinematics: ContactKinematics, pair: _Pair) -> Function:
    inputs = [("a, b", _poses(case)) for case in draws(pair.space, 8, "geometry")]
    offered = kinematics.parameters()
    function, owner = kinematics.evaluator, type(kinematics).__name__

    def plain(poses: list[Pose]) -> Array:
        return _written(plain_caller(function, "pair", offered), poses)

    def compiled() -> Callable[[list[Pose]], Array]:
        call = compiled_caller(function, "pair", offered, owner)
        return lambda poses: _written(call, poses)

    return Function(kinematics, "evaluator", function, "pair", offered, plain, compiled, inputs)


def _written(call: Callable[..., Any], poses: Sequence[Pose]) -> Array:
    out = np.full(PAIR + ROOM, OLD)
    out[:PAIR] = 0.0
    call(_frame(poses[0]), _frame(poses[1]), out)
    return out


class _Pair:
    """A contact and where it is tried."""

    def __init__(self, kinematics: ContactKinematics, shapes: tuple[Shape, Shape], reach: float) -> None:
        self.kinematics, self.shapes = kinematics, shapes
        self.reach, self.space = reach, _space(reach)
        self._regular = 0

    @cached_property
    def rig(self) -> Rig:
        return Rig(self.kinematics, self.shapes)

    def examine(self, name: str, trial: Trial) -> None:
        self._regular = int(name not in ("gap rate", "second-order terms"))

        def shallow(law: ContactKinematics, case: Case) -> str:
            # where the cores of two bodies meet, the normal has no value
            return "" if self._deep(case) else trial(law, case)

        examine(name, [self.kinematics], self.space, shallow, _DRAWS)
        if self._regular == 0:
            raise Broken(f"it is smooth at none of {_DRAWS} places")

    def check_between(self) -> None:
        owner = type(self.kinematics)
        if not all(isinstance(shape, kind) for shape, kind in zip(self.shapes, owner.pair, strict=True)):
            raise Broken("the shapes are not of these classes", "pair", tuple(kind.__name__ for kind in owner.pair))
        if self.kinematics not in owner.between(*self.shapes):
            raise Broken("`between` gives other contacts for the shapes", "between", owner.between(*self.shapes))
        if not self.kinematics.features or len(set(self.kinematics.features)) != len(self.kinematics.features):
            raise Broken("features must have names, each another", "features", self.kinematics.features)

    def _deep(self, case: Case) -> bool:
        bounded = all(math.isfinite(shape.extent) for shape in self.shapes)
        return bounded and self._put(case).geometry[0] < -_DEEP * self.reach

    def _put(self, case: Case, dt: float = 0.0) -> Rig:
        poses, u = _poses(case), []
        for i, side in enumerate("ab"):
            velocity, spin = _three(case, f"velocity_{side}"), _three(case, f"spin_{side}")
            poses[i] = poses[i][0] + dt * velocity, turned(poses[i][1], dt * spin)
            u += [velocity, spin]
        self.rig.put(poses, np.concatenate(u))
        return self.rig

    def writes(self, law: ContactKinematics, case: Case) -> str:
        call = plain_caller(law.evaluator, "pair", law.parameters())
        clean = _written(call, _poses(case))
        other = _written(
            call, _poses(case | {"turn_a_x": case["turn_a_x"] + 1.0, "place_y": case["place_y"] - self.reach})
        )
        again = other.copy()
        call(_frame(_poses(case)[0]), _frame(_poses(case)[1]), again)
        wrong = np.flatnonzero(again[:PAIR] != clean[:PAIR])
        return f"number {wrong[0]} of the block is left from the call before" if len(wrong) else ""

    def axes(self, law: ContactKinematics, case: Case) -> str:
        block = self._put(case).geometry
        n, t = block[1:4], block[4:7]
        for words, value, wanted in (("|n|^2", n @ n, 1.0), ("|t1|^2", t @ t, 1.0), ("n . t1", n @ t, 0.0)):
            if abs(value - wanted) > 1e-9:
                return f"{words} is {value:.9g}"
        return ""

    def witness(self, law: ContactKinematics, case: Case) -> str:
        block = self._put(case).geometry
        apart = block[10:13] - block[7:10] - block[0] * block[1:4]
        if np.max(np.abs(apart)) > 1e-9 * (self.reach + abs(block[0])):
            return f"they are {block[10:13] - block[7:10]} apart, the gap is {block[0]:g} m along {block[1:4]}"
        return ""

    def feature(self, law: ContactKinematics, case: Case) -> str:
        number = float(self._put(case).geometry[FEATURE])
        return "" if number in range(len(law.features)) else f"it is {number:g}, of {len(law.features)} features"

    def gap_rate(self, law: ContactKinematics, case: Case) -> str:
        rate = float(self._put(case).rate[0])
        found = self._derivative(case, lambda rig: rig.geometry[:1])
        if found is None or abs(found[0] - rate) <= _RATE * (1.0 + self.reach):
            return ""
        return f"it is {rate:.9g} m/s, the differences give {found[0]:.9g}"

    def bias(self, law: ContactKinematics, case: Case) -> str:
        rig = self._put(case)
        axes, rate, bias = rig.axes, rig.rate, rig.bias
        found = self._derivative(case, lambda r: np.append(r.rate[0], r.rate[1:] @ r.axes[1:]))
        if found is None:
            return ""
        # the slip as a vector, whatever the tangents do; the terms are those in tangents that turn with the first body
        spin = float(_three(case, "spin_a") @ axes[0])
        expected = np.append(found[0], axes[1:] @ found[1:] + spin * np.array([rate[2], -rate[1]]))
        worst = int(np.argmax(np.abs(bias - expected)))
        if abs(bias[worst] - expected[worst]) <= _BIAS * (1.0 + float(np.max(np.abs(expected)))):
            return ""
        name = ("the gap", "the slip along t1", "the slip along t2")[worst]
        return f"that of {name} is {bias[worst]:.9g} m/s^2, the differences give {expected[worst]:.9g}"

    def _derivative(self, case: Case, value: Callable[[Rig], Array]) -> Array | None:
        """Return the derivative in time while u' = 0, None where a feature changes or it is not smooth."""
        feature = self._put(case).geometry[FEATURE]
        if self.rig.geometry[PAST_END] > 0.0:
            return None
        at: dict[int, Array] = {}
        for i in (-4, -2, -1, 1, 2, 4):
            rig = self._put(case, i * _STEP)
            if rig.geometry[FEATURE] != feature or rig.geometry[PAST_END] > 0.0:
                return None
            at[i] = np.array(value(rig))
        fine = (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * _STEP)
        coarse = (8.0 * (at[2] - at[-2]) - (at[4] - at[-4])) / (24.0 * _STEP)
        if np.max(np.abs(fine - coarse)) > 0.1 * _RATE * (1.0 + float(np.max(np.abs(fine)))):
            return None
        self._regular += 1
        return np.asarray(fine)

    def follows(self, law: ContactKinematics, case: Case) -> str:
        poses = _poses(case)
        self.rig.put(poses, np.zeros(12))
        before = self.rig.geometry[4:7]
        # a turn about the normal, so that a tangent fixed in space would show
        turn = 0.3 * self.rig.geometry[1:4]
        return self._together(case, turn, before, slice(4, 7), "first tangent")

    def invariant(self, law: ContactKinematics, case: Case) -> str:
        self.rig.put(_poses(case), np.zeros(12))
        before = self.rig.geometry
        turn = np.array([0.4, -0.3, 0.5])
        wrong = self._together(case, turn, before[1:4], slice(1, 4), "normal")
        gap = float(self.rig.geometry[0])
        if not wrong and abs(gap - before[0]) > 1e-9 * (self.reach + abs(gap)):
            return f"the gap is {before[0]:.9g} m, and {gap:.9g} m where both bodies are moved"
        return wrong

    def _together(self, case: Case, turn: Array, before: Array, part: slice, name: str) -> str:
        shift, axes = np.array([0.3, -0.2, 0.7]), rotation(turned((1.0, 0.0, 0.0, 0.0), turn))
        self.rig.put([(axes @ place + shift, turned(q, turn)) for place, q in _poses(case)], np.zeros(12))
        after, expected = self.rig.geometry[part], axes @ before
        if np.max(np.abs(after - expected)) > 1e-8:
            return f"the {name} becomes {after}, moved with the bodies it would be {expected}"
        return ""
