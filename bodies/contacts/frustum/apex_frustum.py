"""Contact of the apex of a cone with another frustum, if one of the two is rounded; a rounded apex is a sphere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP, Frustum, without_feet
from ..features.frames import across
from ..features.polytope_tables import Numbers
from ..features.swept_vertex import END, NEAR
from ..features.writing import write_round
from .apex_swept import past_apex
from .frustum import (
    HIGH_RIM,
    LOW_RIM,
    axis_in_world,
    center_in_world,
    nearest_part,
    part_names,
    part_number,
)
from .frustum_writing import write_side, write_two


def _evaluate(a: Floats, b: Floats, out: Floats, swap: float, first: Floats, second: Floats, size: float) -> None:
    own, other = (b, a) if swap == 1.0 else (a, b)
    ax, ay, az = axis_in_world(own, first)
    bx, by, bz = axis_in_world(other, second)
    px, py, pz = center_in_world(own, first)
    px, py, pz = px + first[HIGH] * ax, py + first[HIGH] * ay, pz + first[HIGH] * az
    kx, ky, kz = center_in_world(other, second)
    along, away, (ex, ey, ez) = across((px - kx, py - ky, pz - kz), (bx, by, bz))
    distance, radial, axial, part = nearest_part(second, along, away)
    nx, ny, nz = -radial * ex - axial * bx, -radial * ey - axial * by, -radial * ez - axial * bz
    past = past_apex(first, distance, nx * ax + ny * ay + nz * az, size)
    if distance - first[SWEEP] - second[SWEEP] > NEAR * size:
        # the apex sphere is part of the body: its gap is an upper bound, so at a wide gap the contact stays valid
        past = min(past, -END * size)
    if swap == 1.0 and second[1] == 0.0:
        # two apices have one contact, that of the first body's apex: this contact ends before the other apex
        up = second[COS] * (along - second[LOW]) - second[SIN] * (away - second[0])
        past = max(past, END * size - (second[SIDE] - up))
    write_two(a, out, swap, first, second, distance, past, (nx, ny, nz), (px, py, pz))
    out[FEATURE] = part_number(second, part)
    point = away - distance * radial
    if part == LOW_RIM or part == HIGH_RIM:
        point = second[0] if part == LOW_RIM else second[1]
    write_round(out, SIDE_B if swap == 1.0 else SIDE_A, first[SWEEP])
    write_side(out, 1.0 - swap, second, part, (bx, by, bz), (ex, ey, ez), (-nx, -ny, -nz), max(point, 0.0))


@final
@dataclass(frozen=True)
class ApexFrustum(ContactKinematics):
    """The apex of one body against the nearest part of the other.

    Attributes
    ----------
    swap : bool
        Whether the apex belongs to the second body.
    first : tuple of float
        The body with the apex (:func:`bodies.shapes.frustum.frustum_numbers`).
    second : tuple of float
        The other body.
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Frustum)

    swap: bool
    first: Numbers
    second: Numbers
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ApexFrustum, ...]:
        """Return the contacts of the apices if a body is rounded; two sharp bodies have contacts of other classes."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Frustum)
        one, two = without_feet(first.frustum), without_feet(second.frustum)
        if one[SWEEP] + two[SWEEP] == 0.0:
            return ()
        size = 2.0 * max(first.extent, second.extent)
        both = (False, one, two), (True, two, one)
        return tuple(cls(swap, own, other, size) for swap, own, other in both if own[1] == 0.0)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {"swap": float(self.swap), "first": self.first, "second": self.second, "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """From the cap of the other against its axis to the one along it."""
        names = part_names(self.second)
        return tuple(f"{name} and apex" if self.swap else f"apex and {name}" for name in names)
