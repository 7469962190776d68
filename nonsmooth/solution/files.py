"""Files that are whole or not there, and what is said where they cannot be written."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from nonsmooth.errors import InvalidInput, NonsmoothError

_REMEDY = "Free space there or choose another folder."
_REMEDIES = {
    errno.ENOTDIR: "Name a folder; one that is not there is made.",
    errno.EAGAIN: "Free memory; `nonsmooth resume` goes on with a run that was cut off.",
}


class FileError(NonsmoothError, OSError):
    """A file or folder that could not be written; the message names the path."""

    def __init__(self, path: object, error: OSError) -> None:
        reason = error.strerror or error
        super().__init__(f"{path} could not be written: {reason}. {_remedy(error)}")


def _remedy(error: OSError) -> str:
    return _REMEDIES.get(error.errno or 0, _REMEDY)


def prepare(folder: Path) -> None:
    """Create a folder and try to write into it, so that a wrong path is found before a run and not after it.

    Raises
    ------
    InvalidInput
        If that is not possible.
    """
    try:
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, "It is a file")
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(b"probe")
    except OSError as error:
        rule = "must be a folder that can be written to"
        raise InvalidInput(str(folder), rule, error.strerror, _remedy(error)) from error


def content_of(path: Path) -> bytes:
    """Return the content of a regular file.

    Raises
    ------
    OSError
        If it cannot be read, or is a pipe or a device, whose content has no end.
    """
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise OSError(errno.EINVAL, "It is a pipe or a device", str(path))
    return path.read_bytes()


def remove_link(path: Path) -> None:
    """Remove a symbolic link, through which a file elsewhere would be written."""
    if path.is_symlink():
        path.unlink()


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a path to write to; it becomes ``path`` when all is written, so that no half file takes that name.

    Raises
    ------
    FileError
        If writing fails; an older file of that name stays as it was.
    """
    if path.is_dir():
        raise FileError(path, IsADirectoryError(errno.EISDIR, "It is a folder"))
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_link(part)
        yield part
        os.replace(part, path)
    except OSError as error:
        raise FileError(path, error) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()
