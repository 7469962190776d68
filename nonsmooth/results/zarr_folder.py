"""Arrays on disk that grow, in the Zarr format, version 2, which zarr, xarray and others read.

A commit is seen as a whole or not at all, by readers and after a power cut: chunks come first, each written beside the
one that it replaces, then the consolidated metadata, one file with the lengths of all arrays.  What a chunk holds
beyond the length of its array does not count; a chunk that is new has its name at once.  No library for the format
promises that order, nor that a file is safe on the disk before it takes its name; that is all that is done here.
"""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import LabelledArray
from nonsmooth.packing import CODEC, packed, unpacked, with_checksum, without_checksum
from nonsmooth.solution.files import FileError, content_of, remove_link

_GROUP = {"zarr_format": 2}
_CONSOLIDATED = ".zmetadata"
_ENTRIES = 2**14
"""Entries of a chunk of an array that grows: the last one is written anew with every commit."""
_AT_ONCE = 16
"""Files for which the disk is waited for at once."""
_FILTERS = [CODEC, {"id": "crc32"}]
"""What a chunk goes through, in the words of Zarr: a bit that turns on the disk is noticed when it is read."""
_NAME = re.compile(r"\w+")
_KINDS = "fiuU"


@final
@dataclass(frozen=True)
class _Array:
    dimensions: tuple[str, ...]
    dtype: str
    inner: tuple[int, ...]
    chunk: int
    attributes: Mapping[str, Any]


