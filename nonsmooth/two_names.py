"""The packages bodies, laws and scenarios have two names each: ``nonsmooth.bodies`` and ``bodies`` are one module.

They are folders next to that of nonsmooth. Under its longer name a package is loaded from its folder by path, so that a
file ``bodies.py`` or ``laws.py`` in a user's working folder does no harm. Its shorter name is free for such a file. If
nothing hides the package, its shorter name and those of its modules give the modules of the longer names: a class must
not exist twice.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

_HOME = Path(__file__).resolve().parents[1]
_PREFIX = "nonsmooth."


def load_from_folder(name: str) -> None:
    """Replace the module ``nonsmooth.bodies``, which is being imported, with the package in the folder ``bodies``."""
    file = _HOME / name.removeprefix(_PREFIX) / "__init__.py"
    spec = spec_from_file_location(name, file, submodule_search_locations=[str(file.parent)])
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules[name])


def join_names(name: str) -> None:
    """If a package is being imported as ``bodies``, give it the module of ``nonsmooth.bodies``."""
    if name.startswith(_PREFIX):
        return
    sys.modules[name] = importlib.import_module(_PREFIX + name)
    if _FINDER not in sys.meta_path:
        sys.meta_path.insert(0, _FINDER)


class _Finder(MetaPathFinder):
    """Import finder: it finds ``bodies.ball`` as ``nonsmooth.bodies.ball`` if ``bodies`` is our package."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package = fullname.partition(".")[0]
        known = sys.modules.get(_PREFIX + package)
        if known is None or sys.modules.get(package) is not known or find_spec(_PREFIX + fullname) is None:
            return None
        return ModuleSpec(fullname, _SameModule())


class _SameModule(Loader):
    """Loader that returns the module ``nonsmooth.bodies.ball`` for the name ``bodies.ball``."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = importlib.import_module(_PREFIX + spec.name)
        # the import system writes its specification into the module
        self._spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self._spec


_FINDER = _Finder()
