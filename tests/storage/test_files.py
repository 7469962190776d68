"""Files are whole or not there."""

from __future__ import annotations

import errno
import stat
from pathlib import Path

import pytest

from nonsmooth.errors import InvalidInput
from nonsmooth.storage import files


def test_what_fails_leaves_the_old_file_and_no_other(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("old")

    def half() -> None:
        with files.replacing(path) as part:
            part.write_text("half")
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(files.FileError, match=f"{path} could not be written: No space left on device"):
        half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_prepare_makes_the_folder_and_leaves_nothing_in_it(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    files.prepare(folder)
    assert stat.S_ISDIR(folder.stat().st_mode)
    assert not list(folder.iterdir())


def test_prepare_refuses_what_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InvalidInput, match="must be a folder that can be written to"):
        files.prepare(tmp_path / "file" / "results")
    with pytest.raises(InvalidInput, match=r"file must be a folder .* 'It is a file'\. Name a folder"):
        files.prepare(tmp_path / "file")
