"""Contacts of two cylinders, cones or discs: a rim, foot or apex over a cap, and the list of all contacts."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.cylinder import Cylinder
from ...shapes.frustum import FEET, SIDE, SWEEP, Frustum, without_feet
from ...vectors import minus, opposite, plus_scaled, scaled, vector_at
from ..features.frames import across, point_in_world
from ..features.vertex_face import CLOSED, REACH
from .apex_frustum import evaluate_apex_over_frustum
from .flank_flank import evaluate_sides
from .frustum import (
    FLATTEST,
    HIGH_CAP,
    HIGH_RIM,
    LOW_CAP,
    LOW_RIM,
    RIM_NAMES,
    axis_in_world,
    cap_of,
    center_in_world,
    part_names,
    past_of_rim,
    rims_and_tips,
    rims_of,
    separation_along,
    separation_by_second,
    set_back,
)
from .frustum_writing import past_depth, past_disc, write_side, write_two
from .rim_flank import evaluate_rim_over_side
from .rim_rim import evaluate_rims


def evaluate_rim_over_cap(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    first: Floats,
    radius: float,
    center: Floats,
    second: Floats,
    cap: float,
    size: float,
) -> None:
    """Write the geometry block of a cap of one body and the point of a rim of the other that is lowest over the cap.

    Feet and apices are rims of radius 0.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    swap : float
        1 if the rim belongs to the second body, else 0.
    first, second : Floats
        The body with the rim, and the body with the cap.
    radius : float
        Radius of the rim [m].
    center : Floats
        Centre of the rim in the body frame [m].
    cap : float
        0 for the lower cap, 4 for the upper one.
    size : float
        Size of the bodies [m].
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    axis, cap_axis, place = axis_in_world(own, first), axis_in_world(other, second), center_in_world(other, second)
    wide, height, up = cap_of(second, cap)
    n, middle = scaled(-up, cap_axis), point_in_world(own, vector_at(center, 0))
    _, sine, outward = across(n, axis)
    # sharp rims that are almost aligned do not open each other's contacts; rounded ones roll over the border
    margin = CLOSED if first[SWEEP] + second[SWEEP] == 0.0 else REACH
    if radius > 0.0 and sine < FLATTEST:
        # if no foot is over the cap, a flat rim touches it on the line of centres, in an area that is more than a
        # point. This place moves no faster than the bodies
        _, _, outward = across(minus(place, middle), axis)
        margin, sine = -4.0 * CLOSED, 1.0
    p = plus_scaled(middle, radius, outward)
    along, away, from_axis = across(minus(p, place), cap_axis)
    gap = up * (along - height)
    past = away - wide - margin * size
    if gap > first[SWEEP] + second[SWEEP]:
        past = past_of_rim(past, radius, sine)
    if second[SIDE] == 0.0:
        past = max(past, past_disc(own, first, other, second, up, gap, p, radius == 0.0, size))
    else:
        # the feet of a disc stand out of its core
        foot = first[FEET] if first[SIDE] == 0.0 and radius == 0.0 else 0.0
        past = max(past, past_depth(own, first, other, second, gap + foot, size))
        if gap < 0.0:
            # of the body with the cap another part may separate the bodies better
            best = separation_by_second(own, first, other, second)
            past = max(past, best - separation_along(own, first, other, second, n) - REACH * size)
    write_two(a, out, swap, first, second, gap, past, n, p)
    write_side(out, swap, first, LOW_RIM, axis, outward, n, radius)
    write_side(out, 1.0 - swap, second, int(cap), cap_axis, from_axis, opposite(n), away)


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
    """Return the names of a feature of the body with the rim and of one of the other body, the first body first."""
    return f"{other} and {own}" if swap else f"{own} and {other}"


def _over_caps(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of rims, apices and feet of either body with the caps of the other."""
    size, is_sharp = 2.0 * max(first.extent, second.extent), first.rounding + second.rounding == 0.0
    for swap, own, other in ((0.0, first, second), (1.0, second, first)):
        inner = set_back(other)
        for radius, center, name in rims_and_tips(own, is_sharp):
            # feet of either body carry it on a cap of the other: between rims and caps is the height of both
            numbers = other.frustum if name.startswith("foot") else inner
            values: dict[str, Value] = {"swap": swap, "first": own.frustum, "radius": radius, "center": center}
            for cap, sign in ((LOW_CAP, "-"), (HIGH_CAP, "+"))[: 2 if other.frustum[1] > 0.0 else 1]:
                yield FeaturePair(
                    evaluate_rim_over_cap,
                    {**values, "second": numbers, "cap": float(cap), "size": size},
                    (_names(swap, name, f"cap {sign}"),),
                )


def _crossing(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of the sides, of the rims and sharp apices of either body with the side, and of the rims."""
    size, one, two = 2.0 * max(first.extent, second.extent), set_back(first), set_back(second)
    if one[SIDE] > 0.0 and two[SIDE] > 0.0:
        yield FeaturePair(evaluate_sides, {"first": one, "second": two, "size": size}, ("side and side",))
    values: dict[str, Value]
    for swap, own, other in ((0.0, one, two), (1.0, two, one)):
        halves = [*itertools.product(rims_of(own), (1.0, -1.0))]
        if own[SIDE] > 0.0 and own[1] == 0.0 and one[SWEEP] + two[SWEEP] == 0.0:
            halves.append((HIGH_RIM, 1.0))
        for rim, half in halves if other[SIDE] > 0.0 else ():
            values = {"swap": swap, "first": own, "rim": float(rim), "half": half, "second": other, "size": size}
            yield FeaturePair(evaluate_rim_over_side, values, (_names(swap, RIM_NAMES[rim], "side"),))
    for i, j, half in itertools.product(rims_of(one), rims_of(two), (1.0, -1.0)):
        values = {"first": one, "rim_a": float(i), "second": two, "rim_b": float(j), "half": half, "size": size}
        yield FeaturePair(evaluate_rims, values, (f"{RIM_NAMES[i]} and {RIM_NAMES[j]}",))


def _of_apices(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of the apices if a body is rounded."""
    one, two = without_feet(first.frustum), without_feet(second.frustum)
    for swap, own, other in ((0.0, one, two), (1.0, two, one)) if one[SWEEP] + two[SWEEP] > 0.0 else ():
        if own[1] == 0.0:
            values: dict[str, Value] = {"swap": swap, "first": own, "second": other}
            values["size"] = 2.0 * max(first.extent, second.extent)
            names = tuple(_names(swap, "apex", part) for part in part_names(other))
            yield FeaturePair(evaluate_apex_over_frustum, values, names)
