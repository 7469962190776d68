"""``nonsmooth save``: where the file goes, and that none is lost."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

Call = Callable[..., tuple[int, str, str]]


def test_a_file_is_not_overwritten_unasked(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "new" / "tiny.toml"
    assert call("save", "tiny", str(path))[0] == 0
    before = path.read_text()
    status, _, errors = call("save", "tiny", str(path), "--set", "radius=0.02")
    assert status == 2
    assert f"error: {path} must be a new file, but it is 'there already'. Choose another name, or add --ov" in errors
    assert path.read_text() == before
    assert call("save", "tiny", str(path), "--set", "radius=0.02", "--overwrite")[0] == 0
    assert path.read_text() != before


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ("file/tiny.toml", "must be in a folder that can be written to"),
        ("folder.toml", "must be a file, but it is 'a folder'"),
        ("tiny.json", "must end in .toml, .yaml, .yml"),
    ],
)
@pytest.mark.parametrize("more", [(), ("--overwrite",)])
def test_a_file_that_cannot_be_written_is_a_wrong_request(
    call: Call, tmp_path: Path, where: str, told: str, more: tuple[str, ...]
) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "folder.toml").mkdir()
    status, output, errors = call("save", "tiny", str(tmp_path / where), *more)
    assert (status, output) == (2, "")
    assert str(tmp_path / where) in errors
    assert told in errors
    assert errors.count("\n") == 1
