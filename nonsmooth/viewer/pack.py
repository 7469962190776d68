"""Arrays as text within a page, small: bytes of like weight side by side, gzip, base64."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

TYPES = {"f8": "<f8", "f4": "<f4", "i4": "<i4", "i2": "<i2", "u1": "|u1"}
"""Types of numbers that the player reads."""


def pack(arrays: Mapping[str, tuple[str, NDArray[Any]]]) -> tuple[list[dict[str, Any]], str]:
    """Return a directory of arrays, given by name with their types, and the text that holds them.

    An array of n numbers of b bytes becomes b rows of n bytes, of which the high ones change little: gzip finds more
    in them.  Equal arrays give equal text.
    """
    directory, blocks, at = [], list[bytes](), 0
    for name, (kind, array) in arrays.items():
        block = np.ascontiguousarray(array, dtype=TYPES[kind])
        shuffled = block.reshape(-1).view(np.uint8).reshape(-1, block.itemsize).T.tobytes()
        directory.append({"name": name, "type": kind, "shape": list(block.shape), "at": at, "bytes": len(shuffled)})
        blocks.append(shuffled)
        at += len(shuffled)
    return directory, base64.b64encode(gzip.compress(b"".join(blocks), 9, mtime=0)).decode("ascii")
