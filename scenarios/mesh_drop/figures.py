"""Figures of the falling part: its poses, and its heights and energy over time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.solution.solution import Solution

from ..solids import directions_of_view

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .scenario import MeshDrop

Floats = NDArray[np.float64]

_AZIMUTH, _ELEVATION = math.radians(30.0), math.radians(25.0)
"""Azimuth and elevation of the eye in the drawings [rad]."""
_LIGHT = np.array([-0.48, 0.6, 0.64])
"""Direction towards the light, a unit vector: right, up, towards the eye."""
_STILL = 1e-9
"""Kinetic energy, relative to the energy of the fall, below which the part lies still."""
_SHARP = math.radians(20.0)
"""Edges at which the surface turns by more are drawn [rad]."""


def poses(scenario: MeshDrop, solution: Solution) -> Figure:
    """Draw the part at the start, the first impact and four later instants, seen from the side and a little above."""
    figure, axes = charts.panels(2, 3, _title(scenario, solution), (7.6, 5.6), sharex=True, sharey=True)
    first = float(scenario.summarise(solution)["first_impact"] or 0.0)
    later = first + (solution.t[-1] - first) * np.array([0.08, 0.2, 0.45, 1.0])
    samples = [0, *(int(np.argmin(np.abs(solution.t - t))) for t in (first, *later))]
    view = np.column_stack(directions_of_view(_AZIMUTH, _ELEVATION))
    seen = 1e3 * np.array([scenario.corners(solution.q[i]) for i in samples]) @ view
    middle = 0.5 * float(np.min(seen[..., 0]) + np.max(seen[..., 0]))
    wide, top = float(np.max(np.abs(seen[..., 0] - middle))), float(np.max(np.abs(seen[..., 1])))
    half = max(1.1 * wide, 0.55 * top)
    edge = 0.9 * half * math.sin(_ELEVATION)
    for ax, i, points in zip(axes, samples, seen, strict=True):
        ax.axhspan(-edge, edge, facecolor="0.93", edgecolor="0.7", linewidth=0.8)
        _part(ax, scenario, points)
        ax.set_title("start" if i == 0 else f"t = {solution.t[i]:.3f} s", fontsize=10)
        ax.set(aspect="equal", xlim=(middle - half, middle + half), ylim=(-0.4 * half, top + 0.08 * half))
        ax.set(xlabel="across [mm]", ylabel="up [mm]")
        ax.label_outer()
    return figure


def _part(ax: Axes, scenario: MeshDrop, seen: Floats) -> None:
    """Draw the triangles that face the eye, the farthest first, with the sharp edges of each."""
    from matplotlib.collections import LineCollection, PolyCollection
    from trimesh import Trimesh

    faces = scenario.body.mesh.faces
    corners = seen[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    front = np.flatnonzero(normals[:, 2] > 0.0)
    order = front[np.argsort(np.mean(corners[front, :, 2], axis=1))]
    shade = 0.45 + 0.5 * np.maximum(normals @ _LIGHT, 0.0)
    surface = Trimesh(seen, faces, process=False)
    sharp = surface.face_adjacency_edges[surface.face_adjacency_angles > _SHARP]
    drawn = {frozenset(edge) for edge in sharp.tolist()}
    for layer, i in enumerate(order, 2):
        triangle, shown = corners[i, :, :2], str(float(shade[i]))
        ax.add_collection(PolyCollection([triangle], color=shown, linewidth=0.3, zorder=layer))
        edges = [
            triangle[[k, (k + 1) % 3]] for k in range(3) if frozenset(faces[i, [k, (k + 1) % 3]].tolist()) in drawn
        ]
        if edges:
            ax.add_collection(LineCollection(edges, color="black", linewidth=0.7, zorder=layer))


def history(scenario: MeshDrop, solution: Solution) -> Figure:
    """Draw heights of mass centre and lowest point, and kinetic energy / energy of the fall, over time."""
    t, weight = solution.t, scenario.body.total_mass * 9.81
    heights = {"mass centre": (t, 1e3 * solution.q[:, 2]), "lowest point": (t, 1e3 * scenario.lowest(solution))}
    share = scenario.kinetic_energy(solution.u) / (weight * scenario.height)
    energy = {"": (t, np.maximum(share, 1e-12))}
    panels = {"height [mm]": heights, "kinetic energy /\nenergy of the fall": energy}
    figure = charts.histories(panels, _title(scenario, solution))
    above, below = figure.axes
    above.set_ylim(bottom=0.0)
    below.set(yscale="log", ylim=(1e-9, 10.0))
    return figure


def _title(scenario: MeshDrop, solution: Solution) -> str:
    """Return a title: the part, the number of its impacts, and whether it lies still at the end."""
    summary, mesh = scenario.summarise(solution), scenario.body.mesh
    rests = "lies still" if summary["kinetic_share"] < _STILL else "still moves"
    return f"The {mesh.name} of {len(mesh.faces)} triangles strikes {summary['impacts']} times and {rests} at the end"
