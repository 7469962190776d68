"""Arrays as Zarr 3 describes them, and their chunks: Blosc with LZ4, or text, then a CRC32C checksum.

The package zarr reads these files, but does not write them here: it needs half a millisecond of asyncio for each chunk
and each array, ten times as long as the codecs.  A run writes forty chunks twice a second.  The codecs are those that
zarr itself calls.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

_LEVEL, _SHUFFLE = 5, 1
"""Level of compression (5 of 9) and mode of shuffling (1, by bytes) of Blosc, respectively: its defaults."""
_CHECKSUM = 4
"""Size of a CRC32C [bytes]."""
_SIZE, _LENGTH = slice(4, 8), slice(12, 16)
"""Bytes of the header of a Blosc chunk that hold the unpacked size and the packed size [bytes], respectively."""
TEXT = "string"
"""Type of an array of texts of any length."""


@final
@dataclass(frozen=True)
class ArrayLayout:
    """Layout of an array in a folder.

    Attributes
    ----------
    dimensions : tuple of str
        Names of the axes.
    dtype : str
        Type of the numbers, as numpy names it, or "string".
    shape : tuple of int
        Lengths of the axes.
    chunk : int
        Number of rows of a chunk, along the first axis.
    fill : float or str
        Value of entries that were never written.
    attributes : mapping
        Unit and description.
    """

    dimensions: tuple[str, ...]
    dtype: str
    shape: tuple[int, ...]
    chunk: int
    fill: float | str
    attributes: Mapping[str, Any]

    @classmethod
    def of(cls, metadata: Mapping[str, Any]) -> ArrayLayout:
        """Layout of an array from its Zarr metadata.

        Raises
        ------
        ValueError, KeyError, TypeError, AttributeError
            The metadata are not of an array that this module can write.
        """
        fill, chunks = metadata["fill_value"], metadata["chunk_grid"]["configuration"]["chunk_shape"]
        found = cls(
            tuple(metadata["dimension_names"]),
            metadata["data_type"],
            tuple(metadata["shape"]),
            chunks[0] if chunks else 1,
            math.nan if fill == "NaN" else fill,
            metadata["attributes"],
        )
        is_known = found.dtype == TEXT or np.dtype(found.dtype).kind in "biuf"
        if not is_known or min(*found.shape, found.chunk - 1, 0) < 0 or found.metadata() != metadata:
            raise ValueError("an array has a form that is not written here")
        return found

    def metadata(self) -> dict[str, Any]:
        """Zarr metadata of the array, values of JSON."""
        if self.dtype == TEXT:
            codecs: list[dict[str, Any]] = [{"name": "vlen-utf8", "configuration": {}}]
        else:
            blosc = {"cname": "lz4", "clevel": _LEVEL, "shuffle": "shuffle", "blocksize": 0}
            codecs = [
                {"name": "bytes", "configuration": {"endian": "little"}},
                {"name": "blosc", "configuration": {**blosc, "typesize": np.dtype(self.dtype).itemsize}},
            ]
        chunks = [self.chunk, *(max(1, n) for n in self.shape[1:])] if self.shape else []
        return {
            "zarr_format": 3,
            "node_type": "array",
            "shape": list(self.shape),
            "data_type": self.dtype,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunks}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "."}},
            # JSON has no number for NaN
            "fill_value": "NaN" if self.fill != self.fill else self.fill,
            "codecs": [*codecs, {"name": "crc32c"}],
            "attributes": dict(self.attributes),
            "dimension_names": list(self.dimensions),
            "storage_transformers": [],
        }

    def file(self, number: int) -> str:
        """Name of the file of a chunk."""
        return ".".join(["c", *(str(number) for _ in self.shape[:1]), *("0" for _ in self.shape[1:])])

    @property
    def numbers(self) -> np.dtype[Any]:
        """Type of the array in memory."""
        return np.dtype(object if self.dtype == TEXT else self.dtype)

    def blank(self) -> NDArray[Any]:
        """A chunk of fill values."""
        return np.full((self.chunk, *self.shape[1:]), self.fill, self.numbers)

    def encoded(self, chunk: NDArray[Any]) -> bytes:
        """Bytes of the file of a chunk: its content, compressed by Blosc (texts: VLenUTF8), and a CRC32C checksum."""
        # imported on use, because the import takes time and most runs write no folder
        import google_crc32c
        from numcodecs.blosc import Blosc
        from numcodecs.vlen import VLenUTF8

        codec = VLenUTF8() if self.dtype == TEXT else Blosc("lz4", _LEVEL, _SHUFFLE)
        content = bytes(codec.encode(np.ascontiguousarray(chunk)))
        checksum: int = google_crc32c.value(content)
        return content + checksum.to_bytes(_CHECKSUM, "little")

    def decoded(self, content: bytes) -> NDArray[Any]:
        """Chunk from its bytes.

        Raises
        ------
        ValueError
            The bytes are damaged, or of another chunk.
        """
        import google_crc32c
        from numcodecs.blosc import Blosc
        from numcodecs.vlen import VLenUTF8

        packed, shape = content[:-_CHECKSUM], (self.chunk, *self.shape[1:])
        if google_crc32c.value(packed) != int.from_bytes(content[-_CHECKSUM:], "little"):
            raise ValueError("the checksum is not that of what was written")
        if self.dtype == TEXT:
            return np.asarray(VLenUTF8().decode(packed)).reshape(shape)
        # Blosc trusts the sizes in the header: wrong ones could fill the memory, or make it read beyond the content
        found = tuple(int.from_bytes(packed[part], "little") for part in (_SIZE, _LENGTH))
        if found != (size := math.prod(shape) * self.numbers.itemsize, len(packed)):
            raise ValueError(f"it has {found[0]} bytes packed to {found[1]}, and not {size} packed to {len(packed)}")
        try:
            return np.frombuffer(Blosc().decode(packed), self.numbers).reshape(shape).copy()
        except RuntimeError as error:
            raise ValueError(str(error)) from error
