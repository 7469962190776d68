"""MeshFile: a surface that is read from a file of any format that trimesh loads."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Rule, check_number

from .counting import LARGEST, check_count, count_triangles
from .mesh import Mesh, Surface, checked, metres
from .topology import Integers, merge_equal


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


def read_file(path: Path, largest: int = LARGEST) -> tuple[Vector, Integers]:
    """Return vertices in the unit of the file, shape [n, 3], and triangles, shape [m, 3]; equal vertices are merged.

    Formats are those that trimesh loads: STL, OBJ, PLY, OFF, GLB and more.

    Raises
    ------
    InvalidInput
        The file does not exist, trimesh cannot read it, or it has no triangles or more than ``largest``.
    """
    thing = f"mesh {path.name}"
    if not path.is_file():
        raise InvalidInput(thing, "must be a file", str(path), f"The working folder is {Path.cwd()}.")
    told = count_triangles(path)
    if told is not None:
        check_count(thing, told, largest)
    vertices, faces = _loaded(thing, path)
    if len(faces) == 0:
        raise InvalidInput(
            thing,
            "must have triangles",
            0,
            "Is the file whole? Is it a cloud of points or a curve? Export a surface of triangles.",
        )
    if told is None:
        check_count(thing, len(faces), largest)
    return merge_equal(vertices, faces)


def _loaded(thing: str, path: Path) -> tuple[Vector, Integers]:
    import trimesh

    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            # ignore warnings about nan and overflow: later checks report vertices that are not finite by an error
            warnings.simplefilter("ignore")
            loaded = trimesh.load_mesh(str(path), process=False)
            return (
                np.array(loaded.vertices, dtype=float).reshape(-1, 3),
                np.array(loaded.faces, dtype=np.int64).reshape(-1, 3),
            )
    except ModuleNotFoundError as error:
        # the import error has two causes: the format needs a package that trimesh does not install, or a reader
        # mistook a broken file for such a format
        package = error.name or str(error).rpartition(" ")[2].strip("'")
        raise InvalidInput(
            thing,
            "must be a mesh that trimesh can read",
            f"broken, or of a format that needs the package {package!r}",
            "Is the file whole, and its ending right? STL, OBJ, PLY, OFF and GLB need no further package.",
        ) from error
    except Exception as error:
        # trimesh has readers for a dozen formats, and each raises other types of errors for broken files
        formats = ", ".join(sorted(trimesh.available_formats()))
        raise InvalidInput(
            thing,
            "must be a mesh that trimesh can read",
            f"{type(error).__name__}: {error}",
            f"Is the file whole, and its ending right? Formats: {formats}.",
        ) from error
