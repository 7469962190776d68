"""Files that appear whole or not at all, and the error of a file that cannot be written."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from nonsmooth.errors import InvalidInput, NonsmoothError

_REMEDY = "Free space there or choose another folder."
_REMEDIES = {
    errno.ENOTDIR: "Name a folder; one that is not there is made.",
    errno.EAGAIN: "Free memory; `nonsmooth resume` continues a run that was cut off.",
}


class FileError(NonsmoothError, OSError):
    """A file or folder that could not be written; the message names the path."""

    def __init__(self, path: object, error: OSError) -> None:
        reason = error.strerror or error
        super().__init__(f"{path} could not be written: {reason}. {_remedy(error)}")


def _remedy(error: OSError) -> str:
    return _REMEDIES.get(error.errno or 0, _REMEDY)


@contextlib.contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn an error of the operating system into a :class:`FileError` that names the path.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise FileError(path, error) from error


def prepare(folder: Path) -> None:
    """Create a folder and try to write into it, so that a wrong path is found before the run.

    Raises
    ------
    InvalidInput
        The folder cannot be created or written to.
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
    """Content of a regular file.

    Raises
    ------
    OSError
        The file cannot be read, or it is a pipe or a device, whose content has no end.
    """
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise OSError(errno.EINVAL, "It is a pipe or a device", str(path))
    return path.read_bytes()


def part_of(path: Path) -> Path:
    """Temporary path next to a file or folder, for its new content; a link at that path is removed."""
    part = path.with_name(f".{path.name}.part")
    if part.is_symlink():
        part.unlink()
    return part


def sync(path: Path) -> None:
    """Wait until the content of a file, or the names in a folder, are on the disk.

    Raises
    ------
    FileError
        The content or the names cannot be written.
    """
    if path.is_dir() and os.name != "posix":  # only POSIX systems can open a folder
        return
    with writing(path):
        file = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
        try:
            os.fsync(file)
        finally:
            os.close(file)


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Temporary path for a file or a folder, which is renamed to ``path`` when all of its content is on the disk.

    Until then an older file or folder of that name is unchanged, however the process ends.

    Raises
    ------
    FileError
        Writing fails, or a folder has the name of the file.
    """
    with writing(path):
        part = part_of(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove(part)
        try:
            yield part
            old = path.with_name(f".{path.name}.old")
            if part.is_dir():
                for file in part.iterdir():
                    sync(file)
                # a folder is replaced only if it is empty
                if path.is_dir():
                    _remove(old)
                    path.replace(old)
            elif path.is_dir():
                raise IsADirectoryError(errno.EISDIR, "It is a folder")
            sync(part)
            part.replace(path)
            sync(path.parent)
            _remove(old)
        finally:
            with contextlib.suppress(OSError):
                _remove(part)


def _remove(path: Path) -> None:
    """Remove a file, a link or a folder, if the path exists."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
