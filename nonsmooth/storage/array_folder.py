"""Arrays in a folder in the Zarr 3 format, written so that a commit takes effect as a whole or not at all.

A commit survives the death of the process and, if it is a safe one, a power cut:

1. New chunks and other files are written and synced to the disk.  A chunk that replaces an earlier one, such as the
   last chunk of an array that has grown, is written under another name and then renamed.
2. The folders of these files are synced.
3. One more file is written in the same way, which makes the commit valid: the metadata of the group, with the lengths
   of all arrays, or the chunk of a study's status.

A process that dies before step 3 may leave new chunks behind.  Readers use only the rows within the lengths in the
metadata, so they ignore new chunks and the added rows of a rewritten last chunk.  The next commit replaces them.  The
earlier commit stays valid, because a rewritten last chunk begins with the same rows.  A commit that is not safe does
not sync.

Each chunk has a checksum (CRC32C), and so has the metadata (CRC-32, the attribute "checksum").  A bit that changes on
the disk is therefore noticed before the content is used.
"""

from __future__ import annotations

import errno
import json
import re
import shutil
import zlib
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.storage.chunks import TEXT, ArrayLayout
from nonsmooth.storage.files import FileError, content_of, part_of, sync, writing
from nonsmooth.storage.lock import WRITER

FORMAT_VERSION = 2
"""Version of the format of a folder.  Folders of nonsmooth 0.1 have none."""
_GROUP = "zarr.json"
_ENTRIES = 2**14
"""Numbers in a chunk of an array that grows; small, because every commit writes the last chunk again."""
_AT_ONCE = 16
"""Number of files that are synced to the disk at the same time; 16 files take about as long as one file."""
_NAME = re.compile(r"[^\s./\\][^/\\]*")
_DAMAGED = "It is damaged: take it from a copy, or run again."


