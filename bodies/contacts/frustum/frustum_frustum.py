"""Contacts of two cylinders, cones or discs: a rim, foot or apex over a cap, and the list of all contacts."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.cylinder import Cylinder
from ...shapes.frustum import FEET, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SWEEP, Frustum, Point, without_feet
from ...vectors import Vector3, dot, minus, norm, plus_scaled, scaled, vector_at
from ..features.ends import CLOSED, END, NEAR, REACH
from ..features.frames import across, point_in_world
from .crossings import evaluate_rim_over_side, evaluate_rims, evaluate_sides
from .frustum import HIGH_CAP, HIGH_RIM, LOW_CAP, LOW_RIM, along_side, nearest_part, part_number, rim_of
from .frustum_features import part_names, rims_of, set_back
from .frustum_placed import Placed, from_axis, from_core, placed, separation_along, separation_by_second
from .frustum_writing import FLATTEST, Spot, past_apex, past_depth, past_of_rim, write_pair

_RIM_NAMES = {LOW_RIM: "rim 0", HIGH_RIM: "rim 1"}
"""Words for the rims in the names of features."""


@compiled
def _past_disc(first: Placed, second: Placed, up: float, gap: float, p: Vector3, is_tip: bool, size: float) -> float:
    """Return the distance of a contact of a disc's face past its boundary [m]; negative if it is valid.

    The face is the upper one of the disc ``second`` if ``up`` is 1, the lower one if it is -1.  ``p`` is the point of
    the frustum ``first`` that is lowest over the face, or the tip of a foot or cone (``is_tip``), in the world [m];
    ``gap`` is its height over the face [m].

    If p lies below the face, one of two conditions must hold:

    - the line from p to the middle of the frustum leads back through the disc, and the rim of the disc lies below it;
    - the point of the face above p is inside of the frustum, and no other direction separates the bodies better.

    The second one holds where p passes below the rim, so that the contact of both rims ends where this one begins.
    Discs in one plane touch with the faces of both sides; the engine takes the face on the side from which the other
    disc came.
    """
    numbers = first.numbers
    middle = plus_scaled(first.center, 0.5 * (numbers[LOW] + numbers[HIGH]), first.axis)
    height, to_middle = up * dot(second.axis, minus(middle, second.center)), minus(middle, p)
    # the end of a frustum with a tip must face the disc; a raised foot may be higher than the middle
    if is_tip and up * dot(to_middle, first.axis) * dot(first.axis, second.axis) < 0.0:
        return size
    if gap >= -REACH * size:
        return -size
    # a frustum with its middle below the face touches the other face, and so does a rounded one with its core below it
    if height <= REACH * size or numbers[SWEEP] + second.numbers[SWEEP] > 0.0:
        return size
    # first condition: distance from the disc's axis at which the line from p to the middle crosses the face, and
    # distance of the disc's rim from the line, negative if the line crosses the disc. The margin keeps a disc whose rim
    # only touches the frustum
    _, away, _ = from_axis(second, plus_scaled(p, gap / (gap - height), to_middle))
    past_rim = REACH * size - (second.numbers[LOW_RADIUS] - away) * (height - gap) / norm(to_middle)
    # second condition: distance of the point of the face above p from the frustum
    outside = from_core(first, plus_scaled(p, -up * gap, second.axis)) - REACH * size
    return float(min(past_rim, max(outside, past_depth(first, second, gap, size))))


def evaluate_rim_over_cap(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, rim: Floats, second: Floats, cap: float, size: float
) -> None:
    """Write the geometry block of a cap of one body and the point of a rim of the other that is lowest over the cap.

    Feet and apices are rims of radius 0.  The contact ends at the border of the cap.  ``first`` is the body with the
    rim, the second body if ``swap`` is 1; ``second`` is the body with the cap.  ``rim`` holds the radius of the rim [m]
    and its centre in its body frame [m].  ``cap`` is 0 for the lower cap, 4 for the upper one.  ``size`` is the size of
    the bodies [m].
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    one, two, radius = placed(own, first), placed(other, second), rim[0]
    cap_radius, height, up = rim_of(second, cap)
    n, middle = scaled(-up, two.axis), point_in_world(own, vector_at(rim, 1))
    _, sine, outward = across(n, one.axis)
    # sharp rims that are almost aligned do not open each other's contacts; rounded ones roll over the border
    margin = CLOSED if first[SWEEP] + second[SWEEP] == 0.0 else REACH
    if radius > 0.0 and sine < FLATTEST:
        # a rim parallel to the cap has no lowest point: take the one towards the cap's centre, which moves no faster
        # than the bodies. Feet touch first, if they are over the cap
        _, _, outward = across(minus(two.center, middle), one.axis)
        margin, sine = -4.0 * CLOSED, 1.0
    p = plus_scaled(middle, radius, outward)
    along, away, to_p = from_axis(two, p)
    gap = up * (along - height)
    past = away - cap_radius - margin * size
    if gap > first[SWEEP] + second[SWEEP]:
        past = past_of_rim(past, radius, sine)
    if second[SIDE] == 0.0:
        past = max(past, _past_disc(one, two, up, gap, p, radius == 0.0, size))
    else:
        # the feet of a disc protrude from its core
        foot = first[FEET] if first[SIDE] == 0.0 and radius == 0.0 else 0.0
        past = max(past, past_depth(one, two, gap + foot, size))
        if gap < 0.0:
            # another part of the body with the cap may separate the bodies by a shorter translation
            past = max(past, separation_by_second(one, two) - separation_along(one, two, n) - REACH * size)
    of_rim, of_cap = Spot(one, LOW_RIM, outward, radius), Spot(two, int(cap), to_p, away)
    write_pair(a, out, swap, gap, past, n, p, of_rim, of_cap)


