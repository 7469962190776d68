"""Between a body's axes and the world's, for the evaluators of contact pairs."""

from __future__ import annotations

from bodies.shapes.placement import turned
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def point_in_world(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return where a point of the body stands [m]."""
    return (
        frame[0] + frame[3] * x + frame[4] * y + frame[5] * z,
        frame[1] + frame[6] * x + frame[7] * y + frame[8] * z,
        frame[2] + frame[9] * x + frame[10] * y + frame[11] * z,
    )


@compiled
def vector_in_world(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector of the body in world axes."""
    return (
        frame[3] * x + frame[4] * y + frame[5] * z,
        frame[6] * x + frame[7] * y + frame[8] * z,
        frame[9] * x + frame[10] * y + frame[11] * z,
    )


@compiled
def vector_in_body(frame: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector of the world in body axes."""
    return (
        frame[3] * x + frame[6] * y + frame[9] * z,
        frame[4] * x + frame[7] * y + frame[10] * z,
        frame[5] * x + frame[8] * y + frame[11] * z,
    )


turned_by = compiled(turned)
"""``turned_by(w, x, y, z, a, b, c)``: the vector (a, b, c) turned by a unit quaternion."""
