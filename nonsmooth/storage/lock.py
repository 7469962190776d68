"""A folder has one writer at a time, who writes to nothing outside of it."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import TYPE_CHECKING

from nonsmooth.errors import InvalidInput
from nonsmooth.storage.files import FileError

if TYPE_CHECKING:
    from filelock import BaseFileLock

WRITER = "writer"
"""Name of the folder for files of the process that writes: the lock, and the states from which a run is resumed."""
LOCK = f"{WRITER}/.lock"
"""File by which a folder is locked. It stays; the lock ends with the process that holds it."""


def locked(folder: Path) -> BaseFileLock:
    """Lock of a folder, which is made if it is not there; ``release()`` returns it.

    Raises
    ------
    InvalidInput
        If another run writes there, or a link has the name of the lock.
    FileError
        If the folder cannot be written to.
    """
    # imported on use: most runs write no folder
    from filelock import FileLock, Timeout

    # a thread other than the one that took the lock may return it
    lock = FileLock(folder / LOCK, blocking=False, thread_local=False)
    try:
        (folder / LOCK).parent.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except Timeout as error:
        remedy = "Wait for the run that writes there, or end it."
        raise InvalidInput(str(folder), "must have one run at a time that writes", "in use", remedy) from error
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise _linked(folder / LOCK) from error
        raise FileError(folder, error) from error
    return lock


def check_no_links(folder: Path) -> None:
    """Refuse a folder with symbolic links, through which files elsewhere would be written.

    Raises
    ------
    InvalidInput
        If the folder is a link, or holds one.
    """
    inside = (Path(place) / name for place, folders, files in os.walk(folder) for name in (*folders, *files))
    for path in (folder, *inside):
        if path.is_symlink():
            raise _linked(path)


def _linked(path: Path) -> InvalidInput:
    remedy = "What is written there would go elsewhere. Put what it leads to in its place."
    return InvalidInput(str(path), "must be a file or folder of its own to be written to", "a link", remedy)
