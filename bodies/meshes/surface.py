"""Surface: where a mesh comes from."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from bodies.meshes.mesh import Mesh
from nonsmooth.errors import InvalidInput


@dataclass(frozen=True)
class Surface(ABC):
    """A component that gives a checked mesh; subclasses are final frozen dataclasses of numbers and words.

    What a body keeps is the surface, so that it is saved, compared and copied by what it was made of.
    """

    @property
    @abstractmethod
    def mesh(self) -> Mesh:
        """The mesh, loaded and checked when the surface was made."""


def check_surface_of(name: str, surface: Any) -> None:
    """Raise InvalidInput unless a component gets a surface."""
    if not isinstance(surface, Surface):
        example = 'For example MeshFile("part.stl", unit="mm").'
        raise InvalidInput(f"{name}.surface", "must be a surface", type(surface).__name__, example)
