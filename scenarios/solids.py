"""Solids drawn as seen from a direction, without perspective."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bodies import Polyhedron
from bodies.values import rotation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

_FINENESS = 24
_LIGHT = np.array([0.3, -0.5, 0.81])


def draw_solids(
    axis: Axes, solids: Sequence[Polyhedron], poses: Floats, azimuth: float, elevation: float, shades: Sequence[str]
) -> None:
    """Draw polyhedra where they are; those behind first.

    Parameters
    ----------
    axis : matplotlib axes
        Where to, in millimetres.
    solids : sequence of Polyhedron
        Their shapes.
    poses : array
        Position [m] and unit quaternion of each, shape [n, 7].
    azimuth, elevation : float
        Where the eye is, from x towards y and over the ground [rad].
    shades : sequence of str
        Colours, one each.
    """
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Polygon

    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    across, up, towards = np.array([-sa, ca, 0.0]), np.array([-ca * se, -sa * se, ce]), np.array([ca * ce, sa * ce, se])
    order = np.argsort(poses[:, :3] @ towards)
    for i in order:
        axes = rotation(poses[i, 3:])
        for corners, outward, is_face in _parts(solids[i]):
            normal = axes @ outward
            if normal @ towards > 0.0:
                seen = 1e3 * (corners @ axes.T + poses[i, :3]) @ np.column_stack([across, up])
                light = 0.55 + 0.45 * max(float(normal @ _LIGHT), 0.0)
                colour = tuple(light * c for c in to_rgb(shades[i]))
                line = "black" if is_face and solids[i].rounding == 0.0 else colour
                axis.add_patch(Polygon(seen, facecolor=colour, edgecolor=line, linewidth=0.6))
    axis.set_aspect("equal")
    axis.autoscale_view()


def _parts(solid: Polyhedron) -> Iterator[tuple[Floats, Floats, bool]]:
    """Return corners, outward normal, and whether it is a face, of flat pieces; small ones stand for what is round."""
    core = solid.core
    for face, plane in zip(core.faces, core.planes, strict=True):
        normal = np.array(plane[:3])
        yield np.array(core.vertices)[list(face)] + solid.rounding * normal, normal, True
    if solid.rounding > 0.0:
        vertices, triangles = solid.drawing(_FINENESS)
        for corners in vertices[triangles[sum(len(face) - 2 for face in core.faces) :]]:
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            yield corners, normal / np.linalg.norm(normal), False
