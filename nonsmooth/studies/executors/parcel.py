"""Parcel: what another process is to do, with the files whose classes it needs."""

from __future__ import annotations

import hashlib
import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import final

from nonsmooth.errors import InvalidInput
from nonsmooth.plugins import file
from nonsmooth.studies.work import Work


@final
@dataclass(frozen=True)
class Parcel:
    """Work on its way to a process that has imported nothing of it yet.

    What cannot be opened is an error of the task: objects that arrive open would cut the worker's connection.

    Attributes
    ----------
    content : bytes
        The work, pickled.
    files : tuple of tuple of str
        Path and sha256 of the files that were loaded as FILE.py:CLASS.
    """

    content: bytes
    files: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, work: Work) -> Parcel:
        """Pack work."""
        import cloudpickle

        return cls(cloudpickle.dumps(work), tuple((str(path), _digest(path)) for path in file.loaded()))

    def open(self) -> Work:
        """Return the work.

        Raises
        ------
        InvalidInput
            If a file is not there, or is another one.
        ImportError
            If a module is not installed.
        """
        for name, digest in self.files:
            path = Path(name)
            if not path.is_file() or _digest(path) != digest:
                remedy = "Start workers where they see the same files."
                raise InvalidInput("worker", "must find the file that the study was begun with", name, remedy)
            file.again(path)
        work: Work = pickle.loads(self.content)
        return work

    def fault(self) -> str:
        """Return why it cannot be opened here, "" where it can."""
        try:
            self.open()
        except Exception as error:  # of the modules of a user, too
            return f"{type(error).__name__}: {error}"
        return ""


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
