"""BroadPhase: which bodies may touch within a look-ahead, by the dynamic tree of boxes of FCL."""

from __future__ import annotations

from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from bodies.meshes.topology import Integers
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector


@final
class BroadPhase:
    """The pairs of bodies whose boxes along the axes of the world overlap, the boxes enlarged by a margin.

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
        import fcl

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
        # geometries, objects and tree must live as long as each other
        self._boxes = [fcl.Box(*(2.0 * row)) for row in self._halves]
        self._objects = [fcl.CollisionObject(box, fcl.Transform()) for box in self._boxes]
        self._tree = fcl.DynamicAABBTreeCollisionManager()

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
        for one, place in zip(self._objects, places, strict=True):
            one.setTranslation(place)
        # a tree that is only refitted keeps the order in which bodies once were near each other
        self._tree.clear()
        self._tree.registerObjects(self._objects)
        self._tree.setup()
        found: list[tuple[Any, Any]] = []

        def collect(one: Any, two: Any, _: Any) -> bool:
            # an exception in here would be printed and forgotten: nothing in here may raise
            found.append((one, two))
            return False

        self._tree.collide(None, collect)
        return self._numbered(found, places)

    def _numbered(self, found: list[tuple[Any, Any]], places: Vector) -> Integers:
        """Return the numbers of the bodies that FCL names by new objects, which know nothing but where they are."""
        numbers: dict[bytes, list[int]] = {}
        for number, place in enumerate(places):
            numbers.setdefault(place.tobytes(), []).append(number)
        shared = len(numbers) < len(places)
        keys = [(one.getTranslation().tobytes(), two.getTranslation().tobytes()) for one, two in found]
        if shared:
            pairs = [(i, j) for one, two in keys for i in numbers[one] for j in numbers[two] if i != j]
        else:
            pairs = [(numbers[one][0], numbers[two][0]) for one, two in keys]
        array = np.sort(np.array(pairs, dtype=np.int64).reshape(-1, 2), axis=1)
        if shared:
            # bodies at one place are told apart by their boxes
            one, two = array.T
            reach = self._halves[one] + self._halves[two]
            array = np.unique(array[np.all(np.abs(places[one] - places[two]) <= reach, axis=1)], axis=0)
        return array[np.lexsort((array[:, 1], array[:, 0]))]

    def over_plane(self, positions: Any, point: Any, normal: Any) -> Integers:
        """Return the bodies whose boxes reach below a plane, in order, shape [m]."""
        places = self._read(positions)
        direction = np.array(normal, dtype=float)
        heights = (places - np.array(point, dtype=float)) @ direction
        return np.flatnonzero(heights <= self._halves @ np.abs(direction))

    def _read(self, positions: Any) -> NDArray[np.float64]:
        places = np.ascontiguousarray(positions, dtype=float)
        if places.shape != (len(self._objects), 3) or not np.all(np.isfinite(places)):
            raise InvalidInput(
                "BroadPhase: positions",
                f"must be finite, shape [{len(self._objects)}, 3]",
                places.shape if places.shape != (len(self._objects), 3) else "a number that is not finite",
                "Give one row per body.",
            )
        return places
