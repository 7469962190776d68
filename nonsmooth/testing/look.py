"""Properties of what is seen of a component."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nonsmooth.interfaces import Body
from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.solid import Vector
from nonsmooth.testing.property import Broken


def check_look(name: str, look: Look) -> None:
    """Raise Broken if a look cannot be drawn."""
    if not isinstance(look, Look):
        raise Broken("it must be a nonsmooth.interfaces.look.Look", name, look)
    if np.ndim(look.vertices) != 2 or np.shape(look.vertices)[1] != 3 or not np.all(np.isfinite(look.vertices)):
        raise Broken("its vertices must be finite numbers, three in a row [m]", name, look.vertices)
    if look.sheet and len(look.vertices) != 1:
        raise Broken("a sheet must have one vertex", name, len(look.vertices))
    for part, rows, width in (("triangles", look.triangles, 3), ("lines", look.lines, 2)):
        if np.ndim(rows) != 2 or np.shape(rows)[1] != width or not np.issubdtype(np.asarray(rows).dtype, np.integer):
            raise Broken(f"its {part} must be integers, {width} in a row", name, rows)
        if np.any((rows < 0) | (rows >= len(look.vertices))):
            raise Broken(f"its {part} must be numbers of its {len(look.vertices)} vertices", name, rows)


def check_sketch(body: Body) -> None:
    """Raise Broken if what is seen of a body besides its shapes cannot be drawn."""
    sketch = body.sketch
    if not isinstance(sketch, Sequence) or len(sketch) > len(body.frames):
        raise Broken(f"it must be a look for each of {len(body.frames)} frames at most", "sketch", sketch)
    for look in sketch:
        check_look("sketch", look)
    q = body.state()[0]
    shape = np.shape(body.strokes(q))
    if len(shape) != 3 or shape[1:] != (2, 3) or np.shape(body.strokes(q + 0.01)) != shape:
        raise Broken("it must give the ends of the same number of lines at all q, shape [n, 2, 3]", "strokes", shape)
    if not np.all(np.isfinite(body.strokes(q))):
        raise Broken("ends of lines must be finite [m]", "strokes", body.strokes(q))


def check_ends(ends: Vector) -> None:
    """Raise Broken if it cannot be drawn where a load or a joint acts."""
    if np.shape(ends) != (2, 3) or not np.all(np.isfinite(ends)):
        raise Broken("it must be two points, shape [2, 3] [m]", "ends", ends)
