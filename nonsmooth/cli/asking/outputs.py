"""Where a command writes: looked at before it starts, so that nothing is lost that was there or is computed."""

from __future__ import annotations

import argparse
from pathlib import Path

from nonsmooth.errors import InvalidInput
from nonsmooth.storage import files

OVERWRITE = "--overwrite"
_REMEDY = f"Choose another name, or add {OVERWRITE}."


def add_to(command: argparse.ArgumentParser) -> None:
    """Add the option to a command."""
    command.add_argument(OVERWRITE, action="store_true", help="write there even if something is there already")


def prepare_folder(folder: Path, overwrite: bool, remedy: str = _REMEDY) -> None:
    """Create a folder to write to.

    Raises
    ------
    InvalidInput
        If that is not possible, or files are in it that were not to be overwritten.
    """
    if not overwrite and folder.is_dir() and any(folder.iterdir()):
        raise InvalidInput(str(folder), "must be a folder that is empty or new", "a folder with files", remedy)
    files.prepare(folder)


def prepare_file(path: Path, overwrite: bool) -> None:
    """Create the folder of a file to write.

    Raises
    ------
    InvalidInput
        If that is not possible, or there is a file that was not to be overwritten, or a folder of that name.
    """
    if path.is_dir():
        raise InvalidInput(str(path), "must be a file", "a folder", "Add the name of a file.")
    if not overwrite and path.exists():
        raise InvalidInput(str(path), "must be a new file", "there already", _REMEDY)
    try:
        files.prepare(path.parent)
    except InvalidInput as error:
        rule = "must be in a folder that can be written to"
        raise InvalidInput(str(path), rule, error.value, error.remedy) from error