@final
class ZarrFolder:
    """A group of arrays in a folder.

    Parameters
    ----------
    path : Path
        The folder.
    attributes : dict
        Those of the group, as JSON has them; they become those of the folder with the next commit.
    """

    def __init__(self, path: Path, attributes: dict[str, Any]) -> None:
        self.path, self.attributes = path, attributes
        self._arrays: dict[str, _Array] = {}
        self._lengths: dict[str, int] = {}
        self._tails: dict[str, tuple[int, NDArray[Any]]] = {}
        self._waiting: dict[Path, Path] = {}

    @classmethod
    def opened(cls, path: Path) -> ZarrFolder:
        """Open the folder as its last commit left it.

        Raises
        ------
        InvalidInput
            If there is none, or it has another form.
        """
        try:
            entries = json.loads(content_of(path / _CONSOLIDATED))["metadata"]
            made = cls(path, dict(entries[".zattrs"]))
            for key, entry in entries.items():
                name, _, kind = key.rpartition("/")
                if kind == ".zarray":
                    made._describe(name, entry, dict(entries[f"{name}/.zattrs"]))
        except (FileNotFoundError, NotADirectoryError) as error:
            raise InvalidInput(
                str(path), "must be a folder of results", "not there", "Name a folder that `run` wrote."
            ) from error
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise InvalidInput(
                str(path), "must be a folder of results", f"{type(error).__name__}: {error}", "Name another."
            ) from error
        return made

    def _describe(self, name: str, entry: dict[str, Any], attributes: dict[str, Any]) -> None:
        dimensions, dtype = tuple(map(str, attributes.pop("_ARRAY_DIMENSIONS"))), np.dtype(str(entry["dtype"]))
        shape, chunks = [int(n) for n in entry["shape"]] or [1], [int(n) for n in entry["chunks"]] or [1]
        is_known = dtype.kind in _KINDS and entry["filters"] == _FILTERS
        if not _NAME.fullmatch(name) or not is_known or min(shape) < 0 or min(chunks) < 1:
            raise ValueError(f"the array {name!r} has a form that is not written here")
        self._arrays[name] = _Array(dimensions, dtype.str, tuple(shape[1:]), chunks[0], attributes)
        self._lengths[name] = shape[0]

    def add(self, variable: LabelledArray, *, grows: bool) -> None:
        """Add an array, or put another one in the place of one; what it holds counts from the next commit on.

        Raises
        ------
        InvalidInput
            If its name cannot be that of a folder.
        FileError
            If it cannot be written.
        """
        if not _NAME.fullmatch(variable.name):
            remedy = "Rename it."
            raise InvalidInput("variable", "must have a name of letters, digits and underscores", variable.name, remedy)
        values = np.asarray(variable.values)
        if values.dtype.kind == "U" and values.dtype.itemsize == 0:
            values = values.astype("<U1")
        if values.ndim == 0:
            values = values.reshape(1)
        inner, width = values.shape[1:], int(np.prod(values.shape[1:]))
        chunk = max(1, _ENTRIES // max(1, width)) if grows else max(1, len(values))
        array = _Array(variable.dimensions, values.dtype.str, inner, chunk, dict(variable.attributes))
        self._tails.pop(variable.name, None)
        self._arrays[variable.name], self._lengths[variable.name] = array, 0
        self.write(variable.name, 0, values)

    def write(self, name: str, start: int, rows: NDArray[Any]) -> None:
        """Put rows into an array from a row on, as its last ones.

        Raises
        ------
        FileError
            If that cannot be written; the last commit stays as it is.
        """
        array, end = self._arrays[name], start + len(rows)
        rows = np.asarray(rows, array.dtype)
        for number in range(start // array.chunk, -(-end // array.chunk) if rows.size else 0):
            first = number * array.chunk
            low, high = max(start, first), min(end, first + array.chunk)
            content = rows[low - start : high - start]
            if len(content) < array.chunk:
                tail = self._chunk(name, number)
                tail[low - first : high - first] = content
                self._tails[name], content = (number, tail), tail
            self._put(self._place(name, number), with_checksum(packed(content)))
        self._lengths[name] = end

    def read(self, name: str) -> NDArray[Any]:
        """Return all rows of an array.

        Raises
        ------
        InvalidInput
            If there is no such array, or a chunk is not there or broken.
        """
        if name not in self._arrays:
            raise InvalidInput(f"{self.path}: {name}", "must be there", None, "Results are damaged there.")
        array, length = self._arrays[name], self._lengths[name]
        numbers = range(-(-length // array.chunk)) if 0 not in array.inner else ()
        parts = [self._stored(name, number) for number in numbers]
        rows = np.concatenate(parts) if parts else np.zeros((length, *array.inner), array.dtype)
        return rows[:length].reshape((length, *array.inner) if array.dimensions else ())

    @property
    def names(self) -> set[str]:
        """The names of all arrays."""
        return set(self._arrays)

    def length(self, name: str) -> int:
        """Return how many rows an array has."""
        return self._lengths[name]

    def remove(self, name: str) -> None:
        """Take an array out of the group; its files go at once.  A name of no array removes nothing."""
        if self._arrays.pop(name, None) is not None:
            shutil.rmtree(self.path / name, ignore_errors=True)

    def cut(self, dimension: str, length: int) -> None:
        """Leave so many rows of all arrays over a dimension."""
        for name, array in self._arrays.items():
            if array.dimensions[:1] == (dimension,):
                self._lengths[name] = min(length, self._lengths[name])
        self._tails.clear()

    @contextlib.contextmanager
    def _threads(self) -> Iterator[Executor]:
        """Yield a pool of threads; FileError where the machine starts none, as where memory has run out."""
        try:
            with ThreadPoolExecutor(_AT_ONCE) as pool:
                yield pool
        except RuntimeError as error:
            raise FileError(self.path, OSError(errno.EAGAIN, f"{error}")) from error

    def commit_safely(self) -> None:
        """Let all that was written since the last commit count, at once, and after a power cut from now on as well.

        Raises
        ------
        FileError
            If that is not possible; then the last commit counts.
        """
        with self._threads() as pool:
            _to_disk(pool, self._waiting.values())
            _to_disk(pool, self._rename())
            self._announce()
            _to_disk(pool, self._waiting.values())
            _to_disk(pool, self._rename())

    def commit(self) -> None:
        """Let all that was written since the last commit count, at once; how soon it is on the disk the system says.

        Raises
        ------
        FileError
            If that is not possible; then the last commit counts.
        """
        self._rename()
        self._announce()
        self._rename()

    def _announce(self) -> None:
        entries: dict[str, Any] = {".zgroup": _GROUP, ".zattrs": self.attributes}
        for name in self._arrays:
            entries |= {f"{name}/{key}": entry for key, entry in self._metadata(name).items()}
        # zarr takes the group's own attributes from there
        for key in (".zgroup", ".zattrs"):
            self._put(self.path / key, _json(entries[key]))
        path = self.path / _CONSOLIDATED
        self._write_part(path, _beside(path), _json({"metadata": entries, "zarr_consolidated_format": 1}))

    def spell_out(self, names: Iterable[str]) -> None:
        """Write the metadata of some arrays by themselves as well, for readers that look there.

        Raises
        ------
        FileError
            If that is not possible.
        """
        for name in names:
            for key, entry in self._metadata(name).items():
                self._put(self.path / name / key, _json(entry))
        self._rename()

    def file(self, name: str, content: bytes) -> None:
        """Put a file of another kind into the folder, with the next commit.

        Raises
        ------
        FileError
            If that is not possible.
        """
        self._put(self.path / name, content)

    def _discard(self) -> None:
        for part in self._waiting.values():
            part.unlink(missing_ok=True)
        self._waiting.clear()

    def _metadata(self, name: str) -> dict[str, dict[str, Any]]:
        array = self._arrays[name]
        shape, chunks = [self._lengths[name], *array.inner], [array.chunk, *(max(1, n) for n in array.inner)]
        entry = {
            "zarr_format": 2,
            "shape": shape if array.dimensions else [],
            "chunks": chunks if array.dimensions else [],
            "dtype": array.dtype,
            "compressor": None,
            "fill_value": None,
            "order": "C",
            "filters": _FILTERS,
        }
        return {".zarray": entry, ".zattrs": {"_ARRAY_DIMENSIONS": list(array.dimensions), **array.attributes}}

    def _chunk(self, name: str, number: int) -> NDArray[Any]:
        array = self._arrays[name]
        tail, content = self._tails.get(name, (-1, None))
        if content is not None and tail == number:
            return content
        if number * array.chunk < self._lengths[name]:
            return self._stored(name, number)
        return np.zeros((array.chunk, *array.inner), array.dtype)

    def _stored(self, name: str, number: int) -> NDArray[Any]:
        array, path = self._arrays[name], self._place(name, number)
        try:
            values = unpacked(without_checksum(content_of(path)), array.dtype, array.chunk * math.prod(array.inner))
            return values.reshape((array.chunk, *array.inner))
        except (OSError, ValueError) as error:
            raise InvalidInput(str(path), "must be a whole chunk", f"{error}", "Results are damaged there.") from error

    def _place(self, name: str, number: int) -> Path:
        array = self._arrays[name]
        return self.path / name / ".".join(map(str, (number, *(0 for _ in array.inner))))

    def _put(self, path: Path, content: bytes) -> None:
        # to take the place of a file makes the system wait for the disk
        self._write_part(path, _beside(path) if path.exists() else path, content)

    def _write_part(self, path: Path, part: Path, content: bytes) -> None:
        try:
            if not path.parent.exists():
                path.parent.mkdir(parents=True)
            self._waiting[path] = part
            remove_link(part)
            part.write_bytes(content)
        except OSError as error:
            self._discard()
            raise FileError(path, error) from error

    def _rename(self) -> set[Path]:
        """Let what was written take its names; return the folders in which it did."""
        folders = {path.parent for path in self._waiting}
        for path, part in self._waiting.items():
            if part == path:
                continue
            try:
                os.replace(part, path)
            except OSError as error:
                raise FileError(path, error) from error
        self._waiting.clear()
        return folders


def _beside(path: Path) -> Path:
    """Return where a file is written before it takes its name."""
    return path.with_name(f".{path.name}.part")


def _json(entry: Mapping[str, Any]) -> bytes:
    return json.dumps(entry, allow_nan=False).encode()


def _to_disk(pool: Executor, paths: Iterable[Path]) -> None:
    """Wait until files or folders are safe on the disk: at once, as it waits for all of them no longer than for one."""
    list(pool.map(_sync, list(paths)))


def _sync(path: Path) -> None:
    if path.is_dir() and os.name != "posix":  # elsewhere a folder cannot be opened
        return
    try:
        file = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
        try:
            os.fsync(file)
        finally:
            os.close(file)
    except OSError as error:
        raise FileError(path, error) from error
