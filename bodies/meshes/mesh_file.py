"""MeshFile: a surface out of a file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import final

from bodies.meshes.counting import LARGEST
from bodies.meshes.mesh import Mesh, checked
from bodies.meshes.reading import read_file
from bodies.meshes.surface import Surface
from bodies.meshes.units import metres
from nonsmooth.errors import InvalidInput
from nonsmooth.parameters import Rule, check_number


@final
@dataclass(frozen=True)
class MeshFile(Surface):
    """A closed surface of triangles in a file that trimesh loads: STL, OBJ, PLY, OFF, GLB and others.

    Attributes
    ----------
    path : str
        The file, from the working folder.
    unit : str
        Unit of its numbers: m, dm, cm, mm, um, inch or foot.  There is no default: hardly a format says it.
    scale : float
        Factor by which the body is enlarged.
    repair : tuple of str
        Repairs to make, out of not_finite, merge, duplicates, zero_area, winding, holes; each that changes something
        says so in a warning.
    largest : int
        Number of triangles above which the file is refused before it is loaded.

    Raises
    ------
    InvalidInput
        If the file cannot be read or a rule of a closed surface is broken.
    """

    path: str
    unit: str
    scale: float = 1.0
    repair: tuple[str, ...] = ()
    largest: int = LARGEST
    _mesh: Mesh = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        name = Path(self.path).name
        length = metres(f"mesh {name}", self.unit)
        check_number(f"mesh {name}: scale", self.scale, Rule("factor of enlargement", above=0.0))
        if isinstance(self.largest, bool) or self.largest != int(self.largest) or self.largest < 1:
            raise InvalidInput(
                f"mesh {name}: largest", "must be a whole number of triangles", self.largest, "Give 1e6."
            )
        vertices, faces = read_file(Path(self.path), int(self.largest))
        mesh = checked(name, vertices * (length * self.scale), faces, self.unit, self.repair)
        object.__setattr__(self, "repair", tuple(self.repair))
        object.__setattr__(self, "_mesh", mesh)

    @property
    def mesh(self) -> Mesh:
        """The mesh, loaded and checked when the surface was made."""
        return self._mesh
