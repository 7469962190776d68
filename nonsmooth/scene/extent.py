"""Extent: the box of a run, and the part of each unbounded plane, a sheet, that is drawn."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.histories.arrays import Floats
from nonsmooth.scene.scene import Part, Scene

_ROUND = 1.0
"""How far a sheet goes beyond what moves, measured by the size of what moves: it is seen to stand on something."""
_STILL = 1e-9
"""Change of a pose, relative to the extent, that is round-off."""


@final
@dataclass(frozen=True, eq=False)
class Extent:
    """The box of all that is seen at any time, of sheets the point that is nearest to the rest.

    Attributes
    ----------
    low, high : array
        Its corners [m], shape [3].
    reach : float
        How far what moves goes from the origin of its frame [m].
    """

    low: Floats
    high: Floats
    reach: float

    @classmethod
    def of(cls, scene: Scene, origin: Floats, axes: Floats) -> Extent:
        """Return that of frames, whose origins and axes are those of :meth:`Scene.places`."""
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
            # it is within a ball about the origin and within its own box as that is turned
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
        """The length that lines and arrows are measured by [m]."""
        return min(self.reach, 0.5 * float(np.linalg.norm(self.high - self.low)))


def nearest(part: Part, origin: Floats, axes: Floats, place: Floats) -> Floats:
    """Return the point of a sheet at each time that is nearest to a place [m], shape [n, 3]."""
    normal = axes[:, part.frame, :, 2]
    height = np.einsum("ij,ij->i", place - origin[:, part.frame], normal) - part.look.vertices[0, 2]
    return np.asarray(place - height[:, None] * normal)


def outlines(scene: Scene, origin: Floats, axes: Floats, extent: Extent) -> list[Floats]:
    """Return for each sheet the corners of what is drawn of it, in order, in the axes of its frame [m], shape [n, 2].

    It goes as far as the run at any time, and some way on, but not behind another sheet that stays where it is beside
    it and holds all that moves: walls meet at their edges.

    Parameters
    ----------
    scene : Scene
        The scene.
    origin, axes : array
        Of its frames, from :meth:`Scene.places`.
    extent : Extent
        Of all of it.
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


def _holds(part: Part, origin: Floats, axes: Floats, moving: list[int]) -> bool:
    """Tell whether the origins of frames stay in front of a sheet."""
    normal = axes[:, part.frame, :, 2]
    height = np.einsum("nfi,ni->nf", origin[:, moving] - origin[:, part.frame, None], normal)
    return bool(np.all(height >= part.look.vertices[0, 2]))


def _taken(scene: Scene, origin: Floats, axes: Floats, extent: Extent) -> tuple[Floats, Floats]:
    """Return middles [m] and radii [m] of balls that hold all that is seen, shapes [n, m, 3] and [m]."""
    middle = 0.5 * (extent.low + extent.high)
    places, radii = list[Floats](), list[float]()
    for part in scene.parts:
        sheet, vertices = part.look.sheet, part.look.vertices
        places.append(nearest(part, origin, axes, middle) if sheet else origin[:, part.frame])
        radii.append(0.0 if sheet else float(np.max(np.linalg.norm(vertices, axis=1), initial=0.0)))
    ends = sorted({frame for stroke in scene.strokes if stroke.kind == "link" for frame in stroke.frames})
    return np.stack([*places, *(origin[:, frame] for frame in ends)], axis=1), np.array(radii + [0.0] * len(ends))


def _rectangle(part: Part, origin: Floats, axes: Floats, places: Floats, radii: Floats) -> Floats:
    """Return the corners of what balls take up at any time, seen along the normal of a sheet."""
    flat = (places - origin[:, part.frame, None]) @ axes[:, part.frame, :, :2]
    (a, b), (c, d) = (flat - radii[:, None]).min(axis=(0, 1)), (flat + radii[:, None]).max(axis=(0, 1))
    return np.array([(a, b), (c, b), (c, d), (a, d)])


def _cut(corners: Floats, normal: Floats, level: float) -> Floats:
    """Return the part of a convex polygon where ``corners @ normal + level`` is positive, or all of it if none is."""
    heights = corners @ normal + level
    kept = list[Floats]()
    for a, b, p, q in zip(corners, np.roll(corners, -1, axis=0), heights, np.roll(heights, -1), strict=True):
        if p >= 0.0:
            kept.append(a)
        if p * q < 0.0:
            kept.append(a + p / (p - q) * (b - a))
    return np.array(kept) if len(kept) > 2 else corners
