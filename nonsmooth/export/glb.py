"""GLB: a scene with animation, for browsers, Blender and game engines."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.export.film import Film, Piece
from nonsmooth.export.meshes import corner_normals
from nonsmooth.histories.arrays import Floats
from nonsmooth.parameters import Rule, check_number
from nonsmooth.scene.knots import knots

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_KNOTS = Rule("most times that are stored, besides the instants of events", "1", minimum=2.0, maximum=1e6)
_FLOAT, _BYTE, _VERTICES = 5126, 5121, 34962
_KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_GAMMA = 2.4
# glTF has y upwards
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]


@final
@dataclass(frozen=True)
class Glb:
    """A GLB file (glTF 2.0): a node for each frame, with tracks of translation and rotation, and meshes below it.

    Loads, joints and links of mechanisms have tracks of scale, too.  Times count from the beginning of the run and
    are 32-bit numbers that increase strictly: of instants that are nearer to each other, the last one is kept.

    Attributes
    ----------
    most_knots : int
        At how many times, besides the instants of events, tracks have a key.
    """

    most_knots: int = 4000

    def __post_init__(self) -> None:
        check_number("export: most_knots", self.most_knots, _KNOTS)

    def files(self, solution: Solution, path: Path) -> Iterator[tuple[Path, bytes]]:
        """Give the file of a run."""
        times = knots(solution, int(self.most_knots))
        keys = (times - times[0]).astype(np.float32)
        kept = np.append(np.diff(keys) > 0.0, True)
        yield path, _packed(Film.of(solution, times[kept]), keys[kept])


@final
@dataclass(frozen=True)
class _Buffer:
    """Arrays one after another, with what glTF tells of each."""

    blocks: list[bytes] = field(default_factory=list)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)

    def add(self, array: NDArray[Any], **more: Any) -> int:
        """Add an array of numbers of four bytes, or of rows of four bytes; return its number."""
        self.blocks.append(array.tobytes())
        at = sum(view["byteLength"] for view in self.views)
        self.views.append({"buffer": 0, "byteOffset": at, "byteLength": array.nbytes})
        width = array.shape[1] if array.ndim > 1 else 1
        kind = {"componentType": _FLOAT if array.dtype == np.float32 else _BYTE, "type": _KINDS[width]}
        self.accessors.append({"bufferView": len(self.views) - 1, "count": len(array), **kind, **more})
        return len(self.accessors) - 1


def _packed(film: Film, keys: NDArray[np.float32]) -> bytes:
    buffer, meshes, known = _Buffer(), list[dict[str, Any]](), dict[tuple[int, str], int]()
    number = {track: i for i, track in enumerate(dict.fromkeys(piece.track for piece in film.pieces))}
    nodes: list[dict[str, Any]] = [{} for _ in number]
    for piece in film.pieces:
        key = id(piece.mesh), piece.colour
        if key not in known:
            known[key] = len(meshes)
            meshes.append({"primitives": [{"attributes": _attributes(buffer, piece), "material": 0}]})
        node = nodes[number[piece.track]]
        node.setdefault("name", piece.name)
        node.setdefault("children", []).append(len(nodes))
        nodes.append({"name": piece.name, "mesh": known[key]})
    time = buffer.add(keys, min=[float(keys[0])], max=[float(keys[-1])])
    stretch = np.stack([film.scale, *2 * [np.ones_like(film.scale)]], axis=2)
    samplers, channels = list[dict[str, Any]](), list[dict[str, Any]]()
    for name, rows in (("translation", film.origin), ("rotation", quaternions(film.axes)), ("scale", stretch)):
        for track, at in number.items():
            values = rows[:, track].astype(np.float32)
            nodes[at][name] = values[0].tolist()
            if np.any(values != values[0]):
                channels.append({"sampler": len(samplers), "target": {"node": at, "path": name}})
                samplers.append({"input": time, "output": buffer.add(values), "interpolation": "LINEAR"})
    nodes.append({"name": "run", "rotation": _UPRIGHT, "children": list(range(len(number)))})
    told: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "nonsmooth"},
        "scene": 0,
        "scenes": [{"nodes": [len(nodes) - 1]}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.7}, "doubleSided": True}],
        "animations": [{"name": "run", "samplers": samplers, "channels": channels}],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": sum(map(len, buffer.blocks))}],
    }
    if not channels:
        del told["animations"]
    return _container(told, b"".join(buffer.blocks))


def _attributes(buffer: _Buffer, piece: Piece) -> dict[str, int]:
    """Add the corners of all triangles, each with its own normal and colour."""
    mesh = piece.mesh
    corners = mesh.vertices[mesh.triangles].reshape(-1, 3).astype(np.float32)
    normals = corner_normals(mesh).reshape(-1, 3).astype(np.float32)
    colour = linear(piece.colour) * mesh.shade[:, None] ** _GAMMA
    shades = np.column_stack([np.rint(255.0 * colour), np.full(len(colour), 255.0)]).astype(np.uint8)
    bounds = {"min": corners.min(axis=0).tolist(), "max": corners.max(axis=0).tolist()}
    found = {
        "POSITION": buffer.add(corners, **bounds),
        "NORMAL": buffer.add(normals),
        "COLOR_0": buffer.add(np.repeat(shades, 3, axis=0), normalized=True),
    }
    for accessor in found.values():
        buffer.views[accessor]["target"] = _VERTICES
    return found


def linear(colour: str) -> Floats:
    """Return how much light a colour "#rrggbb" has of red, green and blue, 1 the most, shape [3]."""
    shown = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** _GAMMA)


def quaternions(axes: Floats) -> Floats:
    """Return unit quaternions, scalar last, of axes of shape [n, m, 3, 3]; each is nearest to the one before it."""
    from scipy.spatial.transform import Rotation

    found = np.asarray(Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat()).reshape(*axes.shape[:2], 4)
    turned = np.einsum("ijk,ijk->ij", found[1:], found[:-1]) < 0.0
    found[1:] *= np.where(np.cumsum(turned, axis=0) % 2, -1.0, 1.0)[:, :, None]
    return found


def _container(told: dict[str, Any], blob: bytes) -> bytes:
    text = json.dumps(told, separators=(",", ":")).encode("utf-8")
    chunks = [(b"JSON", text + b" " * (-len(text) % 4)), (b"BIN\0", blob + b"\0" * (-len(blob) % 4))]
    body = b"".join(struct.pack("<I", len(chunk)) + kind + chunk for kind, chunk in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
