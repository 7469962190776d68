"""Names under which Python calls compiled functions: entry points, and steps of an engine of one's own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias, TypeVar

from nonsmooth.errors import UnknownName

Fingerprint: TypeAlias = Callable[[Callable[..., Any], str], str]
"""Returns a digest of a function and of a context, the key of its code on disk; nothing where there is none."""
_Entry = TypeVar("_Entry")


def own_name(function: Callable[..., Any]) -> str:
    """Return the name of a step of one's own, which no entry point of the engine has."""
    return f"{function.__module__}.{function.__qualname__}"


def known(entries: Mapping[str, _Entry], name: str) -> _Entry:
    """Return what is called under a name.

    Raises
    ------
    UnknownName
        If nothing is.
    """
    if name not in entries:
        raise UnknownName("entry point", name, entries)
    return entries[name]
