"""Whether discs without thickness have passed through each other between two poses.

They are apart before and after, and parallel ones never have a depth.  So the centre of one must not go from one side
of the other to the other side where its chord in that plane meets the other disc.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.random_systems.gaps import Poses, placed
from tests.benchmarks.random_systems.pieces import Piece

_TURNED = 0.1
"""Largest turn [rad] between two poses for which a straight line between them is good enough."""
_RIM = 0.95
"""Part of a radius within which a disc counts as hit: next to its rim a straight line may be wrong."""
_APART = 1e-6
"""Distance from the plane [m] from which a centre counts as on one side of it."""


def passed(one: Piece, two: Piece, poses: tuple[Poses, Poses]) -> NDArray[np.intp]:
    """Return the numbers of the poses before which two pieces passed through each other; none unless both are discs."""
    if not (one.flat and two.flat) or one.sweep + two.sweep > 0.0:
        return np.zeros(0, dtype=np.intp)
    (first, axes), (second, others) = placed(one, poses[0]), placed(two, poses[1])
    centre = np.einsum("nji,nj->ni", axes, second - first)
    normal = np.einsum("nji,nj->ni", axes, others[:, :, 2])
    z, after = centre[:-1, 2], centre[1:, 2]
    crosses = (z * after < 0.0) & (np.minimum(np.abs(z), np.abs(after)) > _APART)
    for turned in (axes[:, :, 2], others[:, :, 2]):
        crosses &= np.linalg.norm(np.diff(turned, axis=0), axis=1) < _TURNED
    part = np.where(crosses, z / np.where(crosses, z - after, 1.0), 0.0)[:, None]
    middle = (1.0 - part) * centre[:-1, :2] + part * centre[1:, :2]
    # along the line in which the planes cut each other; of parallel ones towards the centre
    lean = (1.0 - part) * normal[:-1, :2] + part * normal[1:, :2]
    chord = np.where(np.linalg.norm(lean, axis=1)[:, None] > 1e-9, lean[:, ::-1] * [-1.0, 1.0], middle)
    chord = chord / np.maximum(np.linalg.norm(chord, axis=1), 1e-300)[:, None]
    radius = float(two.numbers[0])
    along = np.clip(-np.einsum("ni,ni->n", middle, chord), -radius, radius)
    least = np.linalg.norm(middle + along[:, None] * chord, axis=1)
    return np.flatnonzero(crosses & (least < _RIM * one.numbers[0])) + 1
