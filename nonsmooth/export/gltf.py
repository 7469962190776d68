"""Parts of a glTF file: a buffer of arrays, and the nodes, meshes and tracks that refer to them."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.export.meshes import ShadedMesh, corner_normals
from nonsmooth.histories.arrays import Floats

_FLOAT, _BYTE, _VERTICES = 5126, 5121, 34962
_KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_GAMMA = 2.4
# quaternion, scalar last, that turns z to y, because y is upwards in glTF
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]


@final
@dataclass(frozen=True)
class _Buffer:
    """Arrays one after another, with the view and the accessor of each in glTF."""

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


@final
@dataclass(frozen=True)
class Tree:
    """Nodes, meshes and tracks of a glTF file."""

    buffer: _Buffer = field(default_factory=_Buffer)
    nodes: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)
    known: dict[tuple[int, str], int] = field(default_factory=dict)
    samplers: list[dict[str, Any]] = field(default_factory=list)
    channels: list[dict[str, Any]] = field(default_factory=list)

    def node(self, name: str, **more: Any) -> int:
        """Add a node; return its number."""
        self.nodes.append({"name": name, **more})
        return len(self.nodes) - 1

    def mesh(self, mesh: ShadedMesh, colour: str) -> int:
        """Add a mesh, unless the file has it already; return its number."""
        key = id(mesh), colour
        if key not in self.known:
            self.known[key] = len(self.meshes)
            primitive = {"attributes": _attributes(self.buffer, mesh, colour), "material": 0}
            self.meshes.append({"primitives": [primitive]})
        return self.known[key]

    def keys(self, times: NDArray[np.float32]) -> int:
        """Store the key times of tracks [s], shape [n], in the buffer; return the index of their glTF accessor."""
        return self.buffer.add(times, min=[float(times[0])], max=[float(times[-1])])

    def move(self, node: int, time: int, how: str, **tracks: Floats) -> None:
        """Give a node its position, rotation or scale over time.

        Parameters
        ----------
        node : int
            Number of the node.
        time : int
            Index of the glTF accessor of the key times, from :meth:`keys`.
        how : str
            Interpolation between the times, "LINEAR" or "STEP".
        tracks : array
            ``translation``, ``rotation`` or ``scale`` at each time, shape [n, 3], or [n, 4] for quaternions.  The node
            gets the first values; a track is stored only if its values change.
        """
        for name, track in tracks.items():
            values = track.astype(np.float32)
            self.nodes[node][name] = values[0].tolist()
            if np.any(values != values[0]):
                self.channels.append({"sampler": len(self.samplers), "target": {"node": node, "path": name}})
                self.samplers.append({"input": time, "output": self.buffer.add(values), "interpolation": how})

    def packed(self, roots: list[int]) -> bytes:
        """Bytes of the file; ``roots`` are the nodes without a parent."""
        top = self.node("run", rotation=_UPRIGHT, children=roots)
        blob = b"".join(self.buffer.blocks)
        told: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "nonsmooth"},
            "scene": 0,
            "scenes": [{"nodes": [top]}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": [
                {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.7}, "doubleSided": True}
            ],
            "accessors": self.buffer.accessors,
            "bufferViews": self.buffer.views,
            "buffers": [{"byteLength": len(blob)}],
        }
        if self.channels:
            told["animations"] = [{"name": "run", "samplers": self.samplers, "channels": self.channels}]
        return _container(told, blob)


def _attributes(buffer: _Buffer, mesh: ShadedMesh, shown: str) -> dict[str, int]:
    """Add the corners of all triangles, each with its own normal and colour."""
    corners = mesh.vertices[mesh.triangles].reshape(-1, 3).astype(np.float32)
    normals = corner_normals(mesh).reshape(-1, 3).astype(np.float32)
    colour = linear(shown) * mesh.shade[:, None] ** _GAMMA
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
    """Linear intensities of red, green and blue of a colour "#rrggbb", from 0 to 1, shape [3]."""
    shown = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** _GAMMA)


def _container(told: dict[str, Any], blob: bytes) -> bytes:
    text = json.dumps(told, separators=(",", ":")).encode("utf-8")
    chunks = [(b"JSON", text + b" " * (-len(text) % 4)), (b"BIN\0", blob + b"\0" * (-len(blob) % 4))]
    body = b"".join(struct.pack("<I", len(chunk)) + kind + chunk for kind, chunk in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
