"""StudyFolder: a study on disk, and the dataset of a stored study.

The folder has an array over the runs for each record.  Runs are stored in chunks, by one process at a time.  The
records of a chunk and the messages of its runs without records are written first, the status last.  A chunk with a
status is complete; a chunk without it is computed again (:mod:`nonsmooth.storage.array_folder`).
"""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import path_of
from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import LabelledArray
from nonsmooth.storage.array_folder import ArrayFolder
from nonsmooth.storage.chunks import TEXT, ArrayLayout
from nonsmooth.storage.files import writing
from nonsmooth.storage.lock import LOCK, WRITER, check_no_links, locked
from nonsmooth.studies.case import CaseFactory
from nonsmooth.studies.inputs import require
from nonsmooth.studies.records import StudyRecord
from nonsmooth.studies.sampling import Sampling
from nonsmooth.studies.status import UNKNOWN, CaseStatus, reason_attributes
from nonsmooth.studies.work import ChunkResult

if TYPE_CHECKING:
    import xarray

_STATUS, _FAILURE = "status", "failure"
"""Names of the arrays of the status, and of the messages of runs without records."""


@final
class StudyFolder:
    """The folder of a study.

    Parameters
    ----------
    path : Path
        The folder.

    Raises
    ------
    InvalidInput
        If the folder holds no study, another version wrote it, or it is damaged.
    """

    def __init__(self, path: Path) -> None:
        rule, remedy = "must hold a study", "Name what `sweep --out` or Study.run was given."
        self.path, self._arrays = path, ArrayFolder.opened(path, rule, remedy)
        if "spec" not in self.attributes:
            raise InvalidInput(str(path), rule, "other arrays", remedy)
        gone = [name for name in self.variables if not (path / name).is_dir()]
        if gone:
            remedy = "Put back what was removed, or begin anew in another folder."
            raise InvalidInput(str(path), "must have all of its arrays", f"without {', '.join(gone)}", remedy)
        self.n_runs, self.chunk = (int(n) for n in (self.layout(_STATUS).shape[0], self.layout(_STATUS).chunk))

    @classmethod
    def create(
        cls,
        path: Path,
        records: Sequence[StudyRecord],
        sampling: Sampling,
        cases: CaseFactory,
        chunk: int,
        attributes: Mapping[str, Any],
    ) -> None:
        """Make the folder of a new study; its metadata are written last and mark it as a study.

        If another process has made the study in the meantime, nothing changes.

        Parameters
        ----------
        path : Path
            The folder.
        records : sequence of StudyRecord
            The records of each run.
        sampling, cases : Sampling, CaseFactory
            The parameters of the runs, with their units and descriptions.
        chunk : int
            Number of runs whose results are written together.
        attributes : mapping
            Attributes of the study; the names of its arrays are added.

        Raises
        ------
        InvalidInput
            If the folder has other files.
        FileError
            If the folder cannot be written to.
        """
        if path.exists() and (not path.is_dir() or (any(path.iterdir()) and not (path / LOCK).exists())):
            raise InvalidInput(str(path), "must be a new or empty folder", "something else", "Choose another name.")
        check_no_links(path)
        with _locked(path):
            if is_study(path):
                return
            _clear(path)
            variables, n = _variables(records, len(sampling), chunk), len(sampling)
            parts = {"parameters": list(sampling.columns), "dims": dict(sampling.dims), "variables": list(variables)}
            arrays = ArrayFolder(path, {**attributes, "layout": json.dumps(parts)})
            arrays.mark()
            for name, layout in variables.items():
                arrays.declare(name, layout)
            messages = {"long_name": "why a run has no records"}
            arrays.declare(_FAILURE, ArrayLayout(("run",), TEXT, (n,), chunk, "", messages))
            for one in _coordinates(records, sampling, cases):
                arrays.add(one.name, one.dimensions, one.values, one.attributes, grows=False)
            arrays.spell_out(arrays.names)
            arrays.commit(safely=True)

    @property
    def attributes(self) -> Mapping[str, Any]:
        """Attributes of the study by name, all texts: "title", "spec", "sha256", "provenance", "request", "layout"."""
        return self._arrays.attributes

    @property
    def parts(self) -> dict[str, Any]:
        """Names of the parameters and of the records, and the sizes of the grid."""
        return dict(json.loads(str(self.attributes["layout"])))

    @property
    def variables(self) -> list[str]:
        """Names of the records, the status and the reason."""
        return list(self.parts["variables"])

    @property
    def coordinates(self) -> set[str]:
        """Names of the parameters, and of the axes of records."""
        return self._arrays.names - {*self.variables, _FAILURE}

    @property
    def n_chunks(self) -> int:
        """Number of chunks, the groups of runs whose results are written together."""
        return -(-self.n_runs // self.chunk)

    def layout(self, name: str) -> ArrayLayout:
        """Layout of an array."""
        return self._arrays.layout(name)

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the lock of the folder, so that no other process writes.

        Raises
        ------
        InvalidInput
            If another process writes there, or the folder has a symbolic link.
        """
        check_no_links(self.path)
        with _locked(self.path):
            yield

    def note(self, attributes: Mapping[str, Any]) -> None:
        """Add attributes to the study, and write them.

        Raises
        ------
        FileError
            If they cannot be written.
        """
        self._arrays.attributes.update(attributes)
        self._arrays.commit(safely=True)

    def committed(self) -> list[int]:
        """Return the numbers of the complete chunks."""
        names = (file.name.removeprefix("c.") for file in (self.path / _STATUS).glob("c.*"))
        return sorted(int(name) for name in names if name.isdigit())

    def write(self, block: ChunkResult) -> None:
        """Write the result of a chunk, and commit it.

        Raises
        ------
        FileError
            If the chunk cannot be written; it is not committed then.
        """
        first, n = block.chunk.first, len(block.chunk.parameters)
        for name, values in block.arrays.items():
            if name != _STATUS:
                self._arrays.write(name, first, values)
        self._arrays.write(_FAILURE, first, np.array([block.texts.get(first + i, "") for i in range(n)], object))
        self._arrays.flush(safely=True)
        self._arrays.write(_STATUS, first, block.arrays[_STATUS])
        self._arrays.flush(safely=True, counts=True)

    def read(self, name: str) -> NDArray[Any]:
        """Return an array by its name; runs without a result have its fill value.

        Raises
        ------
        InvalidInput
            If a chunk is damaged.
        """
        layout = self.layout(name)
        if name in self.coordinates:
            values = self._arrays.read(name)
            return values.astype(str) if layout.dtype == TEXT else values
        chunks = [layout.blank()] * self.n_chunks
        for number in self.committed():
            chunks[number] = self._arrays.chunk(name, number)
        return np.concatenate(chunks)[: self.n_runs]

    def texts(self) -> dict[int, str]:
        """Return the messages of runs without records, by the number of the run."""
        return {run: str(text) for run, text in enumerate(self.read(_FAILURE)) if text}

    def damage(self) -> list[str]:
        """Read all complete chunks, and return one message for each array of a chunk that cannot be read."""
        found = []
        for number in self.committed():
            for name in (*self.variables, _FAILURE):
                try:
                    self._arrays.chunk(name, number)
                except InvalidInput as error:
                    found.append(str(error))
        return found


def is_study(path: Path) -> bool:
    """True if the folder holds metadata of stored arrays ("zarr.json"), which mark a study that has begun.

    A folder of another program may hold this file, too.  Opening such a folder as a study raises InvalidInput.
    """
    return (path / "zarr.json").exists()


def open_study(path: Path | str) -> xarray.Dataset:
    """Open a study, finished or not.

    Parameters
    ----------
    path : Path or str
        Folder of the study.

    Returns
    -------
    xarray.Dataset
        The records, over the axes of a grid, otherwise over ``run`` with the parameters as coordinates.  Runs without
        records have NaN, or -1 in place of a count or a word; ``status`` and ``reason`` give the cause.

    Raises
    ------
    InvalidInput
        If the folder holds no study, another version wrote it, or it is damaged.
    """
    import xarray

    require("a study", "xarray")
    folder = StudyFolder(path_of("study", path))

    def read(name: str) -> tuple[tuple[str, ...], Any, dict[str, Any]]:
        layout = folder.layout(name)
        return layout.dimensions, folder.read(name), dict(layout.attributes)

    variables, coordinates = ({name: read(name) for name in names} for names in (folder.variables, folder.coordinates))
    flat, dims = xarray.Dataset(variables, coordinates, dict(folder.attributes)), folder.parts["dims"]
    return _on_grid(flat, dims) if dims else flat


def _on_grid(flat: xarray.Dataset, dims: dict[str, int]) -> xarray.Dataset:
    import xarray

    sizes = tuple(dims.values())
    variables: dict[str, Any] = {}
    for name, one in flat.data_vars.items():
        if "run" in one.dims:
            values = one.values.reshape(sizes + one.shape[1:])
            variables[str(name)] = ((*dims, *one.dims[1:]), values, one.attrs)
    coordinates: dict[str, Any] = {str(name): one for name, one in flat.coords.items() if "run" not in one.dims}
    for place, name in enumerate(dims):
        at = tuple(slice(None) if i == place else 0 for i in range(len(sizes)))
        coordinates[name] = (name, flat[name].values.reshape(sizes)[at], flat[name].attrs)
    return xarray.Dataset(variables, coordinates, flat.attrs)


def _classes(words: Sequence[str]) -> dict[str, Any]:
    """Return CF attributes for a record of words: the stored number of each word, and the words in this order."""
    return {"flag_values": list(range(len(words))), "flag_meanings": " ".join(word.replace(" ", "_") for word in words)}


def _variables(records: Sequence[StudyRecord], n_runs: int, chunk: int) -> dict[str, ArrayLayout]:
    """Arrays of the records, of the reason and of the status, over the runs."""
    found = {}
    for one in records:
        attributes = {**one.attributes, **(_classes(one.words) if one.words else {})}
        shape = (n_runs, *map(len, one.axes.values()))
        found[one.name] = ArrayLayout(
            ("run", *one.axes), np.dtype(one.dtype).name, shape, chunk, np.array(one.none, one.dtype).item(), attributes
        )
    ended = {"long_name": "how it ended", **_classes(list(CaseStatus))}
    found["reason"] = ArrayLayout(("run",), "int8", (n_runs,), chunk, UNKNOWN, reason_attributes())
    return found | {"status": ArrayLayout(("run",), "int8", (n_runs,), chunk, CaseStatus.NOT_RUN.code, ended)}


def _coordinates(records: Sequence[StudyRecord], sampling: Sampling, cases: CaseFactory) -> list[LabelledArray]:
    """Values of the parameters for each run, and the labels along each further axis of the records, such as times."""
    found = {
        name: LabelledArray(name, ("run",), values, cases.attributes(name)) for name, values in sampling.columns.items()
    }
    for one in records:
        for axis, labels in one.axes.items():
            attributes = {"units": "s", "long_name": "time"} if axis == "time" else {"long_name": axis}
            found[axis] = LabelledArray(axis, (axis,), np.asarray(labels), attributes)
    return list(found.values())


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    lock = locked(path)
    try:
        yield
    finally:
        lock.release()


def _clear(path: Path) -> None:
    """Remove all files of a study that was interrupted before its metadata were written, except the lock."""
    with writing(path):
        for entry in path.iterdir():
            if entry.name != WRITER:
                shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
