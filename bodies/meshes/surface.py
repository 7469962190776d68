"""Surface: where a mesh comes from."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from bodies.meshes.mesh import Mesh


@dataclass(frozen=True)
class Surface(ABC):
    """A component that gives a checked mesh; subclasses are final frozen dataclasses of numbers and words.

    What a body keeps is the surface, so that it is saved, compared and copied by what it was made of.
    """

    @property
    @abstractmethod
    def mesh(self) -> Mesh:
        """The mesh, loaded and checked when the surface was made."""
