"""Arrays on disk that grow: what is read back, by this package and by zarr."""

from __future__ import annotations

import errno
from pathlib import Path

import numpy as np
import pytest

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import LabelledArray
from nonsmooth.results import zarr_folder
from nonsmooth.results.zarr_folder import ZarrFolder
from nonsmooth.solution.files import FileError


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zarr_folder, "_ENTRIES", 12)


def _variables(values: np.ndarray) -> list[LabelledArray]:
    return [
        LabelledArray("x", ("time",), values[:, 0], {"units": "m"}),
        LabelledArray("y", ("time", "part"), values, {"units": "m/s"}),
        LabelledArray("code", ("time",), (values[:, 0] > 0.0).astype(np.uint8), {"units": "1"}),
    ]


def test_rows_appended_in_any_portions_come_back(tmp_path: Path) -> None:
    import xarray

    draw = np.random.default_rng(1)
    values = draw.normal(size=(200, 5))
    folder = ZarrFolder(tmp_path / "a.zarr", {"title": "a"})
    folder.add(LabelledArray("label", ("part",), np.array(["a", "bcd", "", "é", "f"]), {}), grows=False)
    folder.add(LabelledArray("text", (), np.array("two\nlines"), {}), grows=False)
    for one in _variables(values[:0]):
        folder.add(one, grows=True)
    n = 0
    while n < len(values):
        more = int(draw.integers(0, 30))
        for one in _variables(values[n : n + more]):
            folder.write(one.name, n, one.values)
        n = min(n + more, len(values))
        folder.commit()
        if draw.random() < 0.3:  # another process goes on, from some rows before
            folder = ZarrFolder.opened(folder.path)
            n = max(0, n - int(draw.integers(0, 20)))
            folder.cut("time", n)
    folder.spell_out(folder.names)
    read = ZarrFolder.opened(folder.path)
    for one in _variables(values):
        np.testing.assert_array_equal(read.read(one.name), one.values)
    assert str(read.read("text")) == "two\nlines"
    for consolidated in (True, False):
        with xarray.open_zarr(folder.path, consolidated=consolidated) as data:
            np.testing.assert_array_equal(data["y"], values)
            assert data["label"].values.tolist() == ["a", "bcd", "", "é", "f"]
            assert data["y"].attrs == {"units": "m/s"}
            assert data["code"].dtype == np.uint8


def test_what_is_not_committed_does_not_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.arange(60.0).reshape(12, 5)
    folder = ZarrFolder(tmp_path / "a.zarr", {})
    for one in _variables(values[:5]):
        folder.add(one, grows=True)
    folder.commit_safely()
    files = {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()}
    write, left = Path.write_bytes, [2]

    def full(path: Path, content: bytes) -> int:
        left[0] -= 1
        if left[0] < 0:
            write(path, content[: len(content) // 2])
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    x, y, _ = _variables(values[5:])
    folder.write("x", 5, x.values)
    with pytest.raises(FileError, match=r"y/3\.0 could not be written: No space left on device"):
        folder.write("y", 5, y.values)
    assert {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()} == files


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"x/.zarray"', '"../x/.zarray"'),
        ('"x/.zattrs"', '"no/.zattrs"'),
        ('"<f8"', '"|O"'),
        ('"shape": [12]', '"shape": [-1]'),
        ('"metadata"', '"other"'),
    ],
)
def test_a_folder_of_another_form_is_refused(tmp_path: Path, old: str, new: str) -> None:
    folder = ZarrFolder(tmp_path / "a.zarr", {})
    for one in _variables(np.zeros((12, 5))):
        folder.add(one, grows=True)
    folder.commit()
    path = folder.path / ".zmetadata"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InvalidInput, match="must be a folder of results"):
        ZarrFolder.opened(folder.path)
