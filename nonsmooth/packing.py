"""Numbers packed into few bytes by Blosc with LZ4: many times as fast as zlib, and read wherever Zarr is."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

CODEC = {"id": "blosc", "cname": "lz4", "clevel": 5, "shuffle": 1, "blocksize": 0}
"""What packs them, in the words of Zarr."""
_CHECKSUM = 4
"""Bytes of a CRC-32."""
_SIZE = slice(4, 8)
"""Where the head of what Blosc has packed says how many bytes it becomes."""
_LENGTH = slice(12, 16)
"""Where it says how many bytes it has."""


def packed(values: NDArray[Any]) -> bytes:
    """Return the bytes of an array, packed."""
    # imported where used: not every run has an output
    from numcodecs import Blosc

    codec = Blosc(CODEC["cname"], CODEC["clevel"], CODEC["shuffle"], CODEC["blocksize"])
    return bytes(codec.encode(np.ascontiguousarray(values)))


def with_checksum(content: bytes) -> bytes:
    """Return bytes behind their CRC-32, as the filter crc32 of Zarr writes them."""
    return zlib.crc32(content).to_bytes(_CHECKSUM, "little") + content


def without_checksum(content: bytes) -> bytes:
    """Return bytes that :func:`with_checksum` was given.

    Raises
    ------
    ValueError
        If they are no longer the same.
    """
    found = content[_CHECKSUM:]
    if int.from_bytes(content[:_CHECKSUM], "little") != zlib.crc32(found):
        raise ValueError("the checksum is not that of what was written")
    return found


def unpacked(content: bytes, dtype: DTypeLike, count: int | None = None) -> NDArray[Any]:
    """Return what was packed, as a row of numbers, of which there must be ``count`` where that is given.

    Raises
    ------
    ValueError
        If it is none, or damaged.
    """
    from numcodecs import Blosc

    try:
        # checked before it is unpacked: a few bytes may become all of the memory, and Blosc reads as many as they say
        size, length = (int.from_bytes(content[part], "little") for part in (_SIZE, _LENGTH))
        if length != len(content):
            raise ValueError(f"it has {len(content)} bytes, and not {length} as its head says")
        if count is not None and size != count * np.dtype(dtype).itemsize:
            raise ValueError(f"it holds {size} bytes, and not {count} numbers")
        return np.frombuffer(Blosc().decode(content), dtype).copy()
    except RuntimeError as error:
        raise ValueError(str(error)) from error
