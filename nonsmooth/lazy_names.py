"""Names of a package that are imported on first use, so that a program imports only the modules that it needs."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

_IMPORT = re.compile(r"^from (\S+) import (\w+) as \2$", re.MULTILINE)

Names: TypeAlias = tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]


def lazy_names(package: str, file: str) -> Names:
    """Functions ``__getattr__`` and ``__dir__`` of a package, and its ``__all__``, from the imports of its stub.

    The stub is the file ``__init__.pyi`` next to ``__init__.py``, with a line ``from module import Name as Name`` for
    each name. Editors and type checkers read the stub instead of the package.

    Parameters
    ----------
    package : str
        ``__name__`` of the package.
    file : str
        ``__file__`` of the package.

    Returns
    -------
    tuple
        The two functions, and the names in order.
    """
    modules = {name: module for module, name in _IMPORT.findall(Path(file).with_suffix(".pyi").read_text("utf-8"))}

    def get(name: str) -> Any:
        """Import a name from its module, and set it as an attribute, so that Python calls this function once a name."""
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
        module = modules[name]
        # the stub file (.pyi) may also list submodules of the package: the name is then the submodule itself
        if module in (package, "."):
            return importlib.import_module(f"{package}.{name}")
        value = getattr(importlib.import_module(module, package), name)
        setattr(sys.modules[package], name, value)
        return value

    def directory() -> list[str]:
        """Public names and names such as ``__file__``, for completion in an editor, without helpers."""
        return sorted({*modules, *(name for name in vars(sys.modules[package]) if re.fullmatch(r"__\w+__", name))})

    return get, directory, sorted(modules)
