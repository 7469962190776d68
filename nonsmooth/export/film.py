"""Film of a run: meshes for drawing, and tracks, which give position, axes and stretch of each mesh over time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.export.meshes import ShadedMesh, along_axes, bar, board, dot
from nonsmooth.histories.arrays import Floats
from nonsmooth.interfaces.look import Look
from nonsmooth.scene.extent import Extent
from nonsmooth.scene.scene import FrameLook, Scene

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_BODIES = ("#6fa8dc", "#f2b36b", "#7cc08f", "#d98fb8", "#b9a3e3", "#9fb8ad", "#d8c66a", "#8fc7d4")
_HELD, _SHEET, _LINK, _JOINT = "#aab2bd", "#dfe4ea", "#5b6675", "#8c6d46"
_ROUND, _TURNED = 100, 0.72
"""Least number of triangles of a solid that gets a pattern to show its rotation, and brightness of the dark parts of
the pattern, where 1 is the colour itself."""
_CELLS, _MOST_CELLS = 10, 40
"""Least and largest number of chequered cells along the longer side of the rectangle that shows an infinite plane.  If
the number stays within these limits, a cell is two of the film's ``unit`` long [m]; otherwise its length is adapted."""


@final
@dataclass(frozen=True, eq=False)
class DrawnMesh:
    """A mesh in one colour, which moves with a track of the film.

    Attributes
    ----------
    name : str
        Name of the body, load or joint.
    body : int
        Number of the body, -1 for a load or a joint.
    track : int
        Number of the track.
    mesh : ShadedMesh
        Mesh in the axes of the track.
    colour : str
        Colour as "#rrggbb".
    sheet : bool
        True if the mesh shows an infinite plane; such a mesh is visible only from its upper side.
    """

    name: str
    body: int
    track: int
    mesh: ShadedMesh
    colour: str
    sheet: bool = False


@final
@dataclass(frozen=True, eq=False)
class Film:
    """Meshes of a run, and tracks: the motions with which the meshes move.

    Tracks of frames come first, then tracks of sheets, then tracks of strokes.

    A sheet shows an infinite plane.  A stroke is a load, a joint or a link between two points.  A point x of a track is
    at ``origin + axes @ (scale x)``; ``scale`` stretches only the first axis.

    Attributes
    ----------
    times : array
        Times [s], shape [n].
    origin, axes, scale : array
        Origin [m], axes as columns, and stretch of each track; shapes [n, n_tracks, 3], [n, n_tracks, 3, 3] and
        [n, n_tracks].
    pieces : tuple of DrawnMesh
        Meshes that are drawn.
    moving : tuple of int
        Tracks that carry meshes of moving bodies, and tracks of strokes.
    unit : float
        Length to which lines and arrows are proportional [m].
    """

    times: Floats
    origin: Floats
    axes: Floats
    scale: Floats
    pieces: tuple[DrawnMesh, ...]
    moving: tuple[int, ...]
    unit: float

    @classmethod
    def of(cls, solution: Solution, times: Floats) -> Film:
        """Film of a run at times [s], shape [n].

        Raises
        ------
        InvalidInput
            The system has nothing that can be drawn.
        """
        scene, states = Scene.of(solution.system), solution.at(times)
        origin, axes = scene.places(times, states["q"], states["u"])
        extent = Extent.of(scene, origin, axes)
        low, high, unit = extent.low, extent.high, extent.unit
        pieces, names = list[DrawnMesh](), solution.system.names.bodies
        origins, turns = [origin], [axes]
        track = scene.n_frames
        for part in scene.parts:
            colour = _colour(scene, part.body)
            if part.look.sheet:
                place, mesh = _sheet(part, origin[:, part.frame], axes[:, part.frame], low, high, unit)
                pieces.append(DrawnMesh(names[part.body], part.body, track, mesh, _SHEET, sheet=True))
                origins.append(place[:, None])
                turns.append(axes[:, part.frame, None])
                track += 1
            for lined, mesh in [] if part.look.sheet else _meshes(part.look, unit):
                pieces.append(DrawnMesh(names[part.body], part.body, part.frame, mesh, _LINK if lined else colour))
        scales, straight = [np.ones((len(times), track))], bar(np.zeros(3), np.array([1.0, 0.0, 0.0]), 0.035 * unit)
        for stroke in scene.strokes:
            if stroke.kind == "joint" and stroke.frames[0] != stroke.frames[1]:
                mark = dot(stroke.ends[1], 0.06 * unit)
                pieces.append(DrawnMesh(stroke.name, -1, stroke.frames[1], mark, _JOINT))
            first, last = (origin[:, f] + axes[:, f] @ end for f, end in zip(stroke.frames, stroke.ends, strict=True))
            length = np.linalg.norm(last - first, axis=1)
            if np.max(length) < 1e-6 * unit:
                continue
            pieces.append(DrawnMesh(stroke.name, -1, track, straight, _JOINT if stroke.kind == "joint" else _LINK))
            origins.append(first[:, None])
            turns.append(along_axes(last - first)[:, None])
            scales.append(length[:, None])
            track += 1
        if not pieces:
            remedy = "Give a body shapes or a sketch, or export a table."
            raise InvalidInput("export: solution.system", "must have something to be seen", solution.system, remedy)
        places, axes, scale = (np.concatenate(parts, axis=1) for parts in (origins, turns, scales))
        bodies = solution.system.bodies
        moving = {piece.track for piece in pieces if piece.body < 0 or bodies[piece.body].n_u > 0}
        return cls(times, places, axes, scale, tuple(pieces), tuple(sorted(moving)), unit)

    def placed(self, piece: DrawnMesh, i: int) -> Floats:
        """Vertices of a piece at the time ``times[i]`` [m], shape [n, 3]."""
        stretched = piece.mesh.vertices * [self.scale[i, piece.track], 1.0, 1.0]
        return np.asarray(self.origin[i, piece.track] + stretched @ self.axes[i, piece.track].T)