@final
class ArrayFolder:
    """Reads and writes the named arrays of one folder; readers see new rows after the next commit.

    Parameters
    ----------
    path : Path
        The folder.
    attributes : dict
        Attributes of the group, values of JSON.  Changes are written with the next commit.
    """

    def __init__(self, path: Path, attributes: dict[str, Any]) -> None:
        self.path, self.attributes = path, attributes
        self._arrays: dict[str, ArrayLayout] = {}
        self._waiting: dict[Path, bytes] = {}

    @classmethod
    def opened(cls, path: Path, rule: str, remedy: str) -> ArrayFolder:
        """Open a folder as its last commit left it.

        ``rule`` and ``remedy`` are parts of the message about a folder with other content.

        Raises
        ------
        InvalidInput
            There is no folder of arrays, another version wrote it, or it is damaged.
        """
        try:
            content = json.loads(content_of(path / _GROUP))
        except (FileNotFoundError, NotADirectoryError) as error:
            _check_version(path, 0 if (path / ".zmetadata").exists() else FORMAT_VERSION)
            raise InvalidInput(str(path), rule, "not there", remedy) from error
        except (OSError, ValueError, RecursionError) as error:
            raise InvalidInput(str(path / _GROUP), rule, f"{type(error).__name__}: {error}", remedy) from error
        try:
            attributes = dict(content["attributes"])
            checksum, version = attributes.pop("checksum", None), attributes.pop("format_version", None)
            if checksum != _checksum(content):
                # report another format version first, because its checksum may be computed in another way or be missing
                _check_version(path, version if isinstance(version, int) else 0)
                raise ValueError("the checksum is not that of what was written")
            _check_version(path, version)
            found = cls(path, attributes)
            for name, entry in content["consolidated_metadata"]["metadata"].items():
                found._arrays[_checked(name)] = ArrayLayout.of(entry)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise InvalidInput(
                str(path / _GROUP), "must be as it was written", f"{type(error).__name__}: {error}", _DAMAGED
            ) from error
        return found

    @property
    def names(self) -> set[str]:
        """Names of all arrays."""
        return set(self._arrays)

    def layout(self, name: str) -> ArrayLayout:
        """Layout of an array.

        Raises
        ------
        InvalidInput
            There is no array of that name.
        """
        if name not in self._arrays:
            raise InvalidInput(f"{self.path}: {name}", "must be there", None, _DAMAGED)
        return self._arrays[name]

    def declare(self, name: str, layout: ArrayLayout) -> None:
        """Add an array whose chunks are written later, or replace the array of that name.

        Raises
        ------
        InvalidInput
            The name cannot be the name of a folder.
        """
        self._arrays[_checked(name)] = layout

    def add(
        self, name: str, dimensions: tuple[str, ...], values: NDArray[Any], attributes: Mapping[str, Any], grows: bool
    ) -> None:
        """Add an array with values, or replace the array of that name.

        An array that grows has chunks of a fixed number of rows; other arrays have a single chunk.

        Raises
        ------
        InvalidInput
            The name cannot be the name of a folder.
        """
        values = np.asarray(values)
        is_text = values.dtype.kind == "U"
        width = int(np.prod(values.shape[1:]))
        chunk = max(1, _ENTRIES // max(1, width)) if grows else max(1, len(values) if values.shape else 1)
        dtype, fill = (TEXT, "") if is_text else (values.dtype.name, False if values.dtype.kind == "b" else 0)
        shape = (0, *values.shape[1:]) if values.shape else ()
        self.declare(name, ArrayLayout(dimensions, dtype, shape, chunk, fill, attributes))
        self.write(name, 0, values)

    def write(self, name: str, start: int, rows: NDArray[Any]) -> None:
        """Write rows into an array from row ``start`` on; readers see them after the next commit.

        The rows must end at the end of a chunk, or be the last rows of the array: rows after them in a chunk are lost.
        """
        layout = self.layout(name)
        if not layout.shape:
            self._waiting[self._place(name, 0)] = layout.encoded(np.array([rows.item()], layout.numbers))
            return
        end = start + len(rows)
        for number in range(start // layout.chunk, -(-end // layout.chunk) if rows.size else 0):
            first = number * layout.chunk
            low, high = max(start, first), min(end, first + layout.chunk)
            content = rows[low - start : high - start]
            if len(content) < layout.chunk:
                # if the rows begin within this chunk, keep the earlier rows of the chunk
                content = self.chunk(name, number) if low > first else layout.blank()
                content[low - first : high - first] = rows[low - start : high - start]
            self._waiting[self._place(name, number)] = layout.encoded(content.astype(layout.numbers, copy=False))
        self._arrays[name] = replace(layout, shape=(max(end, *layout.shape[:1]), *rows.shape[1:]))

    def read(self, name: str, start: int = 0, stop: int | None = None) -> NDArray[Any]:
        """Rows from ``start`` to ``stop`` of an array, by default all.

        Raises
        ------
        InvalidInput
            There is no such array, or a chunk is missing or damaged.
        """
        layout = self.layout(name)
        if not layout.shape:
            return self.chunk(name, 0)
        stop = layout.shape[0] if stop is None else stop
        if start == stop or 0 in layout.shape[1:]:
            return np.zeros((stop - start, *layout.shape[1:]), layout.numbers)
        first = start // layout.chunk
        rows = np.concatenate([self.chunk(name, number) for number in range(first, -(-stop // layout.chunk))])
        return rows[start - first * layout.chunk : stop - first * layout.chunk]

    def chunk(self, name: str, number: int) -> NDArray[Any]:
        """A whole chunk of an array.

        Raises
        ------
        InvalidInput
            The chunk is missing or damaged.
        """
        layout, path = self.layout(name), self._place(name, number)
        try:
            chunk = layout.decoded(self._waiting[path] if path in self._waiting else content_of(path))
            return chunk if layout.shape else chunk.reshape(())
        except (OSError, ValueError) as error:
            raise InvalidInput(str(path), "must be a whole chunk", f"{error}", _DAMAGED) from error

    def _place(self, name: str, number: int) -> Path:
        return self.path / name / self._arrays[name].file(number)

    def cut(self, dimension: str, length: int) -> None:
        """Shorten all arrays whose first axis is ``dimension`` to at most ``length`` rows."""
        for name, one in self._arrays.items():
            if one.dimensions[:1] == (dimension,):
                self._arrays[name] = replace(one, shape=(min(length, one.shape[0]), *one.shape[1:]))

    def remove(self, name: str) -> None:
        """Remove an array and, at once, its files; do nothing if there is no array of that name."""
        if self._arrays.pop(name, None) is not None:
            shutil.rmtree(self.path / name, ignore_errors=True)

    def file(self, name: str, content: bytes) -> None:
        """Put a file that is no part of an array, such as a stored state, into the folder, with the next commit."""
        self._waiting[self.path / name] = content

    def commit(self, *, safely: bool) -> None:
        """Commit all that was written since the last commit; with ``safely``, wait until it is on the disk.

        Raises
        ------
        FileError
            Writing fails; the last commit then stays valid.
        """
        self.flush(safely)
        self.file(_GROUP, self._group())
        self.flush(safely, counts=True)

    def mark(self) -> None:
        """Mark the folder at once as made by nonsmooth, so that it may be emptied even before the first commit.

        Raises
        ------
        FileError
            The mark cannot be written.
        """
        self.file(f"{WRITER}/{_GROUP}", _MARK)
        self.flush(safely=False)

    def flush(self, safely: bool, *, counts: bool = False) -> None:
        """Write the files that were prepared since the last call. Raises the errors of :meth:`commit`.

        If ``safely`` is True, the files are also synced to the disk. If ``counts`` is True, these files make the commit
        valid. Such files, and files that replace others, are written under another name and then renamed, so that
        readers never see an incomplete file. Other files get their name at once, because a rename makes the system wait
        for the disk.
        """
        files, self._waiting = self._waiting, {}
        parts = {path: part_of(path) if counts or path.exists() else path for path in files}
        try:
            for path, content in files.items():
                with writing(path):
                    path.parent.mkdir(parents=True, exist_ok=True)
                    parts[path].write_bytes(content)
            if safely:
                self._sync(parts.values())
            for path, part in parts.items():
                if part != path:
                    with writing(path):
                        part.replace(path)
            if safely:
                self._sync({path.parent for path in parts})
        except FileError:
            for part in parts.values():
                part.unlink(missing_ok=True)
            raise

    def _sync(self, paths: Iterable[Path]) -> None:
        """Wait until files or folders are on the disk; several at once take about as long as one."""
        try:
            with ThreadPoolExecutor(_AT_ONCE) as pool:
                list(pool.map(sync, paths))
        except RuntimeError as error:  # no thread can be started, for example if memory has run out
            raise FileError(self.path, OSError(errno.EAGAIN, f"{error}")) from error

    def _group(self) -> bytes:
        """Content of the file zarr.json, as JSON in bytes: attributes of the folder, and metadata of all its arrays."""
        entries = {name: one.metadata() for name, one in self._arrays.items()}
        attributes = {**self.attributes, "format_version": FORMAT_VERSION}
        content = {
            "zarr_format": 3,
            "node_type": "group",
            "attributes": attributes,
            "consolidated_metadata": {"kind": "inline", "must_understand": False, "metadata": entries},
        }
        return _json({**content, "attributes": {**attributes, "checksum": _checksum(content)}})

    def spell_out(self, names: Iterable[str]) -> None:
        """Write the metadata of some arrays into their own folders too.

        Some readers of Zarr do not use the metadata of the group, which has those of all arrays.

        Raises
        ------
        FileError
            The metadata cannot be written.
        """
        for name in names:
            self.file(f"{name}/{_GROUP}", _json(self._arrays[name].metadata()))
        self.flush(safely=False)


def _json(content: Mapping[str, Any]) -> bytes:
    return json.dumps(content, allow_nan=False).encode()


_MARK = _json({"zarr_format": 3, "node_type": "group", "attributes": {"title": "lock and states of nonsmooth"}})
"""Metadata of the subfolder for the lock and states. The subfolder shows that nonsmooth made the folder of arrays."""


def is_marked(path: Path) -> bool:
    """True if a folder contains the subfolder by which nonsmooth marks the folders of arrays that it made."""
    try:
        return content_of(path / WRITER / _GROUP) == _MARK
    except OSError:
        return False


def _checked(name: str) -> str:
    """Check the name of an array, which is also the name of the array's folder, and return it.

    Raises
    ------
    InvalidInput
        The name cannot be the name of a folder, or it is the name of the folder of the writer.
    """
    if not _NAME.fullmatch(name) or name == WRITER:
        rule = "must have a name that a folder can have, of letters, digits and underscores"
        raise InvalidInput("variable", rule, name, "Rename it.")
    return name


def _check_version(path: Path, version: int) -> None:
    """Raise InvalidInput if another version of nonsmooth wrote the folder; 0 means nonsmooth 0.1."""
    if version == FORMAT_VERSION:
        return
    if version > FORMAT_VERSION:
        written, remedy = f"version {version}, of a newer nonsmooth", "Install that one to open it."
    else:
        written = f"version {version}, of an older nonsmooth" if version > 0 else "none, as nonsmooth 0.1 wrote it"
        remedy = "Open it with that version, or run again."
    raise InvalidInput(str(path), f"must have format version {FORMAT_VERSION}", written, remedy)


def _checksum(content: Mapping[str, Any]) -> int:
    """CRC-32 of the metadata of a group, in a canonical form without the checksum itself."""
    attributes = {name: value for name, value in content["attributes"].items() if name != "checksum"}
    return zlib.crc32(json.dumps({**content, "attributes": attributes}, sort_keys=True).encode())
