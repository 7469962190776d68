"""A study on disk: an array per record over the runs, in the Zarr format; the file of a chunk's status commits it.

One process writes.  Of a chunk the records come first, then the sentences on runs without records, last the status:
each file gets its name when it is whole, so that what has a status is complete, and what has none is written anew.
"""

from __future__ import annotations

import contextlib
import json
import shutil
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.results.lock import Lock, check_no_links
from nonsmooth.solution.files import FileError, content_of, replacing
from nonsmooth.studies.work import ChunkResult

_JOURNAL, _LOCK = "failures", ".lock"
"""Group of the sentences, of no array; the lock is there as well."""
_STATUS = "status"


@final
@dataclass(frozen=True)
class Variable:
    """An array of a store.

    Attributes
    ----------
    name : str
        Its name.
    axes : mapping
        Of each axis behind that of the runs its name and length.
    dtype : str
        Of its numbers.
    fill : float
        What stands where nothing was computed.
    attributes : mapping
        What is said of it.
    """

    name: str
    dtype: str
    fill: float
    attributes: Mapping[str, Any]
    axes: Mapping[str, int] = field(default_factory=dict)


@final
@dataclass(frozen=True, eq=False)
class Coordinate:
    """Values along dimensions: of a parameter over the runs, or of an axis.

    Attributes
    ----------
    dimensions : tuple of str
        Names of the dimensions.
    values : array
        The values.
    attributes : mapping
        What is said of them.
    """

    dimensions: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, Any]


