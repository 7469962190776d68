"""The part in its fall, and what it does over time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bodies.meshes.topology import neighbours
from nonsmooth.solution.solution import Solution
from scenarios.mesh_drop.scenario import MeshDrop

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_AZIMUTH, _ELEVATION = math.radians(30.0), math.radians(25.0)
"""Where the eye is."""
_LIGHT = np.array([-0.48, 0.6, 0.64])
"""Where the light is, as seen: right, up, towards the eye."""
_STILL = 1e-9
"""Share of the energy of the fall that counts as no motion."""
_SHARP = math.cos(math.radians(20.0))
"""Edges at which the surface turns by more are drawn."""


def poses(scenario: MeshDrop, solution: Solution) -> Figure:
    """Draw the part at the start, the first impact and four later instants, seen from the side and a little above."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.6, 5.6), layout="constrained")
    axes = figure.subplots(2, 3, sharex=True, sharey=True).ravel()
    first = float(scenario.summarise(solution)["first_impact"] or 0.0)
    later = first + (solution.t[-1] - first) * np.array([0.08, 0.2, 0.45, 1.0])
    numbers = [0, *(int(np.argmin(np.abs(solution.t - t))) for t in (first, *later))]
    views = [_seen(1e3 * scenario.corners(solution.q[i])) for i in numbers]
    middle = 0.5 * (
        np.min([np.min(v, axis=0) for v in views], axis=0) + np.max([np.max(v, axis=0) for v in views], axis=0)
    )
    wide, top = (
        float(np.max([np.max(np.abs(view - shift), axis=0)[i] for view in views]))
        for i, shift in enumerate((middle, 0.0))
    )
    half = max(1.1 * wide, 0.55 * top)
    for axis, i, view in zip(axes, numbers, views, strict=True):
        _ground(axis, middle[0], half)
        _part(axis, scenario, view)
        axis.set_title("start" if i == 0 else f"t = {solution.t[i]:.3f} s", fontsize=10)
        axis.set_aspect("equal")
        axis.set_xlim(middle[0] - half, middle[0] + half)
        axis.set_ylim(-0.4 * half, top + 0.08 * half)
    for axis in axes[3:]:
        axis.set_xlabel("across [mm]")
    for axis in axes[::3]:
        axis.set_ylabel("up [mm]")
    figure.suptitle(_said(scenario, solution), fontsize=11)
    return figure


def _said(scenario: MeshDrop, solution: Solution) -> str:
    """Return a title: what the part is, how often it struck, and whether it lies still."""
    summary, mesh = scenario.summarise(solution), scenario.body.mesh
    rests = "lies still" if summary["kinetic_share"] < _STILL else "still moves"
    return f"The {mesh.name} of {len(mesh.faces)} triangles strikes {summary['impacts']} times and {rests} at the end"


def history(scenario: MeshDrop, solution: Solution) -> Figure:
    """Draw heights of mass centre and lowest point, and kinetic energy over that of the fall."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 5.2), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    axes[0].plot(solution.t, 1e3 * solution.q[:, 2], color="black", linewidth=1.2, label="mass centre")
    axes[0].plot(
        solution.t,
        1e3 * scenario.lowest(solution),
        color="tab:red",
        linewidth=1.2,
        linestyle="--",
        label="lowest point",
    )
    axes[0].set_ylabel("height [mm]")
    axes[0].set_ylim(bottom=0.0)
    axes[0].legend(fontsize=9, frameon=False, loc="upper right")
    weight = scenario.body.total_mass * 9.81
    share = scenario.kinetic_energy(solution.u) / (weight * scenario.height)
    axes[1].semilogy(solution.t, np.maximum(share, 1e-12), color="black", linewidth=1.2)
    axes[1].set_ylabel("kinetic energy / energy of the fall")
    axes[1].set_ylim(1e-9, 10.0)
    axes[1].set_xlabel("time [s]")
    figure.suptitle(_said(scenario, solution), fontsize=11)
    for axis in axes:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    return figure


def _seen(points: Floats) -> Floats:
    """Return what is right, up and towards the eye of points, shape [n, 3]."""
    c, s = math.cos(_AZIMUTH), math.sin(_AZIMUTH)
    up, flat = math.sin(_ELEVATION), math.cos(_ELEVATION)
    right, towards = np.array([-s, c, 0.0]), np.array([flat * c, flat * s, up])
    return np.asarray(points @ np.stack([right, np.cross(towards, right), towards], axis=1))


def _ground(axis: Axes, middle: float, half: float) -> None:
    from matplotlib.patches import Polygon

    depth = 0.9 * half
    corners = np.array([(x, y, 0.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * [4.0 * half, depth, 0.0]
    seen = _seen(
        corners
        @ np.array(
            [[-math.sin(_AZIMUTH), math.cos(_AZIMUTH), 0], [math.cos(_AZIMUTH), math.sin(_AZIMUTH), 0], [0, 0, 1]]
        )
    )
    axis.add_patch(Polygon(seen[:, :2] + [middle, 0.0], facecolor="0.93", edgecolor="0.7", linewidth=0.8))


def _part(axis: Axes, scenario: MeshDrop, seen: Floats) -> None:
    """Draw the triangles that face the eye, the farthest first, with the sharp edges of each."""
    from matplotlib.collections import LineCollection, PolyCollection

    faces = scenario.body.mesh.faces
    corners = seen[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    front = np.flatnonzero(normals[:, 2] > 0.0)
    order = front[np.argsort(np.mean(corners[front, :, 2], axis=1))]
    shade = 0.45 + 0.5 * np.maximum(normals @ _LIGHT, 0.0)
    pairs = neighbours(faces)
    sharp = np.einsum("ni,ni->n", normals[pairs[:, 0] // 3], normals[pairs[:, 1] // 3]) < _SHARP
    drawn = {int(half) for half in pairs[sharp].ravel()}
    for layer, i in enumerate(order):
        colour = str(float(shade[i]))
        axis.add_collection(
            PolyCollection([corners[i, :, :2]], facecolor=colour, edgecolor=colour, linewidth=0.3, zorder=2 + layer)
        )
        lines = [corners[i, [k, (k + 1) % 3], :2] for k in range(3) if 3 * int(i) + k in drawn]
        if lines:
            axis.add_collection(LineCollection(lines, color="black", linewidth=0.7, zorder=2 + layer))
