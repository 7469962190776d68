"""The optional packages of studies: looked for before anything runs, imported where they are used."""

from __future__ import annotations

import importlib.util
from importlib.metadata import version

from nonsmooth.errors import MissingPackagesError

_REMEDY = 'pip install "nonsmooth[studies]"'
_OLDEST = (3, 1, 3)
"""The first version of zarr that renames a file when it is whole."""


def require(what: str, *packages: str) -> None:
    """Look whether packages are installed, without importing them.

    Raises
    ------
    MissingPackagesError
        If one is not.
    """
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingPackagesError(f"{what} needs {', '.join(missing)}: {_REMEDY}")


def require_store() -> None:
    """Look whether what writes studies is installed.

    Raises
    ------
    MissingPackagesError
        If it is not, or too old.
    """
    require("a study", "xarray", "zarr")
    found = version("zarr")
    if tuple(int(part) for part in found.split(".")[:3] if part.isdigit()) < _OLDEST:
        oldest = ".".join(map(str, _OLDEST))
        raise MissingPackagesError(f"a study needs zarr {oldest} or newer, not {found}: {_REMEDY}")
