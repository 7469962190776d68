"""The reference has two parts: pages for users, with public names, and pages for developers, with all other names.

Pages for developers list modules.  A name that has a place on a page for users is hidden there.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import griffe

PAGES = Path(__file__).parent / "pages"
_DIRECTIVE = re.compile(r"^::: (\S+)$", re.MULTILINE)


def listed(folder: str) -> list[str]:
    """Names after ``:::`` on the pages of a folder, in order."""
    pages = sorted((PAGES / folder).glob("*.md"))
    return [name for page in pages for name in _DIRECTIVE.findall(page.read_text(encoding="utf-8"))]


class ReferencePages(griffe.Extension):
    """Marks names of the pages for users as not public, which hides them where ``filters: public`` is set."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        """Mark the names of one package, and modules that have no other names."""
        for name in listed("reference"):
            _hide(pkg, name)
        _hide_rest(pkg)


def _hide(pkg: griffe.Module, name: str) -> None:
    """Hide a name of a package where it is defined."""
    first, *rest = name.split(".")
    if first != pkg.name or not rest:
        return
    found: griffe.Object | griffe.Alias = pkg
    for depth, part in enumerate(rest, 1):
        if part not in found.members:
            return  # the build reports the page that lists an unknown name
        found = found.members[part]
        if isinstance(found, griffe.Alias):
            _hide(pkg, ".".join([found.target_path, *rest[depth:]]))
            return
    found.public = False


def _hide_rest(module: griffe.Module) -> bool:
    """Hide imported names, machinery of components, and modules without a name; return whether this module is shown."""
    names, modules = list[bool](), list[bool]()
    for name, one in module.members.items():
        if isinstance(one, griffe.Alias):
            one.public = False
        elif isinstance(one, griffe.Module):
            if not name.startswith("_"):
                modules.append(_hide_rest(one))
        elif not name.startswith("_") and one.has_docstrings:
            names.append(one.public is not False)
        for part in ("departures", "__post_init__") if isinstance(one, griffe.Class) else ():
            if part in one.members:
                one.members[part].public = False
    # a module without documented names has its own docstring
    if (names or modules) and not any(names) and not any(modules):
        module.public = False
    return module.public is not False
