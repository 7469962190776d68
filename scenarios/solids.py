"""Solids drawn as seen from a direction, without perspective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Polyhedron
from nonsmooth.rotations import rotation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

_FINENESS = 24
_LIGHT = np.array([0.3, -0.5, 0.81])


def draw_solids(
    axis: Axes,
    solids: Sequence[Polyhedron],
    poses: Floats,
    azimuth: float,
    elevation: float,
    shades: Sequence[str],
    marks: Sequence[tuple[Floats, Floats]] = (),
) -> None:
    """Draw polyhedra at their places, from the farthest to the nearest.

    Parameters
    ----------
    axis : matplotlib axes
        Axes on which the polyhedra are drawn, in millimetres.
    solids : sequence of Polyhedron
        Shapes of the polyhedra.
    poses : array
        Position [m] and unit quaternion of each, shape [n, 7].
    azimuth, elevation : float
        Angles of the direction to the eye: from x towards y, and above the ground [rad].
    shades : sequence of str
        Colour of each polyhedron.
    marks : sequence of tuple of array
        White flat pieces on the faces of every solid: outward normal, shape [3], and corners [m], shape [n, 3].
    """
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    across, up, towards = directions_of_view(azimuth, elevation)
    pieces, colours, lines = [], [], []
    for i in np.argsort(poses[:, :3] @ towards):
        axes = rotation(poses[i, 3:])
        corners, normals, n_faces = _parts(solids[i])
        normals = normals @ axes.T
        light = 0.55 + 0.45 * np.maximum(normals @ _LIGHT, 0.0)
        edged = n_faces if solids[i].rounding == 0.0 else 0
        for number in np.flatnonzero(normals @ towards > 0.0):
            colour = tuple(light[number] * c for c in to_rgb(shades[i]))
            pieces.append(1e3 * (corners[number] @ axes.T + poses[i, :3]) @ np.column_stack([across, up]))
            colours.append(colour)
            lines.append((0.0, 0.0, 0.0) if number < edged else colour)
        for normal, mark in marks:
            if axes @ normal @ towards > 0.0:
                pieces.append(1e3 * (mark @ axes.T + poses[i, :3]) @ np.column_stack([across, up]))
                colours.append((1.0, 1.0, 1.0))
                lines.append((1.0, 1.0, 1.0))
    axis.add_collection(PolyCollection(pieces, facecolors=colours, edgecolors=lines, linewidths=0.6))
    axis.set_aspect("equal")
    axis.autoscale_view()


def directions_of_view(azimuth: float, elevation: float) -> tuple[Floats, Floats, Floats]:
    """Return the unit vectors to the right, up, and towards the eye, for the eye's azimuth and elevation [rad]."""
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    return np.array([-sa, ca, 0.0]), np.array([-ca * se, -sa * se, ce]), np.array([ca * ce, sa * ce, se])


def _parts(solid: Polyhedron) -> tuple[list[Floats], Floats, int]:
    """Return corners and outward normals of flat pieces, the faces first, and how many these are.

    Small pieces stand for what is round.
    """
    core = solid.core
    normals = np.array(core.planes)[:, :3]
    places = np.array(core.vertices)
    corners = [places[list(face)] + solid.rounding * n for face, n in zip(core.faces, normals, strict=True)]
    if solid.rounding == 0.0:
        return corners, normals, len(corners)
    vertices, triangles = solid.drawing(_FINENESS)
    small = vertices[triangles[sum(len(face) - 2 for face in core.faces) :]]
    outward = np.cross(small[:, 1] - small[:, 0], small[:, 2] - small[:, 0])
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    return corners + list(small), np.concatenate([normals, outward]), len(corners)
