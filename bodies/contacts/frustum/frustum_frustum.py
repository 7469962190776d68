"""Contacts of two cylinders, cones or discs: a rim, foot or apex over a cap, and the list of all contacts."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar, final

from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.cylinder import Cylinder
from ...shapes.frustum import HIGH, LOW, SIDE, SWEEP, Frustum
from ..features.flat_rim import FLATTEST, common_length, touching_point, write_rim
from ..features.frames import across, point_in_world
from ..features.polytope_tables import Numbers
from ..features.vertex_face import CLOSED, REACH
from .apex_frustum import ApexFrustum
from .flank_flank import FlankFlank
from .frustum import (
    HIGH_CAP,
    LOW_CAP,
    LOW_RIM,
    axis_in_world,
    center_in_world,
    separation_along,
    separation_by,
    set_back,
)
from .frustum_writing import past_depth, past_disc, write_side, write_two
from .rim_flank import RimFlank
from .rim_rim import RimRim

_OTHERS: tuple[type[ContactKinematics], ...] = (FlankFlank, RimFlank, RimRim, ApexFrustum)


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    first: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    second: Floats,
    cap: float,
    size: float,
) -> None:
    own, other = (b, a) if swap == 1.0 else (a, b)
    ax, ay, az = axis_in_world(own, first)
    bx, by, bz = axis_in_world(other, second)
    kx, ky, kz = center_in_world(other, second)
    part = int(cap)
    up, height, wide = -1.0, second[LOW], second[0]
    if part == HIGH_CAP:
        up, height, wide = 1.0, second[HIGH], second[1]
    nx, ny, nz = -up * bx, -up * by, -up * bz
    cx, cy, cz = point_in_world(own, (x, y, z))
    _, sine, _ = across((nx, ny, nz), (ax, ay, az))
    is_flat, is_tip, outside = radius > 0.0 and sine < FLATTEST, radius == 0.0, -size
    if is_flat:
        _, offset, (fx, fy, fz) = across((kx - cx, ky - cy, kz - cz), (bx, by, bz))
        middle, half = common_length(radius, wide, offset)
        # valid if a part of the rim is over the cap, and if the common area is more than a point
        outside = max(radius - offset - wide, 2.0 * CLOSED * size - half)
        if half > 0.0:
            radius = half
            cx, cy, cz = cx + middle * fx, cy + middle * fy, cz + middle * fz
    at = touching_point(own, other, (-nx, -ny, -nz), (ax, ay, az), radius)
    reach, (ex, ey, ez), lift, _, _, _ = at
    px, py, pz = cx + reach * ex + lift * nx, cy + reach * ey + lift * ny, cz + reach * ez + lift * nz
    along, away, (fx, fy, fz) = across((px - kx, py - ky, pz - kz), (bx, by, bz))
    gap = up * (along - height)
    # sharp rims that are almost aligned do not open each other's contacts; rounded ones roll over the border
    margin = CLOSED if first[SWEEP] + second[SWEEP] == 0.0 else REACH
    past = max(away - wide, outside) - margin * size
    if second[SIDE] == 0.0:
        past = max(past, past_disc(own, first, other, second, up, gap, (px, py, pz), is_tip, size))
    else:
        past = max(past, past_depth(own, first, other, second, gap, size))
        if gap < 0.0:
            # of the body with the cap another part may separate the bodies better
            best = separation_by(own, first, other, second)
            past = max(past, best - separation_along(own, first, other, second, (nx, ny, nz)) - REACH * size)
    write_two(a, out, swap, first, second, gap, past, (nx, ny, nz), (px, py, pz))
    if is_flat:
        write_rim(out, SIDE_B if swap == 1.0 else SIDE_A, (ax, ay, az), radius, at, first[SWEEP])
    else:
        write_side(out, swap, first, LOW_RIM, (ax, ay, az), (ex, ey, ez), (nx, ny, nz), radius)
    write_side(out, 1.0 - swap, second, part, (bx, by, bz), (fx, fy, fz), (-nx, -ny, -nz), away)


@final
@dataclass(frozen=True)
class FrustumFrustum(ContactKinematics):
    """Contact of a cap of one body with the point of a rim of the other body that is lowest over the cap's plane.

    Feet and apices are treated as rims of radius 0. :meth:`between` also returns the other contacts of the two bodies:
    a side with a side, a rim or an apex with a side, and a rim with a rim.  The features of a contact never change; a
    contact whose features do not face each other is open.  If one of the bodies is rounded, an apex is a sphere, with
    one contact for all parts of the other body.

    Attributes
    ----------
    swap : bool
        Whether the rim belongs to the second body.
    first : tuple of float
        The body with the rim (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius of the rim [m].
    center : tuple of float
        Centre of the rim in the body frame [m].
    second : tuple of float
        The body with the cap.
    cap : int
        0 for the lower cap, 4 for the upper one.
    size : float
        Size of the bodies [m].
    name : str
        Name of the rim, foot or apex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)
    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        dict.fromkeys(
            ("gap rate", "second-order terms"),
            "a given rim is over a given cap in hardly any random pose; the tests make poses from features that touch",
        )
        | {"frame invariance": "a rim that lies flat over a cap has no lowest point, and which one is taken may change"}
    )

    swap: bool
    first: Numbers
    radius: float
    center: tuple[float, float, float]
    second: Numbers
    cap: int
    size: float
    name: str

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return two cylinders."""
        return {"first": Cylinder(0.01, 0.02), "second": Cylinder(0.008, 0.02)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of rims and feet with caps, of the sides, of rims with sides, and of rims."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        own = *cls._of(first, second, False), *cls._of(second, first, True)
        return tuple(itertools.chain(own, *(kind.between(first, second) for kind in _OTHERS)))

    @classmethod
    def _of(cls, own: Frustum, other: Frustum, swap: bool) -> tuple[FrustumFrustum, ...]:
        size, inner, outer = 2.0 * max(own.extent, other.extent), set_back(other), other.frustum
        named = [(inner, *rim, f"rim {i}") for i, rim in enumerate(own.standing_rims) if rim[0] > 0.0]
        if own.rounding + other.rounding == 0.0:
            named += [(inner, *rim, "apex") for rim in own.standing_rims if rim[0] == 0.0]
        # feet of either body carry it on a cap of the other: between rims and caps is the height of both
        named += [(outer, 0.0, foot, f"foot {i}") for i, foot in enumerate(own.feet)]
        caps = [LOW_CAP, HIGH_CAP] if outer[1] > 0.0 else [LOW_CAP]
        return tuple(
            cls(swap, own.frustum, radius, center, numbers, cap, size, name)
            for numbers, radius, center, name in named
            for cap in caps
        )

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        x, y, z = self.center
        return {
            "swap": float(self.swap),
            "first": self.first,
            "radius": self.radius,
            "x": x,
            "y": y,
            "z": z,
            "second": self.second,
            "cap": float(self.cap),
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        cap = f"cap {'+' if self.cap == HIGH_CAP else '-'}"
        return (f"{cap} and {self.name}" if self.swap else f"{self.name} and {cap}",)
