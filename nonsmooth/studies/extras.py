"""The optional packages of studies: looked for before anything runs, imported where they are used."""

from __future__ import annotations

import importlib.util

from nonsmooth.errors import MissingPackagesError

_REMEDY = 'pip install "nonsmooth[studies]"'


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
        If it is not.
    """
    require("a study", "xarray")
