"""Contacts of two cylinders, cones or discs: a rim, foot or apex over a cap, and the list of all contacts."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.cylinder import Cylinder
from ...shapes.frustum import FEET, HIGH_RADIUS, SIDE, SWEEP, Frustum, without_feet
from ...vectors import minus, opposite, plus_scaled, scaled, vector_at
from ..features.ends import CLOSED, REACH
from ..features.frames import across, point_in_world
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
from .frustum_writing import past_depth, past_disc, write_rounded_part, write_two
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

    Feet and apices are rims of radius 0.  The contact ends at the border of the cap.

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
    axis, cap_axis, cap_center = axis_in_world(own, first), axis_in_world(other, second), center_in_world(other, second)
    cap_radius, height, up = cap_of(second, cap)
    n, middle = scaled(-up, cap_axis), point_in_world(own, vector_at(center, 0))
    _, sine, outward = across(n, axis)
    # sharp rims that are almost aligned do not open each other's contacts; rounded ones roll over the border
    margin = CLOSED if first[SWEEP] + second[SWEEP] == 0.0 else REACH
    if radius > 0.0 and sine < FLATTEST:
        # a rim parallel to the cap has no lowest point: take the one towards the cap's centre, which moves no faster
        # than the bodies. Feet touch first, if they are over the cap
        _, _, outward = across(minus(cap_center, middle), axis)
        margin, sine = -4.0 * CLOSED, 1.0
    p = plus_scaled(middle, radius, outward)
    along, away, from_axis = across(minus(p, cap_center), cap_axis)
    gap = up * (along - height)
    past = away - cap_radius - margin * size
    if gap > first[SWEEP] + second[SWEEP]:
        past = past_of_rim(past, radius, sine)
    if second[SIDE] == 0.0:
        past = max(past, past_disc(own, first, other, second, up, gap, p, radius == 0.0, size))
    else:
        # the feet of a disc protrude from its core
        foot = first[FEET] if first[SIDE] == 0.0 and radius == 0.0 else 0.0
        past = max(past, past_depth(own, first, other, second, gap + foot, size))
        if gap < 0.0:
            # another part of the body with the cap may separate the bodies by a shorter translation
            best = separation_by_second(own, first, other, second)
            past = max(past, best - separation_along(own, first, other, second, n) - REACH * size)
    write_two(a, out, swap, first, second, gap, past, n, p)
    write_rounded_part(out, swap, first, LOW_RIM, axis, outward, n, radius)
    write_rounded_part(out, 1.0 - swap, second, int(cap), cap_axis, from_axis, opposite(n), away)


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


def _over_caps(first: Frustum, second: Frustum) -> Iterator[FeaturePair]:
    """Yield the contacts of rims, apices and feet of either body with the caps of the other."""
    size, is_sharp = 2.0 * max(first.extent, second.extent), first.rounding + second.rounding == 0.0
    for swap, own, other in ((0.0, first, second), (1.0, second, first)):
        inner = set_back(other)
        for radius, center, name in rims_and_tips(own, is_sharp):
            # a foot touches the cap itself. The cap for a rim is set back, so that feet of either body touch first
            numbers = other.frustum if name.startswith("foot") else inner
            values: dict[str, Value] = {"swap": swap, "first": own.frustum, "radius": radius, "center": center}
            for cap, sign in ((LOW_CAP, "-"), (HIGH_CAP, "+"))[: 2 if other.frustum[HIGH_RADIUS] > 0.0 else 1]:
                yield FeaturePair(
                    evaluate_rim_over_cap,
                    {**values, "second": numbers, "cap": float(cap), "size": size},
                    (_names(swap, name, f"cap {sign}"),),
                )


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
            yield FeaturePair(evaluate_rim_over_side, values, (_names(swap, RIM_NAMES[rim], "side"),))
    for i, j, half in itertools.product(rims_of(core_a), rims_of(core_b), (1.0, -1.0)):
        values = {"first": core_a, "rim_a": float(i), "second": core_b, "rim_b": float(j), "half": half, "size": size}
        yield FeaturePair(evaluate_rims, values, (f"{RIM_NAMES[i]} and {RIM_NAMES[j]}",))


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
