"""Between a body's axes and the world's, for the evaluators of contact pairs."""

from __future__ import annotations

from bodies.shapes.placement import turned
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION, ROTATION
from nonsmooth.types import Floats


@compiled
def point_in_world(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return where a point of the body stands [m]."""
    return (
        frame[POSITION] + frame[ROTATION] * x + frame[ROTATION + 1] * y + frame[ROTATION + 2] * z,
        frame[POSITION + 1] + frame[ROTATION + 3] * x + frame[ROTATION + 4] * y + frame[ROTATION + 5] * z,
        frame[POSITION + 2] + frame[ROTATION + 6] * x + frame[ROTATION + 7] * y + frame[ROTATION + 8] * z,
    )


@compiled
def vector_in_world(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector of the body in world axes."""
    return (
        frame[ROTATION] * x + frame[ROTATION + 1] * y + frame[ROTATION + 2] * z,
        frame[ROTATION + 3] * x + frame[ROTATION + 4] * y + frame[ROTATION + 5] * z,
        frame[ROTATION + 6] * x + frame[ROTATION + 7] * y + frame[ROTATION + 8] * z,
    )


@compiled
def vector_in_body(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector of the world in body axes."""
    return (
        frame[ROTATION] * x + frame[ROTATION + 3] * y + frame[ROTATION + 6] * z,
        frame[ROTATION + 1] * x + frame[ROTATION + 4] * y + frame[ROTATION + 7] * z,
        frame[ROTATION + 2] * x + frame[ROTATION + 5] * y + frame[ROTATION + 8] * z,
    )


turned_by = compiled(turned)
"""``turned_by(w, x, y, z, a, b, c)``: the vector (a, b, c) turned by a unit quaternion."""
