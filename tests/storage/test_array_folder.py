"""Arrays on disk that grow: what is read back, by this package and by zarr."""

from __future__ import annotations

import errno
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import LabelledArray
from nonsmooth.storage import array_folder
from nonsmooth.storage.array_folder import FORMAT_VERSION, ArrayFolder
from nonsmooth.storage.chunks import ArrayLayout
from nonsmooth.storage.files import FileError
from tests.storage.forging import forge, opened


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(array_folder, "_ENTRIES", 12)


def _variables(values: np.ndarray) -> list[LabelledArray]:
    return [
        LabelledArray("x", ("time",), values[:, 0], {"units": "m"}),
        LabelledArray("y", ("time", "part"), values, {"units": "m/s"}),
        LabelledArray("code", ("time",), (values[:, 0] > 0.0).astype(np.uint8), {"units": "1"}),
    ]


def _add(folder: ArrayFolder, one: LabelledArray, *, grows: bool) -> None:
    folder.add(one.name, one.dimensions, one.values, one.attributes, grows=grows)


def test_rows_appended_in_any_portions_come_back(tmp_path: Path) -> None:
    import xarray
    import zarr

    draw = np.random.default_rng(1)
    values = draw.normal(size=(200, 5))
    folder = ArrayFolder(tmp_path / "a.zarr", {"title": "a"})
    _add(folder, LabelledArray("label", ("part",), np.array(["a", "bcd", "", "é", "f"]), {}), grows=False)
    _add(folder, LabelledArray("text", (), np.array("two\nlines"), {}), grows=False)
    for one in _variables(values[:0]):
        _add(folder, one, grows=True)
    n = 0
    while n < len(values):
        more = int(draw.integers(0, 30))
        for one in _variables(values[n : n + more]):
            folder.write(one.name, n, one.values)
        n = min(n + more, len(values))
        folder.commit(safely=False)
        if draw.random() < 0.3:  # another process goes on, from some rows before
            folder = opened(folder.path)
            n = max(0, n - int(draw.integers(0, 20)))
            folder.cut("time", n)
    folder.spell_out(folder.names)
    read = opened(folder.path)
    for one in _variables(values):
        np.testing.assert_array_equal(read.read(one.name), one.values)
    assert str(read.read("text")) == "two\nlines"
    np.testing.assert_array_equal(zarr.open_group(folder.path)["y"], values)
    np.testing.assert_array_equal(zarr.open_array(folder.path / "y"), values)
    for consolidated in (True, False):
        with xarray.open_zarr(folder.path, consolidated=consolidated) as data:
            np.testing.assert_array_equal(data["y"], values)
            assert data["label"].values.tolist() == ["a", "bcd", "", "é", "f"]
            assert data["y"].attrs == {"units": "m/s"}
            assert data["code"].dtype == np.uint8


def test_what_is_not_committed_does_not_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.arange(60.0).reshape(12, 5)
    folder = ArrayFolder(tmp_path / "a.zarr", {})
    for one in _variables(values[:5]):
        _add(folder, one, grows=True)
    folder.commit(safely=True)
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
    folder.write("y", 5, y.values)
    with pytest.raises(FileError, match=r"y/c\.3\.0 could not be written: No space left on device"):
        folder.commit(safely=True)
    assert {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()} == files


CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "a name outside": lambda arrays: arrays.update({"../x": arrays.pop("x")}),
    "no attributes": lambda arrays: arrays["x"].pop("attributes"),
    "objects": lambda arrays: arrays["x"].update(data_type="object"),
    "a negative length": lambda arrays: arrays["x"].update(shape=[-1]),
    "a chunk without rows": lambda arrays: arrays["x"]["chunk_grid"]["configuration"].update(chunk_shape=[0]),
    "other codecs": lambda arrays: arrays["x"]["codecs"].pop(),
    "no entry": lambda arrays: arrays.update(x=5),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_folder_of_another_form_is_refused(tmp_path: Path, change: str) -> None:
    folder = ArrayFolder(tmp_path / "a.zarr", {})
    for one in _variables(np.zeros((12, 5))):
        _add(folder, one, grows=True)
    folder.commit(safely=False)
    forge(folder.path, lambda content: CHANGES[change](content["consolidated_metadata"]["metadata"]))
    with pytest.raises(InvalidInput, match=r"zarr\.json must be as it was written|must have a name of letters"):
        opened(folder.path)


def test_other_versions_are_refused_by_name(tmp_path: Path) -> None:
    """Folders of nonsmooth 0.1 have none: those of runs are of another format, those of studies lack it."""
    folder = ArrayFolder(tmp_path / "a.zarr", {"title": "a"})
    folder.commit(safely=False)
    forge(folder.path, lambda content: content["attributes"].update(format_version=FORMAT_VERSION + 1))
    with pytest.raises(InvalidInput, match=r"must have format version 2, .*of a newer nonsmooth'\. Install that one"):
        opened(folder.path)
    content = {"zarr_format": 3, "node_type": "group", "attributes": {"spec": "{}"}}
    (folder.path / "zarr.json").write_text(json.dumps(content))
    with pytest.raises(InvalidInput, match=r"as nonsmooth 0\.1 wrote it'\. Open it with that version, or run again"):
        opened(folder.path)
    (folder.path / "zarr.json").rename(folder.path / ".zmetadata")
    with pytest.raises(InvalidInput, match=r"as nonsmooth 0\.1 wrote it'\. Open it with that version, or run again"):
        opened(folder.path)


def test_few_bytes_do_not_become_all_of_the_memory(tmp_path: Path) -> None:
    """A chunk with a right checksum that unpacks to more, or is shorter than it says, is refused before it is."""
    small, large = (ArrayLayout(("x",), "float64", (n,), n, 0.0, {}) for n in (10, 2**24))
    content = large.encoded(large.blank())
    for wrong in (content, _with_checksum(content[:-5])):
        with pytest.raises(ValueError, match=r"it has \d+ bytes packed to \d+, and not"):
            (small if wrong is content else large).decoded(wrong)


def _with_checksum(content: bytes) -> bytes:
    import google_crc32c

    return content + int(google_crc32c.value(content)).to_bytes(4, "little")
