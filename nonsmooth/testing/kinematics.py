"""Conformance checks of contact kinematics: gap, normal, witness points, and their derivatives in time.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.binding.source import name_of
from nonsmooth.engine.memory import blocks
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.rotations import rotation, turned
from nonsmooth.testing.claims import GIVEN, Claim, Claims, Inapplicable, claim, rows
from nonsmooth.testing.differences import slope
from nonsmooth.testing.features import every_pair, first_pairs
from nonsmooth.testing.functions import CheckedFunction, function_rows, left_over, plain_caller
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber, draws
from nonsmooth.testing.movement import SHIFT, three
from nonsmooth.testing.outcome import NotChecked, Row, Subject
from nonsmooth.testing.property import Property, properties_of
from nonsmooth.testing.puck import ContactRig, Pose
from nonsmooth.types import Array

_DRAWS, _MOST_DRAWS = 40, 400
_STEP = 5e-4
_PLACE = (0.31, -0.23, 0.37)
"""Place of the second body in the simplest input, relative to the largest distance of the bodies (``reach``). The first
body is at the origin, and the place is off its axes."""
_DEEP = 0.1
"""Largest penetration of two bounded bodies at which a contact is checked, relative to the largest distance at which
bodies are drawn (``reach``). Deeper inside, the normal may be undefined."""
_RATE, _BIAS = 1e-7, 1e-5
"""Allowed deviation of the gap rate, and of the second-order terms of gap and slip (the derivatives of gap rate and
slip velocity while u' = 0), from differences; relative to their size."""
_UNIT = np.array([1.0, 0.0, 0.0, 0.0])
_AT_PLACES, _MOVED = Claims(), Claims()
"""Claims about bodies at drawn places, and claims about bodies that are moved together, respectively."""
_NORMAL, _TANGENT = slice(blocks.NORMAL, blocks.TANGENT), slice(blocks.TANGENT, blocks.POINT_A)


def check_contact_kinematics(
    kinematics: type[ContactKinematics],
    first: Shape,
    second: Shape,
    *,
    contacts: Sequence[int] | None = None,
    reach: float | None = None,
) -> list[Property]:
    """Return the properties of contacts of two shapes.

    Parameters
    ----------
    kinematics : type
        The class that makes the contacts.
    first, second : Shape
        Two shapes of the classes in its ``pair``.
    contacts : sequence of int, optional
        Numbers of the contacts in ``between(first, second)``; by default the first with each evaluator.  If features
        are searched for, each pair of features counts as a contact, and the default is the first pair of each kind.
    reach : float, optional
        Largest distance of the bodies along each axis [m]; by default the sum of the shapes' finite extents, or 1 m if
        that is zero.

    Raises
    ------
    InvalidInput
        The shapes are not of the classes in ``pair``. There are no contacts between them. A contact has no names of
        features.
    """
    made = _between(kinematics, first, second)
    if contacts is None:
        chosen = list(first_pairs(made))
    else:
        every = list(every_pair(made))
        chosen = [every[number] for number in contacts]
    lengths = [shape.extent for shape in (first, second) if math.isfinite(shape.extent)]
    options = {"shapes": (first, second), "reach": reach or sum(lengths) or 1.0}
    found = []
    for contact in chosen:
        _check_record(kinematics, contact)
        label = _label(contact) if len(made) > 1 else ""
        found += properties_of(Subject(contact, _rows, options, kinematics, label=label))
    return found


def _between(kinematics: type[ContactKinematics], first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
    """Contacts of two shapes; InvalidInput if the shapes are of other classes, or have no contact."""
    for shape, kind in zip((first, second), kinematics.pair, strict=True):
        if not isinstance(shape, kind):
            name = kind.__name__
            rule = f"must be a {name}, as `pair` says"
            raise InvalidInput(f"{kinematics.__name__}: shape", rule, shape, f"Give a {name}.")
    made = kinematics.between(first, second)
    if not made:
        raise InvalidInput(f"{kinematics.__name__}.between", "must return a contact", made, "Return at least one.")
    return made


def _label(contact: FeaturePair) -> str:
    """Return the name of a contact: its features, or kind and numbers of a pair that a search found."""
    candidate = contact.values.get("candidate")
    if isinstance(candidate, tuple):
        return " ".join(f"{number:g}" for number in candidate[:3])
    return contact.features[0]


def _check_record(kinematics: type[ContactKinematics], contact: FeaturePair) -> None:
    """Raise InvalidInput if a contact has no names of features."""
    names = contact.features
    if not names or len(set(names)) != len(names):
        remedy = "Name every pair of features, each differently."
        raise InvalidInput(f"{kinematics.__name__}: features", "must be different names, at least one", names, remedy)


def _rows(contact: FeaturePair, shapes: tuple[Shape, Shape], reach: float) -> list[Row]:
    """Return the properties of one contact of two shapes, whose bodies are at most ``reach`` apart [m]."""
    # not empty as soon as the contact was smooth at an input
    smooth: set[int] = set()
    rig = functools.cache(lambda: ContactRig(contact, shapes))
    bounded = all(math.isfinite(shape.extent) for shape in shapes)
    placed = Drawn(_numbers(reach), lambda case: _Placed(case, rig(), reach, smooth).shallow(bounded))
    table = functools.partial(rows, components=lambda: [contact], count=_DRAWS, given=[placed])
    found = [
        *table(_AT_PLACES),
        *(
            Row(one.name, one.says, functools.partial(_examine_where_smooth, one.at(placed), contact, smooth))
            for one in (_gap_rate, _second_order_terms)
        ),
        *table(_MOVED),
    ]
    return function_rows(lambda: [_evaluator(contact, reach)], found)


def _examine_where_smooth(one: Claim, contact: FeaturePair, smooth: set[int]) -> None:
    """Try a claim that can be tested only at inputs at which the contact is smooth.

    The claim is tried with 40 inputs. If the contact is smooth at none of them, it is tried with 400 inputs. A trial
    adds an entry to the set ``smooth`` if the contact is smooth at its input. Raises NotChecked if the set remains
    empty: given features such as two edges face each other in hardly any random pose.
    """
    smooth.clear()
    for count in (_DRAWS, _MOST_DRAWS):
        if not smooth:
            one.examine([contact], count)
    if not smooth:
        raise NotChecked(f"the contact is smooth at none of {_MOST_DRAWS} places")


def _numbers(reach: float) -> tuple[DrawnNumber, ...]:
    found = [DrawnNumber(f"place_{c}", -reach, reach, part * reach) for c, part in zip("xyz", _PLACE, strict=True)]
    # small bodies move slowly, so that they move by a small part of their size within a step of the differences
    speed = min(reach, 1.0)
    sizes = {"turn_a": 3.0, "turn_b": 3.0, "velocity_a": speed, "velocity_b": speed, "spin_a": 2.0, "spin_b": 2.0}
    return (*found, *(DrawnNumber(f"{name}_{c}", -size, size) for name, size in sizes.items() for c in "xyz"))


def _poses(case: Case, dt: float = 0.0) -> list[Pose]:
    """Return the poses of both bodies after a time [s]; the first one starts at the origin."""
    places = {"a": np.zeros(3), "b": three(case, "place")}
    return [
        (
            place + dt * three(case, f"velocity_{side}"),
            turned(turned(_UNIT, three(case, f"turn_{side}")), dt * three(case, f"spin_{side}")),
        )
        for side, place in places.items()
    ]


def _frame(pose: Pose) -> Array:
    block = np.zeros(blocks.FRAME)
    block[blocks.POSITION : blocks.ROTATION] = pose[0]
    block[blocks.ROTATION : blocks.VELOCITY] = rotation(pose[1]).ravel()
    return block


def _evaluator(contact: FeaturePair, reach: float) -> CheckedFunction:
    cases = draws([Drawn(_numbers(reach), dict)], 8)
    inputs = [("a, b", tuple(map(_frame, _poses(case)))) for case in cases]
    return CheckedFunction(
        contact, "evaluator", "pair", contact.values, inputs, blocks.PAIR, name_of(contact.evaluator)
    )


@final
@dataclass(frozen=True)
class _Placed:
    """Two bodies at drawn places, with drawn velocities.

    Attributes
    ----------
    case : Case
        The drawn numbers, by name.
    rig : ContactRig
        The two bodies and their contact; all inputs use the same rig.
    reach : float
        Largest distance of the bodies [m].
    smooth : set of int
        Set that all inputs share. It becomes non-empty, with the entry 1, when the contact is smooth at an input.
    """

    case: Case
    rig: ContactRig
    reach: float
    smooth: set[int]

    def put(self, dt: float = 0.0) -> ContactRig:
        """Move the bodies of the rig to where they are a time ``dt`` [s] after their drawn places; return the rig.

        The velocities are constant.
        """
        u = [three(self.case, f"{name}_{side}") for side in "ab" for name in ("velocity", "spin")]
        self.rig.put(_poses(self.case, dt), np.concatenate(u))
        return self.rig

    def shallow(self, is_bounded: bool) -> _Placed:
        """Return this input. Raise Inapplicable if bounded bodies overlap so much that the normal may be undefined."""
        if is_bounded and self.put().geometry[blocks.GAP] < -_DEEP * self.reach:
            raise Inapplicable
        return self

    def derivative(self, value: Callable[[ContactRig], Array]) -> Array | None:
        """Return the derivative in time of ``value(rig)`` while u' = 0.

        It is None if the contact changes its feature, or if the value is not smooth.
        """
        feature = self.put().geometry[blocks.FEATURE]
        if self.rig.geometry[blocks.PAST_END] > 0.0:
            return None

        def smooth_value(dt: float) -> Array:
            rig = self.put(dt)
            block, found = rig.geometry, np.array(value(rig))
            is_smooth = block[blocks.FEATURE] == feature and block[blocks.PAST_END] <= 0.0
            return found if is_smooth else np.full_like(found, math.nan)

        found, error = slope(smooth_value, _STEP)
        if not error <= 0.1 * _RATE * (1.0 + float(np.max(np.abs(found)))):
            return None
        self.smooth.add(1)
        return found

    def moved_together(self, turn: Array, part: slice, name: str) -> str:
        """Return a message if a vector of the contact does not turn with both bodies; "" if it does.

        The bodies are turned by the rotation vector ``turn`` [rad] and shifted. ``part`` is the slice of the vector in
        the geometry block, ``name`` its name. Afterwards the bodies of the rig are still in the moved poses.
        """
        self.rig.put(_poses(self.case), np.zeros(12))
        axes, before = rotation(turned(_UNIT, turn)), self.rig.geometry[part]
        # past the end of its features a contact need not have a normal
        if self.rig.geometry[blocks.PAST_END] > 0.0:
            return ""
        moved = [(axes @ place + SHIFT, turned(q, turn)) for place, q in _poses(self.case)]
        self.rig.put(moved, np.zeros(12))
        after, expected = self.rig.geometry[part], axes @ before
        if np.max(np.abs(after - expected)) > 1e-8:
            return f"the {name} becomes {after}, moved with the bodies it would be {expected}"
        return ""


@_AT_PLACES.claim(GIVEN, n_inputs=80)
def _writes_its_block(contact: FeaturePair, at: _Placed) -> str:
    """A call of the evaluator writes every number of its block that is not always zero, and nothing outside of it."""
    case, call = at.case, plain_caller(contact.evaluator, "pair", contact.values)
    turned_there = case | {"turn_a_x": case["turn_a_x"] + 1.0}
    here = tuple(map(_frame, _poses(case)))
    for other in (turned_there, turned_there | {"place_y": case["place_y"] - at.reach}):
        there = tuple(map(_frame, _poses(other)))
        if fault := left_over(lambda out: call(*here, out), lambda out, there=there: call(*there, out), blocks.PAIR):  # type: ignore[misc]
            return fault
    return ""


@_AT_PLACES.claim(GIVEN)
def _axes(contact: FeaturePair, at: _Placed) -> str:
    """The contact's normal and its first tangent are unit vectors at right angles."""
    block = at.put().geometry
    n, t = block[_NORMAL], block[_TANGENT]
    for words, value, wanted in (("|n|^2", n @ n, 1.0), ("|t1|^2", t @ t, 1.0), ("n . t1", n @ t, 0.0)):
        if abs(value - wanted) > 1e-9:
            return f"{words} is {value:.9g}"
    return ""


@_AT_PLACES.claim(GIVEN)
def _witness_points(contact: FeaturePair, at: _Placed) -> str:
    """The vector between the witness points is the gap times the normal, unless they are past the end of a feature."""
    block = at.put().geometry
    # past an end the gap may be a substitute, hypot(gap, distance past the end)
    if block[blocks.PAST_END] > 0.0:
        return ""
    gap, n = block[blocks.GAP], block[_NORMAL]
    apart = block[blocks.POINT_B : blocks.SIDE_A] - block[blocks.POINT_A : blocks.POINT_B]
    if np.max(np.abs(apart - gap * n)) > 1e-9 * (at.reach + abs(gap)):
        return f"they are {apart} apart, the gap is {gap:g} m along {n}"
    return ""


@_AT_PLACES.claim(GIVEN)
def _feature(contact: FeaturePair, at: _Placed) -> str:
    """The feature's number in the geometry block is an index of the names in `features`."""
    found, n = float(at.put().geometry[blocks.FEATURE]), len(contact.features)
    return "" if found in range(n) else f"it is {found:g}, of {n} features"


@claim(GIVEN)
def _gap_rate(contact: FeaturePair, at: _Placed) -> str:
    """The gap rate is the time derivative of the gap."""
    rate = float(at.put().rate[0])
    found = at.derivative(lambda rig: rig.geometry[:1])
    if found is None or abs(found[0] - rate) <= _RATE * (1.0 + at.reach):
        return ""
    return f"it is {rate:.9g} m/s, the differences give {found[0]:.9g}"


@claim(GIVEN, name="second-order terms")
def _second_order_terms(contact: FeaturePair, at: _Placed) -> str:
    """The second-order terms of gap and slip are the time derivatives of gap rate and slip velocity while u' = 0."""
    rig = at.put()
    axes, rate, bias = rig.axes, rig.rate, rig.bias
    found = at.derivative(lambda r: np.append(r.rate[0], r.rate[1:] @ r.axes[1:]))
    if found is None:
        return ""
    # differentiate the slip as a vector in space, then convert the derivative: the second-order terms are components
    # along tangents that turn with the first body
    spin = float(three(at.case, "spin_a") @ axes[0])
    expected = np.append(found[0], axes[1:] @ found[1:] + spin * np.array([rate[2], -rate[1]]))
    worst = int(np.argmax(np.abs(bias - expected)))
    if abs(bias[worst] - expected[worst]) <= _BIAS * (1.0 + float(np.max(np.abs(expected)))):
        return ""
    name = ("the gap", "the slip along t1", "the slip along t2")[worst]
    return f"that of {name} is {bias[worst]:.9g} m/s^2, the differences give {expected[worst]:.9g}"


@_MOVED.claim(GIVEN)
def _tangent_follows_the_first_body(contact: FeaturePair, at: _Placed) -> str:
    """If both bodies turn together, the first tangent of the contact turns with them."""
    # the bodies turn about the normal: in such a turn, a tangent that is wrongly fixed in space keeps its direction,
    # and so is found
    return at.moved_together(0.3 * at.put().geometry[_NORMAL], _TANGENT, "first tangent")


@_MOVED.claim(GIVEN)
def _frame_invariance(contact: FeaturePair, at: _Placed) -> str:
    """If both bodies are moved together, the gap is the same and the normal turns with the bodies."""
    before = float(at.put().geometry[blocks.GAP])
    wrong = at.moved_together(np.array([0.4, -0.3, 0.5]), _NORMAL, "normal")
    gap = float(at.rig.geometry[blocks.GAP])
    if not wrong and abs(gap - before) > 1e-9 * (at.reach + abs(gap)):
        return f"the gap is {before:.9g} m, and {gap:.9g} m where both bodies are moved"
    return wrong