def _colour(scene: Scene, body: int) -> str:
    bodies = scene.system.bodies
    moving = sum(one.n_u > 0 for one in bodies[:body])
    return _BODIES[moving % len(_BODIES)] if bodies[body].n_u > 0 else _HELD


def _meshes(look: Look, unit: float) -> Iterator[tuple[bool, ShadedMesh]]:
    """Yield pairs (is_line, mesh) for the parts of a frame's look: its solid, its lines and its points.

    ``is_line`` is True if the mesh shows a line.  Lines and points are drawn as bars and dots, whose radii are
    proportional to ``unit`` [m].
    """
    if len(look.triangles):
        middle = 0.5 * (look.vertices.min(axis=0) + look.vertices.max(axis=0))
        centre = look.vertices[look.triangles].mean(axis=1) - middle
        turned = (len(look.triangles) >= _ROUND) & (np.prod(centre, axis=1) > 0.0)
        yield False, ShadedMesh(look.vertices, look.triangles, np.where(turned, _TURNED, 1.0))
    for first, last in look.vertices[look.lines]:
        if np.any(first != last):
            yield True, bar(first, last, 0.03 * unit)
    used = np.concatenate([look.triangles.ravel(), look.lines.ravel()])
    for place in np.delete(look.vertices, used, axis=0):
        yield False, dot(place, 0.06 * unit)


def _sheet(
    part: FrameLook, origin: Floats, axes: Floats, low: Floats, high: Floats, unit: float
) -> tuple[Floats, ShadedMesh]:
    """Rectangle that shows an infinite plane: its centre at each time [m], shape [n, 3], and its mesh.

    The rectangle stays under the bodies if the plane moves along its own surface.  It covers the box from ``low`` to
    ``high`` [m], projected along the normal at the first time, with a margin.
    """
    normal, middle = axes[:, :, 2], 0.5 * (low + high)
    through = origin + part.look.vertices[0, 2] * normal
    place = middle - np.einsum("ij,ij->i", middle - through, normal)[:, None] * normal
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
    flat = np.abs((corners - middle) @ axes[0, :, :2]).max(axis=0) + 0.6 * unit
    widest = 2.0 * float(flat.max())
    cell = max(widest / _MOST_CELLS, min(widest / _CELLS, 2.0 * unit))
    half = cell * np.ceil(flat / cell - 1e-9)
    return place, board(-half, half, cell)
