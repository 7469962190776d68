"""The names under which Python calls compiled functions: entry points, and steps of engines that plug-ins define."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias, TypeVar

from nonsmooth.errors import UnknownName

Fingerprint: TypeAlias = Callable[[Callable[..., Any], str], str]
"""``fingerprint(function, context)``: key of the function's code on disk; empty if the code must not be kept."""
_Entry = TypeVar("_Entry")


def own_name(function: Callable[..., Any]) -> str:
    """Name by which Python calls the step function of a plug-in's engine: ``module.qualname``."""
    # its dots distinguish it from the names of entry points
    return f"{function.__module__}.{function.__qualname__}"


def known(entries: Mapping[str, _Entry], name: str) -> _Entry:
    """The entry of a function that Python calls by ``name``: an entry point, or the step of an engine.

    Raises
    ------
    UnknownName
        If the name is that of no entry point and no step.
    """
    if name not in entries:
        raise UnknownName("entry point", name, entries)
    return entries[name]
