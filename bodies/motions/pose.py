"""A fixed pose as parameters of a compiled motion."""

from __future__ import annotations

from collections.abc import Sequence

from nonsmooth.rotations import rotation


def pose_parameters(position: Sequence[float], orientation: Sequence[float]) -> dict[str, float]:
    """Return x, y, z of the position [m] and xx, xy, ..., zz of the rotation matrix of a unit quaternion."""
    matrix = rotation(orientation).ravel().tolist()
    names = (row + column for row in "xyz" for column in "xyz")
    return dict(zip("xyz", map(float, position), strict=True)) | dict(zip(names, matrix, strict=True))
