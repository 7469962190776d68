"""A GLB file, read by other means than those that wrote it."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_TYPES: dict[int, Any] = {5126: np.float32, 5121: np.uint8}
_WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


class Read:
    """What is in the file."""

    def __init__(self, data: bytes) -> None:
        magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
        assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
        assert size % 4 == 0
        self.told = json.loads(data[20 : 20 + size])
        blob, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0"
        self.blob = data[28 + size :]
        assert len(self.blob) == blob == self.told["buffers"][0]["byteLength"]

    def array(self, number: int) -> NDArray[Any]:
        accessor = self.told["accessors"][number]
        view = self.told["bufferViews"][accessor["bufferView"]]
        width = _WIDTHS[accessor["type"]]
        found = np.frombuffer(
            self.blob, _TYPES[accessor["componentType"]], accessor["count"] * width, view["byteOffset"]
        )
        return found.reshape(-1, width)

    def node(self, name: str) -> int:
        """Return the first node of a name."""
        return next(i for i, one in enumerate(self.told["nodes"]) if one.get("name") == name)

    def track(self, name: str, path: str) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return times and values of the track of a node."""
        animation = self.told["animations"][0]
        for channel in animation["channels"]:
            if channel["target"] == {"node": self.node(name), "path": path}:
                sampler = animation["samplers"][channel["sampler"]]
                return self.array(sampler["input"])[:, 0], self.array(sampler["output"])
        raise AssertionError(f"{name} has no track of {path}")
