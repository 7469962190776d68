"""Locks of folders: a folder has one writer at a time, and links to other places are refused."""

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
"""Name of the folder for files of the writing process: the lock, and the states from which a run is resumed."""
LOCK = f"{WRITER}/.lock"
"""Lock file of a folder. It is never removed; the lock ends with the process that owns it."""


def locked(folder: Path) -> BaseFileLock:
    """Lock a folder, which is created if it is missing; ``release()`` of the result unlocks it.

    Raises
    ------
    InvalidInput
        Another run writes to the folder, or the lock file is a link.
    FileError
        The folder cannot be written to.
    """
    # imported on use: most runs write no folder
    from filelock import FileLock, Timeout

    # another thread than the one that acquired the lock may release it
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
        The folder is a link, or contains a link.
    """
    inside = (Path(place) / name for place, folders, files in os.walk(folder) for name in (*folders, *files))
    for path in (folder, *inside):
        if path.is_symlink():
            raise _linked(path)


def _linked(path: Path) -> InvalidInput:
    remedy = "What is written there would go elsewhere. Put what it leads to in its place."
    return InvalidInput(str(path), "must be a file or folder of its own to be written to", "a link", remedy)