def evaluate_apex_over_frustum(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, second: Floats, size: float
) -> None:
    """Write the geometry block of the apex of a body and the nearest part of the other, if one of the two is rounded.

    ``first`` is the frustum with the apex, that of the second body if ``swap`` is 1; ``second`` is the other frustum.
    ``size`` is the size of the bodies [m].  The contact ends if the side of the cone is nearer than the apex.
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    one, two = placed(own, first), placed(other, second)
    p = plus_scaled(one.center, first[HIGH], one.axis)
    along, away, outward = from_axis(two, p)
    distance, radial, axial, part = nearest_part(second, along, away)
    n = plus_scaled(scaled(-radial, outward), -axial, two.axis)
    past = past_apex(first, distance, dot(n, one.axis), size)
    if distance - first[SWEEP] - second[SWEEP] > NEAR * size:
        # the apex sphere is part of the body: its gap is an upper bound, so at a large gap the contact stays valid
        past = min(past, -END * size)
    if swap == 1.0 and second[HIGH_RADIUS] == 0.0:
        # two apices have one contact, that of the first body's apex: this contact ends before the other apex. ``up`` is
        # the coordinate of the point along the other side, from the lower rim
        _, up = along_side(second, along, away)
        past = max(past, END * size - (second[SIDE] - up))
    # distance of the other contact point from its axis: exact on a rim
    point_away = max(away - distance * radial, 0.0)
    if part == LOW_RIM or part == HIGH_RIM:
        point_away, _, _ = rim_of(second, float(part))
    apex, nearest = Spot(one, HIGH_RIM, outward, 0.0), Spot(two, part, outward, point_away)
    write_pair(a, out, swap, distance, past, n, p, apex, nearest)
    out[FEATURE] = part_number(second, part)


@final
class FrustumFrustum(ContactKinematics):
    """Contacts of two cylinders, cones or discs.

    They are contacts of rims, feet and apices with caps, of the sides, of rims and apices with sides, and of rims with
    rims.  The features of a contact never change; a contact whose features do not face each other is open.  If one of
    the bodies is rounded, an apex is a sphere, with one contact for all parts of the other body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return two cylinders."""
        return {"first": Cylinder(0.01, 0.02), "second": Cylinder(0.008, 0.02)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of rims and feet with caps, of the sides, of rims with sides, of rims, and of apices."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        return tuple(itertools.chain(_over_caps(first, second), _crossing(first, second), _of_apices(first, second)))


def _names(swap: float, own: str, other: str) -> str:
    """Return the name of a contact, of the first body's feature and the second's: ``own`` is first unless ``swap``."""
    return f"{other} and {own}" if swap else f"{own} and {other}"


def _rims_and_tips(first: Frustum, is_sharp: bool) -> Iterator[tuple[float, Point, str]]:
    """Yield radius [m], centre in the body frame [m] and name of each rim, of the apex and of each foot.

    Apex and feet have the radius 0.  The apex is left out unless ``is_sharp``: if a body of the pair is rounded, the
    apex is a sphere, which has contacts of its own.
    """
    for i, (radius, place) in enumerate(first.standing_rims):
        if radius > 0.0 or is_sharp:
            yield radius, place, f"rim {i}" if radius > 0.0 else "apex"
    for i, foot in enumerate(first.feet):
        yield 0.0, foot, f"foot {i}"


def _over_caps(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of rims, apices and feet of either body with the caps of the other."""
    size, is_sharp = 2.0 * max(first.extent, second.extent), first.rounding + second.rounding == 0.0
    for swap, own, other in ((0.0, first, second), (1.0, second, first)):
        inner = set_back(other)
        for radius, center, name in _rims_and_tips(own, is_sharp):
            # a foot touches the cap itself. The cap for a rim is set back, so that feet of either body touch first
            numbers = other.frustum if name.startswith("foot") else inner
            values: dict[str, Value] = {"swap": swap, "first": own.frustum, "rim": (radius, *center), "second": numbers}
            for cap, sign in ((LOW_CAP, "-"), (HIGH_CAP, "+"))[: 2 if other.frustum[HIGH_RADIUS] > 0.0 else 1]:
                names = (_names(swap, name, f"cap {sign}"),)
                yield FeaturePair(evaluate_rim_over_cap, {**values, "cap": float(cap), "size": size}, names)