@final
class Store:
    """The folder of a study.

    Parameters
    ----------
    path : Path
        The folder.

    Raises
    ------
    InvalidInput
        If it holds no study, or not all of one.
    """

    def __init__(self, path: Path) -> None:
        import zarr

        # the file of a chunk says that it was done, also where all of it is what stands for nothing
        with zarr.config.set({"array.write_empty_chunks": True}):
            self.path, self._group = path, _opened(path)
            self._arrays: dict[str, Any] = dict(self._group.arrays())
        gone = [name for name in json.loads(self._group.attrs["layout"])["variables"] if name not in self._arrays]
        if gone:
            remedy = "Put back what was removed, or begin anew in another folder."
            raise InvalidInput(str(path), "must have all of its arrays", f"without {', '.join(gone)}", remedy)

    @property
    def attributes(self) -> Mapping[str, Any]:
        """What is said of the study."""
        return dict(self._group.attrs)

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self._arrays[_STATUS].shape[0])

    @property
    def chunk(self) -> int:
        """Runs in a chunk."""
        return int(self._arrays[_STATUS].chunks[0])

    @property
    def n_chunks(self) -> int:
        """Number of chunks."""
        return -(-self.n_runs // self.chunk)

    @classmethod
    def create(
        cls,
        path: Path,
        n_runs: int,
        chunk: int,
        variables: Sequence[Variable],
        coordinates: Mapping[str, Coordinate],
        attributes: Mapping[str, Any],
    ) -> None:
        """Make the folder of a study that begins; it is one when its attributes are there, which come last.

        One that another process has made meanwhile stays as it is.

        Raises
        ------
        InvalidInput
            If something else is there.
        FileError
            If it cannot be written.
        """
        import zarr
        from zarr.codecs import Crc32cCodec, ZstdCodec

        if path.exists() and (not path.is_dir() or (any(path.iterdir()) and not (path / _JOURNAL / _LOCK).exists())):
            raise InvalidInput(str(path), "must be a new or empty folder", "something else", "Choose another name.")
        check_no_links(path)
        with _locked(path), _telling(path):
            if is_study(path):
                return
            _clear(path)
            codecs = (ZstdCodec(), Crc32cCodec())
            group = zarr.create_group(str(path), zarr_format=3, overwrite=False)
            group.create_group(_JOURNAL)
            for one in variables:
                group.create_array(
                    one.name,
                    shape=(n_runs, *one.axes.values()),
                    chunks=(chunk, *one.axes.values()),
                    dtype=one.dtype,
                    fill_value=one.fill,
                    compressors=codecs,
                    dimension_names=("run", *one.axes),
                    attributes=dict(one.attributes),
                    config={"write_empty_chunks": True},
                )
            for name, along in coordinates.items():
                told, over = dict(along.attributes), along.dimensions
                group.create_array(name, data=along.values, compressors=codecs, dimension_names=over, attributes=told)
            group.attrs.update(dict(attributes))

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the lock, with what a writer left half done swept away.

        Raises
        ------
        InvalidInput
            If another process writes there, or it holds a link.
        """
        check_no_links(self.path)
        with _locked(self.path):
            with _telling(self.path):
                for part in self.path.rglob("*.partial"):
                    part.unlink()
            yield

    def note(self, attributes: Mapping[str, Any]) -> None:
        """Say something more of the study.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        with _telling(self.path):
            self._group.attrs.update(dict(attributes))

    def committed(self) -> list[int]:
        """Return the numbers of the chunks that are done."""
        folder = self.path / _STATUS / "c"
        return sorted(int(file.name) for file in folder.iterdir() if file.name.isdigit()) if folder.is_dir() else []

    def write(self, block: ChunkResult) -> None:
        """Commit a chunk.

        Raises
        ------
        FileError
            If it cannot be written; it is not committed then.
        """
        first, n = block.chunk.first, len(block.chunk.parameters)
        with _telling(self.path):
            for name, values in block.arrays.items():
                if name != _STATUS:
                    self._arrays[name][first : first + n] = values
            with replacing(self._texts(block.chunk.number)) as part:
                part.write_text(json.dumps(block.texts), encoding="utf-8")
            self._arrays[_STATUS][first : first + n] = block.arrays[_STATUS]

    def finish(self) -> None:
        """Gather what is said of all arrays in one file, for those who open it.

        Raises
        ------
        FileError
            If that cannot be written.
        """
        import zarr

        with _telling(self.path), warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # that other programs may not read that file
            zarr.consolidate_metadata(str(self.path), zarr_format=3)

    def read(self, name: str) -> NDArray[Any]:
        """Return an array."""
        return np.asarray(self._arrays[name][...])

    def texts(self) -> dict[int, str]:
        """Return of all runs without records the sentence that says why."""
        found: dict[int, str] = {}
        for number in self.committed():
            said = json.loads(content_of(self._texts(number)))
            found |= {int(run): text for run, text in said.items()}
        return found

    def damage(self) -> list[str]:
        """Read all chunks that are committed; return a sentence on each that is not whole."""
        found = []
        names = [name for name, array in self._arrays.items() if array.metadata.dimension_names[:1] == ("run",)]
        for number in self.committed():
            for name in names:
                if sentence := self._damage(name, number):
                    found.append(sentence)
            try:
                json.loads(content_of(self._texts(number)))
            except (OSError, ValueError) as error:
                found.append(f"{self._texts(number)}: {error}")
        return found

    def _damage(self, name: str, number: int) -> str:
        array, first = self._arrays[name], number * self.chunk
        place = first // array.chunks[0], *(0 for _ in array.shape[1:])
        part = self.path.joinpath(name, "c", *map(str, place))
        if not part.exists():
            return f"{part} is not there"
        try:
            array[first : first + self.chunk]
        except Exception as error:  # whatever the decoders raise
            return f"{part} cannot be read: {error}"
        return ""

    def _texts(self, number: int) -> Path:
        return self.path / _JOURNAL / f"{number}.json"


def _opened(path: Path) -> Any:
    import zarr

    try:
        group = zarr.open_group(str(path), mode="r+", zarr_format=3, use_consolidated=False)
    except (FileNotFoundError, ValueError, OSError) as error:
        remedy = "Name what `sweep --out` or Study.run was given."
        raise InvalidInput(str(path), "must hold a study", f"{type(error).__name__}: {error}", remedy) from error
    if "spec" not in group.attrs:
        raise InvalidInput(str(path), "must hold a study", "other arrays", "Name what `sweep --out` was given.")
    return group


def is_study(path: Path) -> bool:
    """Tell whether a folder holds a study that has begun."""
    try:
        _opened(path)
    except InvalidInput:
        return False
    return True


@contextlib.contextmanager
def _telling(path: Path) -> Iterator[None]:
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise FileError(path, error) from error


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    lock = Lock(path / _JOURNAL)
    try:
        yield
    finally:
        lock.close()


def _clear(path: Path) -> None:
    """Remove what there is of a study that was cut off before it was one, but for the lock."""
    for entry in [*path.iterdir(), *(path / _JOURNAL).iterdir()]:
        if entry.name not in (_JOURNAL, _LOCK):
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
