"""Extent: how much room a run takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.histories.arrays import Floats
from nonsmooth.scene.scene import Part, Scene


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
