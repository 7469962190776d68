"""One process at a time writes to a folder."""

from __future__ import annotations

import os
import sys
import weakref
from pathlib import Path
from typing import final

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.files import FileError

if sys.platform != "win32":
    import fcntl

LOCK = ".lock"
"""Name of the file by which a folder is held; it stays there."""


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
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT)
        except OSError as error:
            raise FileError(folder, error) from error
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

    def close(self) -> None:
        """Give it back."""
        self._close()
