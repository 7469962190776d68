"""Solids drawn as seen from a direction, without perspective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bodies import Polyhedron
from bodies.values import rotation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

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
        polytope = solids[i].polytope
        corners = np.array(polytope.vertices) @ axes.T + poses[i, :3]
        for face, plane in zip(polytope.faces, polytope.planes, strict=True):
            normal = axes @ np.array(plane[:3])
            if normal @ towards > 0.0:
                seen = 1e3 * corners[list(face)] @ np.column_stack([across, up])
                light = 0.55 + 0.45 * max(float(normal @ _LIGHT), 0.0)
                colour = tuple(light * c for c in to_rgb(shades[i]))
                axis.add_patch(Polygon(seen, facecolor=colour, edgecolor="black", linewidth=0.6))
    axis.set_aspect("equal")
    axis.autoscale_view()
