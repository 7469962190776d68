"""Vertices and triangles of a file, as they stand in it."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from bodies.meshes.counting import LARGEST, check_number, count_triangles
from bodies.meshes.topology import Integers, merge_equal
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector


def read_file(path: Path, largest: int = LARGEST) -> tuple[Vector, Integers]:
    """Return vertices in the unit of the file, shape [n, 3], and triangles, shape [m, 3]; equal vertices are one.

    Anything that trimesh loads: STL, OBJ, PLY, OFF, GLB and more.

    Raises
    ------
    InvalidInput
        If there is no such file, it has more than ``largest`` triangles or none, or trimesh cannot read it.
    """
    thing = f"mesh {path.name}"
    if not path.is_file():
        raise InvalidInput(thing, "must be a file", str(path), f"The working folder is {Path.cwd()}.")
    told = count_triangles(path)
    if told is not None:
        check_number(thing, told, largest)
    vertices, faces = _loaded(thing, path)
    if len(faces) == 0:
        raise InvalidInput(
            thing,
            "must have triangles",
            0,
            "Is the file whole? Is it a cloud of points or a curve? Export a surface of triangles.",
        )
    if told is None:
        check_number(thing, len(faces), largest)
    return merge_equal(vertices, faces)


def _loaded(thing: str, path: Path) -> tuple[Vector, Integers]:
    import trimesh

    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            # what is not finite is told with its number by the checks
            warnings.simplefilter("ignore")
            loaded = trimesh.load_mesh(str(path), process=False)
            return (
                np.array(loaded.vertices, dtype=float).reshape(-1, 3),
                np.array(loaded.faces, dtype=np.int64).reshape(-1, 3),
            )
    except ModuleNotFoundError as error:
        # asked for by formats that need more, and by readers that take a broken file for another format
        package = error.name or str(error).rpartition(" ")[2].strip("'")
        raise InvalidInput(
            thing,
            "must be a mesh that trimesh can read",
            f"broken, or of a format that needs the package {package!r}",
            "Is the file whole, and its ending right? STL, OBJ, PLY, OFF and GLB need no further package.",
        ) from error
    except Exception as error:
        # readers of a dozen formats raise whatever they like at broken files
        formats = ", ".join(sorted(trimesh.available_formats()))
        raise InvalidInput(
            thing,
            "must be a mesh that trimesh can read",
            f"{type(error).__name__}: {error}",
            f"Is the file whole, and its ending right? Formats: {formats}.",
        ) from error
