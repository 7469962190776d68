"""Triangles: a surface out of arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput

from .mesh import Mesh, Surface, checked


@final
@dataclass(frozen=True)
class Triangles(Surface):
    """A closed surface of triangles, given as numbers.

    Attributes
    ----------
    vertices : sequence
        Corners [m], shape [n, 3].
    faces : sequence
        Triangles as indices of corners, counter-clockwise seen from outside, shape [m, 3].
    name : str
        What it is called in messages.
    repair : tuple of str
        As for :class:`bodies.MeshFile`.

    Raises
    ------
    InvalidInput
        If a shape is wrong or a rule of a closed surface is broken.
    """

    vertices: Any
    faces: Any
    name: str = "of triangles"
    repair: tuple[str, ...] = ()
    _mesh: Mesh = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        thing = f"mesh {self.name}"
        try:
            points = np.array(self.vertices, dtype=float)
            numbers = np.array(self.faces, dtype=float)
        except (TypeError, ValueError) as error:
            raise InvalidInput(thing, "must be made of numbers", str(error), "Give arrays [n, 3] and [m, 3].") from None
        for what, array in (("vertices", points), ("faces", numbers)):
            if array.ndim != 2 or array.shape[1] != 3:
                raise InvalidInput(f"{thing}: {what}", "must have the shape [n, 3]", array.shape, "Three in every row.")
        if not np.all(numbers == np.round(numbers)):
            raise InvalidInput(f"{thing}: faces", "must be whole numbers", numbers.tolist()[:3], "Give indices.")
        mesh = checked(self.name, points, numbers.astype(np.int64), "m", self.repair)
        object.__setattr__(self, "vertices", tuple(tuple(row) for row in points.tolist()))
        object.__setattr__(self, "faces", tuple(tuple(row) for row in numbers.astype(np.int64).tolist()))
        object.__setattr__(self, "repair", tuple(self.repair))
        object.__setattr__(self, "_mesh", mesh)

    @property
    def mesh(self) -> Mesh:
        """The mesh, checked when the surface was made."""
        return self._mesh