def _crossing(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of the sides, of the rims and sharp apices of either body with the side, and of the rims."""
    size, core_a, core_b = 2.0 * max(first.extent, second.extent), set_back(first), set_back(second)
    if core_a[SIDE] > 0.0 and core_b[SIDE] > 0.0:
        yield FeaturePair(evaluate_sides, {"first": core_a, "second": core_b, "size": size}, ("side and side",))
    values: dict[str, Value]
    for swap, own, other in ((0.0, core_a, core_b), (1.0, core_b, core_a)):
        halves = [*itertools.product(rims_of(own), (1.0, -1.0))]
        # a sharp apex is a rim of radius 0, which has no halves
        if own[SIDE] > 0.0 and own[HIGH_RADIUS] == 0.0 and core_a[SWEEP] + core_b[SWEEP] == 0.0:
            halves.append((HIGH_RIM, 1.0))
        for rim, half in halves if other[SIDE] > 0.0 else ():
            values = {"swap": swap, "first": own, "rim": float(rim), "half": half, "second": other, "size": size}
            yield FeaturePair(evaluate_rim_over_side, values, (_names(swap, _RIM_NAMES[rim], "side"),))
    for i, j, half in itertools.product(rims_of(core_a), rims_of(core_b), (1.0, -1.0)):
        values = {"first": core_a, "rim_a": float(i), "second": core_b, "rim_b": float(j), "half": half, "size": size}
        yield FeaturePair(evaluate_rims, values, (f"{_RIM_NAMES[i]} and {_RIM_NAMES[j]}",))


def _of_apices(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of the apices, which are spheres or points, if a body is rounded."""
    core_a, core_b = without_feet(first.frustum), without_feet(second.frustum)
    is_rounded = core_a[SWEEP] + core_b[SWEEP] > 0.0
    for swap, own, other in ((0.0, core_a, core_b), (1.0, core_b, core_a)) if is_rounded else ():
        if own[HIGH_RADIUS] == 0.0:
            values: dict[str, Value] = {"swap": swap, "first": own, "second": other}
            values["size"] = 2.0 * max(first.extent, second.extent)
            names = tuple(_names(swap, "apex", part) for part in part_names(other))
            yield FeaturePair(evaluate_apex_over_frustum, values, names)
