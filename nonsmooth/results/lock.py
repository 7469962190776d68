"""One process at a time writes to a folder, and to nothing outside of it."""

from __future__ import annotations

import errno
import os
import sys
import weakref
from pathlib import Path
from typing import final

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.files import FileError, content_of

if sys.platform != "win32":
    import fcntl

    _NO_LINK = os.O_NOFOLLOW | os.O_NONBLOCK
else:
    _NO_LINK = 0

LOCK = ".lock"
"""Name of the file by which a folder is held; it stays there."""
_MARK = "nonsmooth"
"""Content of the lock of a folder that a run has made."""


@final
class Lock:
    """Held by whoever writes to a folder until it is closed, or until the process ends, however it ends.

    Where the system has no such locks, nothing is held.

    Parameters
    ----------
    folder : Path
        The folder.

    Raises
    ------
    InvalidInput
        If another one holds it.
    FileError
        If the folder cannot be written to.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | _NO_LINK)
        except OSError as error:
            if error.errno == errno.ELOOP:
                raise _linked(folder / LOCK) from error
            raise FileError(folder, error) from error
        self._file = file
        self._close = weakref.finalize(self, os.close, file)
        if sys.platform == "win32":
            return
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            self._close()
            remedy = "Wait for the run that writes there, or end it."
            raise InvalidInput(str(folder), "must have one run at a time that writes", "in use", remedy) from error
        except OSError:  # some folders of a network have none
            return

    def mark(self) -> None:
        """Note in the folder that it is one of ours, so that a later run may empty it.

        Raises
        ------
        FileError
            If that cannot be written.
        """
        try:
            os.pwrite(self._file, _MARK.encode(), 0)
        except OSError as error:
            raise FileError(self._folder, error) from error

    def close(self) -> None:
        """Give it back."""
        self._close()


def is_marked(folder: Path) -> bool:
    """Tell whether a run has marked a folder as its own."""
    try:
        return content_of(folder / LOCK) == _MARK.encode()
    except OSError:
        return False


def check_no_links(folder: Path) -> None:
    """Refuse a folder with symbolic links: what is written there would go elsewhere.

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
