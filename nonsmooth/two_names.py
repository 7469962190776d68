"""The packages bodies, laws and scenarios have two names each: ``nonsmooth.bodies`` and ``bodies`` are one module.

The packages are folders next to the folder of nonsmooth. Under its long name, a package is loaded from its folder by
path. So a file ``bodies.py`` or ``laws.py`` in a user's working folder does no harm, and the short name stands for the
user's file. If the user has no such file, the short name gives the same module object as the long name, so that no
class exists twice. The same holds for the modules in a package.
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
    """Replace the module ``name``, such as ``nonsmooth.bodies``, by the package in the folder ``bodies``.

    The module calls this function while it is imported.
    """
    file = _HOME / name.removeprefix(_PREFIX) / "__init__.py"
    spec = spec_from_file_location(name, file, submodule_search_locations=[str(file.parent)])
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules[name])


def join_names(name: str) -> None:
    """Make a package that is imported by its short name, such as ``bodies``, the same object as ``nonsmooth.bodies``.

    ``name`` is the ``__name__`` of the package. A long name changes nothing.
    """
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
        # after this call the import system overwrites `module.__spec__`; `exec_module` restores it
        self._spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self._spec


_FINDER = _Finder()
