"""Places that a command writes to, checked before it starts so that nothing is lost."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from nonsmooth.cli.parse.options import flag
from nonsmooth.errors import InvalidInput, MissingPackagesError
from nonsmooth.storage import files

OVERWRITE = flag("--overwrite", "write there even if something is there already")
_REMEDY = f"Choose another name, or add {OVERWRITE.name}."


def require_matplotlib() -> None:
    """Raise MissingPackagesError unless matplotlib is installed; it is not imported."""
    if importlib.util.find_spec("matplotlib") is None:
        raise MissingPackagesError('--out needs matplotlib: pip install "nonsmooth[full]"')


def prepare_folder(folder: Path, overwrite: bool, remedy: str = _REMEDY) -> None:
    """Create a folder; InvalidInput if that is impossible, or files are in it that must not be overwritten."""
    if not overwrite and folder.is_dir() and any(folder.iterdir()):
        raise InvalidInput(str(folder), "must be a folder that is empty or new", "a folder with files", remedy)
    files.prepare(folder)


def prepare_file(path: Path, overwrite: bool) -> None:
    """Create the folder of a file; InvalidInput if that is impossible, or the file must not be overwritten."""
    if path.is_dir():
        raise InvalidInput(str(path), "must be a file", "a folder", "Add the name of a file.")
    if not overwrite and path.exists():
        raise InvalidInput(str(path), "must be a new file", "there already", _REMEDY)
    try:
        files.prepare(path.parent)
    except InvalidInput as error:
        rule = "must be in a folder that can be written to"
        raise InvalidInput(str(path), rule, error.value, error.remedy) from error
