"""Decomposition: a mesh cut into convex pieces, which touch whatever convex shapes touch."""

from __future__ import annotations

import hashlib
import tempfile
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput, MissingPackagesError
from nonsmooth.interfaces.body import Vector
from nonsmooth.notices import warn
from nonsmooth.parameters import Component, UnusualValue, parameter
from nonsmooth.user_cache import user_cache

from .mesh import Mesh

_FAR_OFF = 0.1
"""Part of the volume by which the pieces may miss it before a warning says so."""
_SLIVER = 1e-6
"""Part of the volume below which a piece is left out."""


@final
@dataclass(frozen=True)
class Decomposition(Component):
    """How to cut a mesh into convex pieces by V-HACD (https://github.com/kmammou/v-hacd); needs nonsmooth[meshes].

    The pieces are an approximation: they follow the surface to about the size of a voxel, and may overlap.
    """

    pieces: float = parameter(32.0, doc="largest number of pieces", minimum=1.0, maximum=1024.0)
    voxels: float = parameter(1e5, doc="number of voxels that the body is cut into", minimum=1e3, maximum=1e8)
    error: float = parameter(
        1.0, doc="volume by which pieces may exceed the body, in percent", above=0.0, maximum=100.0
    )
    corners: float = parameter(32.0, doc="largest number of corners of a piece", minimum=4.0, maximum=1024.0)

    def _check(self) -> None:
        for name in ("pieces", "voxels", "corners"):
            value = getattr(self, name)
            if value != int(value):
                raise InvalidInput(f"Decomposition.{name}", "must be a whole number", value, "Leave out the fraction.")

    def of(self, mesh: Mesh) -> tuple[Vector, ...]:
        """Return the corners of each piece [m], shape [n, 3], out of the user's cache if it was cut before.

        Raises
        ------
        MissingPackagesError
            If it must be cut and vhacdx is not installed.
        InvalidInput
            If nothing came out.
        """
        key = hashlib.sha256(f"{mesh.digest} {self!r} 1".encode()).hexdigest()[:32]
        folder = _folder()
        pieces = _kept(folder, key)
        if pieces is None:
            pieces = self._cut(mesh)
            _keep(folder, key, pieces)
        return pieces

    def _cut(self, mesh: Mesh) -> tuple[Vector, ...]:
        try:
            import vhacdx  # noqa: F401
            from trimesh import Trimesh
            from trimesh.decomposition import convex_decomposition
        except ImportError:
            raise MissingPackagesError(
                f'The decomposition of the mesh {mesh.name} needs vhacdx: pip install "nonsmooth[meshes]"'
            ) from None
        middle, scale = mesh.vertices.mean(axis=0), mesh.extent
        found = convex_decomposition(
            Trimesh((mesh.vertices - middle) / scale, mesh.faces, process=False),
            maxConvexHulls=int(self.pieces),
            resolution=int(self.voxels),
            minimumVolumePercentErrorAllowed=self.error,
            maxNumVerticesPerCH=int(self.corners),
            asyncACD=False,  # pieces must not depend on how threads are scheduled
        )
        points = [np.asarray(piece["vertices"], dtype=float) for piece in found]
        volumes = np.array([_hull_volume(own) for own in points]) * scale**3
        pieces = tuple(
            own * scale + middle for own, volume in zip(points, volumes, strict=True) if volume > _SLIVER * mesh.volume
        )
        _check_volume(mesh, float(np.sum(volumes)), len(pieces))
        if not pieces:
            raise InvalidInput(
                f"mesh {mesh.name}", "must have convex pieces", 0, "Give Decomposition(voxels=...) more voxels."
            )
        return pieces


def _hull_volume(points: Vector) -> float:
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def _check_volume(mesh: Mesh, volume: float, count: int) -> None:
    """Warn if the pieces together have another volume than the body."""
    if abs(volume / mesh.volume - 1.0) > _FAR_OFF:
        warn(
            f"mesh {mesh.name}: its {count} convex pieces have {volume / mesh.volume:.3f} of its volume, so that it "
            "touches where there is nothing, or does not where there is something. Give more pieces, more voxels or a "
            "smaller error in Decomposition(...). Mass and inertia are those of the mesh in any case.",
            UnusualValue,
        )


def _folder() -> Path | None:
    home = user_cache()
    return None if home is None else home / "nonsmooth" / "decompositions"


def _kept(folder: Path | None, key: str) -> tuple[Vector, ...] | None:
    """Return the pieces of last time; a file that cannot be read, or is damaged, is none."""
    if folder is None:
        return None
    try:
        with np.load(folder / f"{key}.npz") as kept:
            return tuple(kept[name] for name in kept.files)
    # the file's own checksums are those of zip
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error):
        return None


def _keep(folder: Path | None, key: str, pieces: tuple[Vector, ...]) -> None:
    """Write the pieces for the next time; a cache that cannot be written to is none."""
    if folder is None:
        return
    named: dict[str, Any] = {f"piece_{i:04d}": piece for i, piece in enumerate(pieces)}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, suffix=".part", delete=False) as file:
            np.savez(file, **named)
        Path(file.name).replace(folder / f"{key}.npz")
    except OSError:
        return
