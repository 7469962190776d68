"""Pictures of a film, drawn by matplotlib from back to front."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import MissingPackagesError
from nonsmooth.export.camera import Camera
from nonsmooth.export.film import DrawnMesh, Film
from nonsmooth.export.marks import WORDS, Marks
from nonsmooth.export.meshes import face_normals
from nonsmooth.histories.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Pixels = NDArray[np.uint8]
_DPI = 100
_LIGHT = np.array([0.3, -0.5, 0.81])
_SHADOW, _EDGE_ON = "#bcc4ce", "#8a94a3"
LOOKS: dict[str, dict[str, Any]] = {
    "stick": {"marker": "s", "color": "#0072b2"},
    "slip": {"marker": "o", "color": "#e69f00"},
    "impact": {"marker": "*", "color": "#d55e00"},
}
"""Marker and colour of each kind of mark."""
_NARROWEST = 0.4
"""Least length of the shorter side of a picture, relative to its longer side."""
_HEAD, _LEAST = 26, 230
"""Height of the margins for text above and below, and least width of a picture for the text [pixels]."""


def require() -> None:
    """Raise MissingPackagesError unless matplotlib, and Pillow with it, is installed."""
    try:
        import matplotlib.figure  # noqa: F401
        import PIL.Image  # noqa: F401
    except ImportError as error:
        raise MissingPackagesError('Moving pictures need matplotlib: pip install "nonsmooth[full]"') from error


def drawn(film: Film, marks: Marks, camera: Camera, size: int) -> Iterator[Pixels]:
    """Pictures at the times of a film, shape [height, width, 3]; height and width are even.

    The longer side of the drawn scene has ``size`` pixels.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    extent = camera.high[0] - camera.low[0]
    shares = np.maximum(extent / np.max(extent), _NARROWEST)
    wide, high = (size * shares).tolist()
    width, height = 2 * round(0.5 * max(wide, _LEAST)), 2 * round(0.5 * high + _HEAD)
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, _HEAD / height, 1.0, 1.0 - 2 * _HEAD / height))
    axes.set_axis_off()
    axes.set_aspect("equal")
    faces = PolyCollection([], linewidths=0.35)
    axes.add_collection(faces, autolim=False)
    dots = _dots(figure, axes, marks)
    clock = figure.text(10 / width, 1.0 - 0.5 * _HEAD / height, "", va="center", fontsize=10, family="monospace")
    digits = int(np.clip(np.ceil(-np.log10(np.diff(film.times[:2]).max(initial=1e-9))), 0, 9))
    flat = np.column_stack([camera.across, camera.up])
    for i, t in enumerate(film.times.tolist()):
        corners, colours = _faces(film, camera, i)
        faces.set_verts(list(corners @ flat))
        faces.set(facecolor=colours, edgecolor=colours)
        for word, dot in dots.items():
            dot.set_offsets(marks.places[i][WORDS.index(word)] @ flat)
        axes.set_xlim(camera.low[i, 0], camera.high[i, 0])
        axes.set_ylim(camera.low[i, 1], camera.high[i, 1])
        clock.set_text(f"t = {t:.{digits}f} s")
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _dots(figure: Figure, axes: Axes, marks: Marks) -> dict[str, Any]:
    """Matplotlib scatter of each kind of mark that occurs in the run, by the name of the kind, such as "impact".

    The scatters are made without points; each picture sets the points.
    """
    seen = [word for k, word in enumerate(WORDS) if any(len(one[k]) for one in marks.places)]
    found = {
        word: axes.scatter([], [], s=90 if word == "impact" else 36, edgecolors="white", linewidths=0.8, zorder=3,
                           label=word, **LOOKS[word])
        for word in seen
    }  # fmt: skip
    if found:
        figure.legend(
            loc="lower left", ncols=len(found), frameon=False, borderaxespad=0.0, fontsize=9, handletextpad=0.2,
            columnspacing=1.2,
        )  # fmt: skip
    return found


def _faces(film: Film, camera: Camera, i: int) -> tuple[Floats, Floats]:
    """Triangles that face the eye, from back to front, and their colours, shapes [m, 3, 3] and [m, 3]."""
    sheets = [piece for piece in film.pieces if piece.sheet]
    solids = [piece for piece in film.pieces if not piece.sheet]
    placed = [film.placed(piece, i)[piece.mesh.triangles] for piece in solids]
    bodies = np.concatenate([np.zeros((0, 3, 3)), *placed])
    shade = np.concatenate([np.zeros((0, 3)), *(_shades(piece) for piece in solids)])
    normals = face_normals(bodies)
    corners, colours = list[Floats](), list[Floats]()
    for piece in sheets:
        normal, place = film.axes[i, piece.track, :, 2], film.origin[i, piece.track]
        facing = float(normal @ camera.towards)
        if facing < -1e-6:
            continue
        cells = film.placed(piece, i)[piece.mesh.triangles]
        corners.append(cells)
        colours.append(_shades(piece) if facing > 0.02 else np.tile(rgb(_EDGE_ON), (len(cells), 1)))
        if normal[2] > 0.5 and facing > 0.02:
            above = bodies[normals @ normal > 0.0]
            corners.append(above - ((above - place) @ normal)[:, :, None] * normal)
            colours.append(np.tile(rgb(_SHADOW), (len(above), 1)))
    front = np.flatnonzero(normals @ camera.towards > 0.0)
    front = front[np.argsort(bodies[front].mean(axis=1) @ camera.towards, kind="stable")]
    light = 0.6 + 0.4 * np.clip(normals[front] @ _LIGHT, 0.0, 1.0)
    return np.concatenate([*corners, bodies[front]]), np.concatenate([*colours, shade[front] * light[:, None]])


def _shades(piece: DrawnMesh) -> Floats:
    return rgb(piece.colour) * piece.mesh.shade[:, None]


def rgb(colour: str) -> Floats:
    """Red, green and blue of "#rrggbb", from 0 to 1, shape [3]."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
