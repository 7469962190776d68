"""The optional packages that pictures need."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable

from nonsmooth.errors import MissingPackagesError

PICTURES = ("matplotlib",)


def require(packages: Iterable[str]) -> None:
    """Raise MissingPackagesError unless all are installed; imports none of them."""
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingPackagesError(f'--out needs {", ".join(missing)}: pip install "nonsmooth[full]"')
