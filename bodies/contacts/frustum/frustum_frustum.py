"""Contacts of two cylinders, cones or discs: a rim, foot or apex over a cap, and the list of all contacts."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.cylinder import Cylinder
from ...shapes.frustum import HIGH, LOW, SIDE, SWEEP, Frustum
from ..features.frames import across, point_in_world
from ..features.polytope_tables import Numbers
from ..features.vertex_face import REACH
from ..plane.plane_rim import FLATTEST
from .apex_frustum import ApexFrustum
from .flank_flank import FlankFlank
from .frustum import (
    HIGH_CAP,
    LOW_CAP,
    LOW_RIM,
    axis_in_world,
    center_in_world,
    least_height,
    nearest_part,
)
from .frustum_writing import overlap_of, past_border, write_side, write_two
from .rim_flank import RimFlank
from .rim_rim import RimRim

_OTHERS: tuple[type[ContactKinematics], ...] = (FlankFlank, RimFlank, RimRim, ApexFrustum)
_ON_SIDE = 0.01
"""Length, relative to the size of the bodies, by which a body on one side of a disc may extend beyond its plane."""


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
    cx, cy, cz = point_in_world(own, x, y, z)
    _, lean, ex, ey, ez = across(nx, ny, nz, ax, ay, az)
    px, py, pz = cx + radius * ex, cy + radius * ey, cz + radius * ez
    along, away, fx, fy, fz = across(px - kx, py - ky, pz - kz, bx, by, bz)
    gap = up * (along - height)
    overlap = 0.0
    if away <= wide:
        overlap = overlap_of(own, first, other, second, gap, size, (px, py, pz), (nx, ny, nz))
    past = past_border(gap, away - wide, 0.0, overlap, size)
    if gap < 0.0 and second[SIDE] == 0.0 and first[SWEEP] + second[SWEEP] > 0.0:
        # a rounded body behind the plane of a disc is apart from it, on its other side: open this contact
        past = max(past, size)
    elif gap < 0.0:
        if second[SIDE] > 0.0:
            # a rim's point below the plane of a cap overlaps the other body only if it is inside of this body
            inside, _, _, _ = nearest_part(second, along, away)
        else:
            # a disc: its point opposite the rim's point must be inside of the other body or at most ``-gap`` outside of
            # it, and this body must lie on the cap's side of the disc
            qx, qy, qz = center_in_world(own, first)
            high, far, _, _, _ = across(px + gap * nx - qx, py + gap * ny - qy, pz + gap * nz - qz, ax, ay, az)
            inside, _, _, _ = nearest_part(first, high, far)
            cosine = -nx * ax - ny * ay - nz * az
            base = up * (bx * (qx - kx) + by * (qy - ky) + bz * (qz - kz) - height)
            inside += gap
            if first[SIDE] == 0.0:
                # two discs overlap only if the first disc's radius through its rim's point crosses the second disc
                back = gap / max(lean, FLATTEST)
                _, far, _, _, _ = across(px + back * ex - kx, py + back * ey - ky, pz + back * ez - kz, bx, by, bz)
                inside = far - wide
            inside = max(inside, -least_height(first, base, cosine) - _ON_SIDE * size)
        past = max(past, inside - REACH * size)
    # at an overlap of more than half of the height, the other cap or the side is nearer: this contact is past its end
    past = max(past, -gap - 0.5 * max(second[HIGH] - second[LOW], 0.1 * size))
    write_two(a, out, swap, first, second, gap, past, (nx, ny, nz), (px, py, pz), overlap)
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
        numbers, size = other.frustum, 2.0 * max(own.extent, other.extent)
        named = [(*rim, f"rim {i}") for i, rim in enumerate(own.standing_rims) if rim[0] > 0.0]
        if own.rounding + other.rounding == 0.0:
            named += [(*rim, "apex") for rim in own.standing_rims if rim[0] == 0.0]
        named += [(0.0, foot, f"foot {i}") for i, foot in enumerate(own.feet)]
        caps = [LOW_CAP, HIGH_CAP] if numbers[1] > 0.0 else [LOW_CAP]
        return tuple(
            cls(swap, own.frustum, radius, center, numbers, cap, size, name)
            for radius, center, name in named
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
