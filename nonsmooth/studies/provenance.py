"""Describes on what the numbers of a study depend: digests of user code, versions of software, and the processor.

It also shows in words where the descriptions of two studies differ.
"""

from __future__ import annotations

import hashlib
import inspect
import platform
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from nonsmooth.results.output import versions

_BEFORE, _SHOWN = 20, 60
"""Length of the part of a specification that a message shows, in characters: before the first difference, and in
total."""


def digest(owner: Any) -> str:
    """Return the sha256 of the source text of a function or class, "" if it has no source file."""
    try:
        text = inspect.getsource(owner)
    except (OSError, TypeError):
        return ""
    return hashlib.sha256(text.encode()).hexdigest()


def differing(one: Any, other: Any) -> str:
    """Return the differences of two specifications in words."""
    return "; ".join(_differing(one, other, ""))


def _differing(one: Any, other: Any, key: str) -> Iterator[str]:
    if isinstance(one, dict) and isinstance(other, dict):
        for name in {**one, **other}:
            yield from _differing(one.get(name), other.get(name), f"{key}.{name}" if key else name)
    elif one != other:
        before, now = str(one), str(other)
        at = next((i for i, (a, b) in enumerate(zip(before, now, strict=False)) if a != b), 0)
        yield f"{key} was {_about(before, at)} and is {_about(now, at)}"


def _about(text: str, at: int) -> str:
    """Return the part of a text around a character."""
    first = max(0, at - _BEFORE)
    head, tail = "... " if first else "", " ..." if first + _SHOWN < len(text) else ""
    return f"{head}{text[first : first + _SHOWN]}{tail}"


def provenance() -> Mapping[str, str]:
    """Return the processor, and the versions of software on which the last bits of results depend, by name."""
    return {**versions(), "processor": _processor()}


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:  # another system
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
