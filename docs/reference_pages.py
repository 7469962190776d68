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
        _hide_empty(pkg)


def _hide(pkg: griffe.Module, name: str) -> None:
    """Hide a name where it is defined, and where a package of this one imports it from there."""
    first, *rest = name.split(".")
    if first == pkg.name and rest:
        found: griffe.Object | griffe.Alias = pkg
        for depth, part in enumerate(rest, 1):
            found = found.members[part]
            if isinstance(found, griffe.Alias):
                _hide(pkg, ".".join([found.target_path, *rest[depth:]]))
                break
        found.public = False


def _hide_empty(module: griffe.Module) -> bool:
    """Hide modules all of whose names are on pages for users; return whether this one has another name."""
    own = [one for one in module.members.values() if not one.is_alias and not one.name.startswith("_")]
    # each module must be visited, so that this is a list
    inner = [_hide_empty(one) for one in own if isinstance(one, griffe.Module)]
    for name in ("departures", "__post_init__"):
        for one in own:
            if isinstance(one, griffe.Class) and name in one.members:
                one.members[name].public = False
    names = [one for one in own if not isinstance(one, griffe.Module) and one.has_docstrings]
    shown = any(inner) or any(one.public is not False for one in names) or not (inner or names)
    if not shown:
        module.public = False
    return module.public is not False
