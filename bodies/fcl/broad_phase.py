"""BroadPhase: which bodies may touch within a look-ahead, by the dynamic tree of boxes of FCL."""

from __future__ import annotations

from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from bodies.meshes.topology import Integers
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

_GROUP = 8
"""Bodies that share a box of the tree."""
_ROUND_OFF = 1e-9
"""By what part of its size a shared box is enlarged, as FCL has it by its middle and its sides."""


@final
class BroadPhase:
    """The pairs of bodies whose boxes along the axes of the world overlap, the boxes enlarged by a margin.

    In the tree stand boxes round groups of eight bodies near each other; of the groups that FCL names, the bodies' own
    boxes are compared.  A body each in the tree took three times as long, as every pair of it is a call of Python.

    A margin of twice the way that any body can make within a look-ahead makes the pairs complete for that time: as
    ``v h + a h^2 / 2`` for speeds up to v [m/s], accelerations up to a [m/s^2] and a look-ahead h [s].

    Planes and half-spaces are no business of the tree: FCL ends the process with one in it.  They are given to
    :meth:`over_plane`.

    Parameters
    ----------
    halves : array
        Half-lengths of a box round each body, whatever its orientation: for a shape, ``shape.extent`` three times
        [m], shape [n, 3] or [n].
    margin : float
        Way that any body can make until the pairs are asked for again [m].

    Raises
    ------
    InvalidInput
        If a half-length is not positive and finite, or the margin negative or not finite.
    """

    def __init__(self, halves: Any, margin: float = 0.0) -> None:
        sizes = np.array(halves, dtype=float)
        if sizes.ndim == 1:
            sizes = np.repeat(sizes[:, None], 3, axis=1)
        if sizes.ndim != 2 or sizes.shape[1] != 3 or not np.all(np.isfinite(sizes)) or np.any(sizes <= 0.0):
            raise InvalidInput(
                "BroadPhase.halves", "must be positive and finite [m], shape [n, 3] or [n]", halves, "One per body."
            )
        if not 0.0 <= margin < np.inf:
            raise InvalidInput("BroadPhase.margin", "must be finite and not negative [m]", margin, "See v h + a h^2/2.")
        self._halves = sizes + margin

    def __reduce__(self) -> tuple[type[BroadPhase], tuple[Vector]]:
        return BroadPhase, (self._halves,)

    def pairs(self, positions: Any) -> Integers:
        """Return the pairs of bodies with overlapping boxes, the lower number first, in order, shape [m, 2].

        Parameters
        ----------
        positions : array
            Origins of the bodies [m], shape [n, 3].

        Raises
        ------
        InvalidInput
            If there are not as many as bodies, or one is not finite.
        """
        places = self._read(positions)
        if len(places) == 0:
            return np.zeros((0, 2), dtype=np.int64)
        # the last group may be short: it ends with a body that is nowhere, near to none
        n_groups = -(-len(places) // _GROUP)
        missing = np.full(n_groups * _GROUP - len(places), len(places))
        members = np.concatenate([_neighbours(places, n_groups), missing]).reshape(n_groups, _GROUP)
        low, high = (
            np.concatenate([places + sign * self._halves, np.full((1, 3), np.nan)])[members] for sign in (-1.0, 1.0)
        )
        first, second = _near_groups(np.nanmin(low, axis=1), np.nanmax(high, axis=1))
        near = np.ones((len(first), _GROUP, _GROUP), dtype=bool)
        for axis in range(3):
            near &= low[first, :, None, axis] <= high[second, None, :, axis]
            near &= low[second, None, :, axis] <= high[first, :, None, axis]
        group, i, j = np.nonzero(near)
        array = np.column_stack([members[first[group], i], members[second[group], j]])
        # within a group every pair stands twice, and every body beside itself
        own = (first == second)[group]
        array = np.sort(array[~own | (array[:, 0] < array[:, 1])], axis=1)
        return array[np.lexsort((array[:, 1], array[:, 0]))]

    def over_plane(self, positions: Any, point: Any, normal: Any) -> Integers:
        """Return the bodies whose boxes reach below a plane, in order, shape [m]."""
        places = self._read(positions)
        direction = np.array(normal, dtype=float)
        heights = (places - np.array(point, dtype=float)) @ direction
        return np.flatnonzero(heights <= self._halves @ np.abs(direction))

    def _read(self, positions: Any) -> NDArray[np.float64]:
        places = np.ascontiguousarray(positions, dtype=float)
        if places.shape != self._halves.shape or not np.all(np.isfinite(places)):
            raise InvalidInput(
                "BroadPhase: positions",
                f"must be finite, shape [{len(self._halves)}, 3]",
                places.shape if places.shape != self._halves.shape else "a number that is not finite",
                "Give one row per body.",
            )
        return places


def _neighbours(places: Vector, n_groups: int) -> Integers:
    """Return the numbers of the bodies in such an order that those near each other follow one another.

    In slabs across x of as many bodies each, these in columns across y, these along z.
    """
    n, parts = len(places), max(1, round(n_groups ** (1.0 / 3.0)))
    order = np.argsort(places[:, 0], kind="stable")
    for axis, share in ((1, parts), (2, parts * parts)):
        part = np.arange(n) * share // n
        order = order[np.lexsort((places[order, axis], part))]
    return order


def _near_groups(low: Vector, high: Vector) -> tuple[Integers, Integers]:
    """Return the pairs of boxes that overlap, each with itself included, by FCL's tree."""
    import fcl

    middles, sides = 0.5 * (low + high), (1.0 + _ROUND_OFF) * (high - low) + _ROUND_OFF * np.abs(low + high)
    # geometries, objects and tree must live as long as each other
    boxes = [fcl.Box(*row) for row in sides.tolist()]
    objects = [fcl.CollisionObject(box, fcl.Transform(middle)) for box, middle in zip(boxes, middles, strict=True)]
    tree = fcl.DynamicAABBTreeCollisionManager()
    tree.registerObjects(objects)
    tree.setup()
    found: list[tuple[bytes, bytes]] = []

    def collect(one: Any, two: Any, _: Any) -> bool:
        # FCL names an object by a new one that knows nothing but where it is; an exception in here would be printed
        # and forgotten: nothing in here may raise
        found.append((one.getTranslation().tobytes(), two.getTranslation().tobytes()))
        return False

    tree.collide(None, collect)
    numbers: dict[bytes, list[int]] = {}
    for number, middle in enumerate(middles):
        numbers.setdefault(middle.tobytes(), []).append(number)
    # boxes with one middle stand for each other; they overlap, and so does whatever one of them overlaps, or may
    pairs = {(min(i, j), max(i, j)) for one, two in found for i in numbers[one] for j in numbers[two]}
    pairs |= {(i, i) for i in range(len(low))}
    first, second = np.array(sorted(pairs), dtype=np.int64).T
    return first, second
