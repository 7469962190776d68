"""A fixed pose: as parameters of a compiled function, and written by one."""

from __future__ import annotations

from collections.abc import Sequence

from bodies.blocks import put
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION, ROTATION
from nonsmooth.rotations import rotation
from nonsmooth.types import Floats

Three = tuple[float, float, float]


def pose_parameters(position: Sequence[float], orientation: Sequence[float]) -> dict[str, float]:
    """Return x, y, z of the position [m] and xx, xy, ..., zz of the rotation matrix of a unit quaternion."""
    matrix = rotation(orientation).ravel().tolist()
    names = (row + column for row in "xyz" for column in "xyz")
    return dict(zip("xyz", map(float, position), strict=True)) | dict(zip(names, matrix, strict=True))


@compiled
def put_pose(out: Floats, start: int, place: Three, a: Three, b: Three, c: Three) -> None:
    """Write place [m] and axes of a frame whose numbers begin at ``start``."""
    put(out, start + POSITION, place[0], place[1], place[2])
    for i in range(3):
        put(out, start + ROTATION + 3 * i, a[i], b[i], c[i])
