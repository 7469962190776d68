"""Meshes of bodies: a checked closed surface (Mesh), the component that gives it (Surface), and units of length."""

from __future__ import annotations

import functools
import hashlib
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces.body import Vector
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue

from . import convexity
from .checks import check_finite, check_indices, check_surface
from .integrals import mass_properties
from .repair import repaired
from .topology import Integers, merge_equal


@final
@dataclass(frozen=True, eq=False)
class Mesh:
    """The surface of one body; make it by :func:`checked`.

    Attributes
    ----------
    name : str
        For messages.
    vertices : Vector
        Corners [m], shape [n, 3], each once.
    faces : Integers
        Triangles, counter-clockwise seen from outside, shape [m, 3].
    repairs : tuple of str
        What was changed, and by how much.
    """

    name: str
    vertices: Vector
    faces: Integers
    repairs: tuple[str, ...] = ()

    @functools.cached_property
    def _integrals(self) -> tuple[float, Vector, Vector]:
        return mass_properties(self.vertices, self.faces)

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return self._integrals[0]

    @property
    def centroid(self) -> Vector:
        """Centre of the volume [m], shape [3]."""
        return self._integrals[1]

    @property
    def inertia(self) -> Vector:
        """Inertia at density 1 about the centroid [m^5], shape [3, 3]; the element J_xy is -integral of x y dV."""
        return self._integrals[2]

    @property
    def extent(self) -> float:
        """Largest side of the box along the axes [m]."""
        return float(np.max(np.ptp(self.vertices, axis=0)))

    @functools.cached_property
    def hull(self) -> convexity.Hull:
        """The convex hull."""
        return convexity.hull_of(self.name, self.vertices)

    @property
    def volume_ratio(self) -> float:
        """Volume relative to the volume of the convex hull; 1 for a convex body."""
        return self.volume / self.hull.volume

    @functools.cached_property
    def is_convex(self) -> bool:
        """Whether it is convex, but for dents as shallow as files make them (1e-6 of its extent)."""
        return convexity.is_convex(self.vertices, self.faces)

    @property
    def digest(self) -> str:
        """Hash of vertices and triangles."""
        return hashlib.sha256(self.vertices.tobytes() + self.faces.tobytes()).hexdigest()

    def report(self) -> str:
        """Return what it is in a few lines: numbers, size, volume, whether it is convex, repairs."""
        sides = " x ".join(f"{side:.4g}" for side in np.ptp(self.vertices, axis=0))
        kind = "convex" if self.is_convex else f"not convex, {self.volume_ratio:.4f} of its hull's volume"
        lines = [
            f"{self.name}: {len(self.vertices)} vertices, {len(self.faces)} triangles",
            f"{sides} m, volume {self.volume:.6g} m^3, {kind}, {len(self.hull.corners)} corners of the hull",
        ]
        return "\n".join([*lines, *(f"repaired: {line}" for line in self.repairs)])


def checked(name: str, vertices: Vector, faces: Integers, unit: str = "m", repair: Iterable[str] = ()) -> Mesh:
    """Return the mesh of arrays in metres, repaired as far as asked for, checked, with a warning of unusual size.

    Parameters
    ----------
    name : str
        What it is called in messages.
    vertices : Vector
        Corners [m], shape [n, 3].
    faces : Integers
        Triangles, shape [m, 3].
    unit : str
        What was taken for the unit of the file, for the warning.
    repair : iterable of str
        Names out of :data:`bodies.meshes.repair.REPAIRS`.

    Raises
    ------
    InvalidInput
        If a rule of :func:`bodies.meshes.checks.check_surface` is broken after the repairs.
    """
    thing, lines = f"mesh {name}", list[str]()
    if isinstance(repair, str):
        raise InvalidInput(f"{thing}: repair", "must be a tuple of words", repair, f"Write ({repair!r},).")
    words = tuple(repair)
    check_indices(thing, vertices, faces)
    vertices, faces = merge_equal(vertices, faces)
    if "not_finite" not in words:
        check_finite(thing, vertices)
    if words:
        vertices, faces, lines = repaired(thing, vertices, faces, words)
    warn_of_size(thing, float(np.max(np.ptp(vertices, axis=0))), unit)
    check_surface(thing, vertices, faces)
    vertices.flags.writeable = faces.flags.writeable = False
    return Mesh(name, vertices, faces, tuple(lines))


METRES = {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "inch": 0.0254, "foot": 0.3048}
"""Units of length and their size [m]."""

SMALLEST, LARGEST = 1e-4, 5.0
"""Usual range of the largest extent of a body [m]; outside of it a warning asks whether the unit is right."""


def metres(thing: str, unit: str) -> float:
    """Return the length of a unit [m]; raise UnknownName if the unit is unknown."""
    if unit not in METRES:
        raise UnknownName(f"{thing}: unit", str(unit), METRES)
    return METRES[unit]


def warn_of_size(thing: str, extent: float, unit: str) -> None:
    """Warn if the largest extent [m] of a body is unusual, as if its numbers had been read in a wrong unit."""
    if SMALLEST <= extent <= LARGEST:
        return
    others = [name for name, length in METRES.items() if SMALLEST <= extent / METRES[unit] * length <= LARGEST]
    better = " or ".join(repr(name) for name in others if name in ("m", "mm", "inch")) or "another one"
    warn(
        f"{thing}: the largest extent is {extent:.4g} m, outside of the usual {SMALLEST:g} to {LARGEST:g} m, with its "
        f"numbers read as {unit!r}. Is the unit right? With {better} the body would be of usual size.",
        UnusualValue,
    )


@dataclass(frozen=True)
class Surface(ABC):
    """A component that gives a checked mesh; subclasses are final frozen dataclasses of numbers and strings.

    A body holds the surface instead of the mesh, so that it is saved, compared and copied by these parameters.
    """

    @property
    @abstractmethod
    def mesh(self) -> Mesh:
        """The mesh, loaded and checked when the surface was made."""


def check_surface_of(name: str, surface: Any) -> None:
    """Raise InvalidInput if the ``surface`` given to a component is not a Surface."""
    if not isinstance(surface, Surface):
        example = 'For example MeshFile("part.stl", unit="mm").'
        raise InvalidInput(f"{name}.surface", "must be a surface", type(surface).__name__, example)
