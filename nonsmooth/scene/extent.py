"""Extent: the box of a run, and the part of each unbounded plane, a sheet, that is drawn."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.histories.arrays import Floats
from nonsmooth.scene.scene import FrameLook, Scene

_ROUND = 1.0
"""A sheet extends beyond the moving bodies by this margin, relative to their size, so that they visibly are on it.

A sheet is the drawn part of an unbounded plane.
"""
_STILL = 1e-9
"""Largest change of the relative pose of two sheets that are at rest relative to each other: round-off.

The change of a rotation is that of its matrix elements [1]. The change of a translation is relative to the diagonal of
the box of all visible parts.
"""


@final
@dataclass(frozen=True, eq=False)
class Extent:
    """Bounding box of all visible parts over a run.

    Of an unbounded plane the box contains only the point that is nearest to the middle of the other parts.

    Attributes
    ----------
    low, high : array
        Corners of the box [m], shape [3].
    reach : float
        Largest radius of a moving body about the origin of its frame; without one, 0.3 of the diagonal of the box [m].
    """

    low: Floats
    high: Floats
    reach: float

    @classmethod
    def of(cls, scene: Scene, origin: Floats, axes: Floats) -> Extent:
        """Extent of a scene, with origins and axes of its frames as :meth:`Scene.places` returns them."""
        bodies = scene.system.bodies
        sheets = [part for part in scene.parts if part.look.sheet]
        solids = [part for part in scene.parts if not part.look.sheet]
        # a sheet has no middle: the origin of its frame may lie anywhere
        bare = {part.frame for part in sheets} - {part.frame for part in solids}
        counted = [frame for frame in range(scene.n_frames) if frame not in bare] or [*bare]
        low, high = origin[:, counted].min(axis=(0, 1)), origin[:, counted].max(axis=(0, 1))
        reach = 0.0
        for part in solids:
            vertices, here = part.look.vertices, origin[:, part.frame]
            own = float(np.max(np.linalg.norm(vertices, axis=1), initial=0.0))
            # the vertices are in a sphere about the frame's origin, and in their own box, which turns with the frame
            edges = vertices.min(axis=0, initial=0.0), vertices.max(axis=0, initial=0.0)
            centre = here + axes[:, part.frame] @ (0.5 * (edges[0] + edges[1]))
            half = np.abs(axes[:, part.frame]) @ (0.5 * (edges[1] - edges[0]))
            low = np.minimum(low, np.maximum(here - own, centre - half).min(axis=0))
            high = np.maximum(high, np.minimum(here + own, centre + half).max(axis=0))
            reach = max(reach, own if bodies[part.body].n_u > 0 else 0.0)
        middle = 0.5 * (low + high)
        for part in sheets:
            near = nearest(part, origin, axes, middle)
            low, high = np.minimum(low, near.min(axis=0)), np.maximum(high, near.max(axis=0))
        span = max(float(np.linalg.norm(high - low)), 1e-9)
        return cls(low, high, reach if reach > 0.0 else 0.3 * span)

    @property
    def unit(self) -> float:
        """Length by which lines and arrows are scaled [m]."""
        return min(self.reach, 0.5 * float(np.linalg.norm(self.high - self.low)))


def nearest(part: FrameLook, origin: Floats, axes: Floats, place: Floats) -> Floats:
    """Point of the unbounded plane ``part`` that is nearest to the point ``place``, at each time [m], shape [n, 3]."""
    normal = axes[:, part.frame, :, 2]
    height = np.einsum("ij,ij->i", place - origin[:, part.frame], normal) - part.look.vertices[0, 2]
    return np.asarray(place - height[:, None] * normal)


def outlines(scene: Scene, origin: Floats, axes: Floats, extent: Extent) -> list[Floats]:
    """Corners of the drawn part of each unbounded plane (sheet), in order, in the axes of its frame [m], shape [n, 2].

    The drawn part contains the projections of all visible parts at all times, with a margin.  It is cut off at another
    sheet that is fixed relative to it and has all moving bodies in front of it, so that walls meet at their edges.

    Parameters
    ----------
    scene : Scene
        The scene.
    origin, axes : array
        Origins and axes of the frames, from :meth:`Scene.places`.
    extent : Extent
        Extent of the scene.
    """
    sheets = [part for part in scene.parts if part.look.sheet]
    moving = {part.frame for part in scene.parts if scene.system.bodies[part.body].n_u > 0 and not part.look.sheet}
    held = [_holds(part, origin, axes, sorted(moving)) for part in sheets]
    places, radii = _taken(scene, origin, axes, extent)
    found = [_rectangle(part, origin, axes, places, radii + _ROUND * extent.unit) for part in sheets]
    span = float(np.linalg.norm(extent.high - extent.low))
    for i, j in itertools.permutations(range(len(sheets)), 2):
        one, other = sheets[i].frame, sheets[j].frame
        apart = np.einsum("nij,ni->nj", axes[:, one], origin[:, other] - origin[:, one])
        turned = np.einsum("nij,nik->njk", axes[:, one], axes[:, other])
        if not held[j] or np.max(np.ptp(apart, axis=0)) > _STILL * span or np.max(np.ptp(turned, axis=0)) > _STILL:
            continue
        normal = turned[0, :, 2]
        through = apart[0] + sheets[j].look.vertices[0, 2] * normal
        level = normal[2] * sheets[i].look.vertices[0, 2] - through @ normal
        found[i] = _cut(found[i], normal[:2], float(level))
    return found


def _holds(part: FrameLook, origin: Floats, axes: Floats, moving: list[int]) -> bool:
    """True if the origins of the frames ``moving`` are in front of a sheet, the drawn part of a plane, at all times."""
    normal = axes[:, part.frame, :, 2]
    height = np.einsum("nfi,ni->nf", origin[:, moving] - origin[:, part.frame, None], normal)
    return bool(np.all(height >= part.look.vertices[0, 2]))


def _taken(scene: Scene, origin: Floats, axes: Floats, extent: Extent) -> tuple[Floats, Floats]:
    """Centres [m] and radii [m] of spheres that contain all visible parts, shapes [n, m, 3] and [m]."""
    middle = 0.5 * (extent.low + extent.high)
    places, radii = list[Floats](), list[float]()
    for part in scene.parts:
        sheet, vertices = part.look.sheet, part.look.vertices
        places.append(nearest(part, origin, axes, middle) if sheet else origin[:, part.frame])
        radii.append(0.0 if sheet else float(np.max(np.linalg.norm(vertices, axis=1), initial=0.0)))
    ends = sorted({frame for stroke in scene.strokes if stroke.kind == "link" for frame in stroke.frames})
    return np.stack([*places, *(origin[:, frame] for frame in ends)], axis=1), np.array(radii + [0.0] * len(ends))


def _rectangle(part: FrameLook, origin: Floats, axes: Floats, places: Floats, radii: Floats) -> Floats:
    """Corners of the smallest rectangle that contains the projections of spheres on a plane at all times [m].

    The result has shape [4, 2].  Rectangle and corners are in the first two axes of the plane's frame.  ``places`` and
    ``radii`` are the centres and radii of the spheres [m].
    """
    flat = (places - origin[:, part.frame, None]) @ axes[:, part.frame, :, :2]
    (a, b), (c, d) = (flat - radii[:, None]).min(axis=(0, 1)), (flat + radii[:, None]).max(axis=(0, 1))
    return np.array([(a, b), (c, b), (c, d), (a, d)])


def _cut(corners: Floats, normal: Floats, level: float) -> Floats:
    """Cut a convex polygon by a line: return the part whose points fulfil ``point @ normal + level >= 0``.

    If no such part exists, return the whole polygon.
    """
    heights = corners @ normal + level
    kept = list[Floats]()
    for a, b, p, q in zip(corners, np.roll(corners, -1, axis=0), heights, np.roll(heights, -1), strict=True):
        if p >= 0.0:
            kept.append(a)
        if p * q < 0.0:
            kept.append(a + p / (p - q) * (b - a))
    return np.array(kept) if len(kept) > 2 else corners
