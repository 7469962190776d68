"""Checks that new results replace nothing but a finished run, before the folder is emptied."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from nonsmooth.errors import InvalidInput
from nonsmooth.results.description import UNFINISHED
from nonsmooth.results.output import Output
from nonsmooth.storage.array_folder import ArrayFolder, is_marked
from nonsmooth.storage.files import writing
from nonsmooth.storage.lock import WRITER


def arrays_of_run(path: Path) -> ArrayFolder:
    """Open the arrays of a run. Raises the errors of :meth:`nonsmooth.storage.array_folder.ArrayFolder.opened`."""
    return ArrayFolder.opened(path, "must be a folder of results", "Name a folder that `run` wrote.")


def _status(path: Path) -> str | None:
    """Status of the run in a folder of arrays, None if no run can be opened there."""
    try:
        return str(arrays_of_run(path).attributes.get("status"))
    except InvalidInput:
        return None


def check_free(output: Output) -> None:
    """Raise InvalidInput if a folder has a run that is under way or can be resumed; new results would replace it."""
    if _status(output.solution) == UNFINISHED:
        raise InvalidInput(
            str(output.folder),
            "must not hold a run that is under way or was cut off",
            UNFINISHED,
            f"`nonsmooth resume {output.folder}` continues it; remove {output.solution} to give it up.",
        )


def check_replaceable(output: Output) -> None:
    """Raise InvalidInput if the output folder has a run that must not be replaced.

    Such a run is under way, or can be resumed, or has ended while ``output.overwrite`` is False.
    """
    check_free(output)
    if not output.overwrite and _status(output.solution) is not None:
        rule, remedy = "must be a folder that is empty or new", "Another run has ended there meanwhile: name another."
        raise InvalidInput(str(output.folder), rule, "a folder with results", remedy)


def check_ours(path: Path) -> None:
    """Check that a folder of arrays is new, empty or made by a run, so that it may be emptied.

    Raises
    ------
    InvalidInput
        The path is a link or a file, or the folder has other content.
    FileError
        The folder cannot be read.
    """
    if path.is_symlink() or (path.exists() and not path.is_dir()):
        what = "a link" if path.is_symlink() else "a file"
        raise InvalidInput(str(path), "must be a folder that a run has made", what, "Name another folder.")
    with writing(path):
        names = sorted(one.name for one in path.iterdir()) if path.exists() else []
    # a folder of arrays that a run has just made has no mark yet; it is empty or contains only the folder of the lock
    if names not in ([], [WRITER]) and not is_marked(path):
        raise InvalidInput(
            str(path),
            "must be a folder that a run has made, as it would be emptied",
            f"a folder with {', '.join(map(repr, names[:3]))}",
            "Name another folder.",
        )


def empty(path: Path, states: Iterable[str]) -> None:
    """Empty a folder of arrays, except for the lock and for the mark that a run made the folder.

    ``states`` are the paths of state files next to the lock, which are removed, too.

    The metadata are removed first, because without them no reader takes the rest for a solution.

    Raises
    ------
    FileError
        A file cannot be removed.
    """
    with writing(path):
        (path / "zarr.json").unlink(missing_ok=True)
        for one in path.iterdir():
            if one.name == WRITER:
                continue
            if one.is_dir() and not one.is_symlink():
                shutil.rmtree(one)
            else:
                one.unlink()
        for name in states:
            (path / name).unlink(missing_ok=True)
