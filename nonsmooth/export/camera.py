"""Camera of a picture: direction of a parallel projection, and the part of the scene that is shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.export.film import DrawnMesh, Film
from nonsmooth.histories.arrays import Floats

VIEWS = {
    "corner": (0.9, -1.3, 0.7),
    "front": (0.0, -1.0, 0.0),
    "side": (1.0, 0.0, 0.0),
    "top": (0.0, 0.0, 1.0),
}
"""Directions from the scene to the eye, by their names."""
_FAR = 6.0
"""If the extent of the moving bodies over all times exceeds this multiple of their largest extent at one time, the
camera follows the bodies.  Otherwise the camera is at rest and shows the whole motion."""
_ROOM = 0.06
"""Margin of the picture on each side of the scene, relative to the larger extent of the scene."""


@final
@dataclass(frozen=True, eq=False)
class Camera:
    """Parallel projection of a film to pictures: axes of the picture, and the visible rectangle at each time.

    Attributes
    ----------
    across, up, towards : array
        Unit vectors to the right, upwards and to the eye, shape [3] each.
    low, high : array
        Lower left and upper right corner of the visible rectangle at each time, along ``across`` and ``up`` [m],
        shape [n, 2] each.
    """

    across: Floats
    up: Floats
    towards: Floats
    low: Floats
    high: Floats

    @classmethod
    def of(cls, film: Film, view: str) -> Camera:
        """Camera of one of the :data:`VIEWS`.

        It shows the whole scene at all times.  If the bodies move far, it follows them.
        """
        towards = np.array(VIEWS[view]) / np.linalg.norm(VIEWS[view])
        up = np.array([0.0, 1.0, 0.0]) if view == "top" else np.array([0.0, 0.0, 1.0])
        up = up - (up @ towards) * towards
        up /= np.linalg.norm(up)
        across = np.cross(up, towards)
        flat = np.column_stack([across, up])
        lows, highs = _bounds(film, flat, [piece for piece in film.pieces if piece.track in film.moving])
        middle = film.origin[:, list(film.moving)].mean(axis=1) @ flat if film.moving else lows
        near = np.max(np.maximum(highs - middle, middle - lows), axis=0)
        if film.moving and float(np.max(near)) * 2.0 * _FAR < float(np.max(highs.max(axis=0) - lows.min(axis=0))):
            return cls(across, up, towards, middle - (1.0 + _ROOM) * near, middle + (1.0 + _ROOM) * near)
        lows, highs = _bounds(film, flat, film.pieces)
        low, high = lows.min(axis=0), highs.max(axis=0)
        room = _ROOM * float(np.max(high - low))
        every = np.ones((len(film.times), 1))
        return cls(across, up, towards, every * (low - room), every * (high + room))


def _bounds(film: Film, flat: Floats, pieces: Sequence[DrawnMesh]) -> tuple[Floats, Floats]:
    """Lower and upper corners of the rectangle around pieces in the plane of the picture [m], shape [n, 2] each.

    There is a rectangle for each time.  ``flat`` has the two axes of that plane as columns, shape [3, 2].  A sheet,
    which shows an infinite plane, counts at the first time only: it need not stay in the picture.
    """
    low, high = np.full((len(film.times), 2), np.inf), np.full((len(film.times), 2), -np.inf)
    for i in range(len(film.times)):
        for piece in pieces:
            if not piece.sheet or i == 0:
                points = film.placed(piece, i) @ flat
                low[i], high[i] = np.minimum(low[i], points.min(axis=0)), np.maximum(high[i], points.max(axis=0))
    return low, high
