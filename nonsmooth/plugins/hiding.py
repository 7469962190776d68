"""Files of the user that hide packages of nonsmooth, such as a laws.py in the working folder."""

from __future__ import annotations

import importlib.util
import warnings
from pathlib import Path

from nonsmooth.errors import NonsmoothWarning

_HOME = Path(__file__).resolve().parents[2]
_IMPORTED = ("bodies", "laws")
"""Packages that scripts import."""
BUILT_IN = (*_IMPORTED, "scenarios")
"""Packages that come with nonsmooth."""


class HiddenPackage(NonsmoothWarning):
    """A package that comes with nonsmooth and that a file of the user hides."""


def check_hidden() -> None:
    """Warn of files that hide packages that scripts import, because the failing import would not name the cause."""
    for message in hidden_packages(_IMPORTED):
        warnings.warn(message, HiddenPackage, stacklevel=3)


def hidden_packages(packages: tuple[str, ...] = BUILT_IN) -> list[str]:
    """A sentence for each file of the user that hides one of the packages."""
    found = {}
    for package in packages:
        try:
            spec = importlib.util.find_spec(package)
        except ValueError:
            # a program has created the module, without a specification
            continue
        if spec is not None and spec.origin is not None:
            found[package] = Path(spec.origin).resolve()
    return [
        f"The file {file} hides the package {package!r} that comes with nonsmooth: rename it."
        for package, file in found.items()
        if file.parent != _HOME / package
    ]
