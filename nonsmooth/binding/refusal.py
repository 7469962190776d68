"""Reason why a function cannot be compiled: one line of the compiler's message, and the source line that it names."""

from __future__ import annotations

import linecache
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from nonsmooth.binding.source import place_of

_STEP = re.compile(r"^Failed in \w+ mode pipeline.*$", re.M)
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_PLACES = re.compile(r'File "(?P<file>[^"]+)", line (?P<line>\d+)|(?:at|from) (?P<path>[^\s<>]\S*) \((?P<number>\d+)\)')
_SIGNATURE = re.compile(r"^\s*>>>\s*(.*)$", re.M)
_REDUNDANT = re.compile(r"\.?\s*Raised from .*$|, defined at None$| for '\$[^']*'")


@final
@dataclass(frozen=True)
class Refusal:
    """Why a function cannot be compiled.

    Attributes
    ----------
    reason : str
        The compiler's reason, one line.
    file : str
        File of the line that cannot be compiled; if the compiler names no line, the file of the function.
    line : int
        Number of that line.
    text : str
        Text of that line.
    """

    reason: str
    file: str
    line: int
    text: str

    def describe(self, file: str) -> str:
        """Place and reason as text; the name of the file is left out if it is ``file``."""
        place = f"line {self.line}" if self.file == file else f"{self.file}, line {self.line}"
        return f"{place}{f', `{self.text}`' if self.text else ''}: {self.reason}"


def refusal(function: Callable[..., Any], error: Exception) -> Refusal:
    """Reason why the compiler refuses a function, from its error."""
    message = _COLOUR.sub("", str(error))
    file, line = _place(message, *place_of(function))
    return Refusal(_reason(message) or type(error).__name__, file, line, linecache.getline(file, line).strip())


def _reason(message: str) -> str:
    paragraph = _STEP.sub("", message).strip().split("\n\n")[0].split("\nDuring:")[0]
    first = " ".join(paragraph.splitlines()[0].split()) if paragraph else ""
    signature = _SIGNATURE.search(message)
    if first.endswith("found for signature:") and signature:
        return f"{first} {signature[1]}"
    return _REDUNDANT.sub("", first).rstrip(".")


def _place(message: str, file: str, first: int) -> tuple[str, int]:
    """File and line of the code that the compiler refuses, read from its message.

    The message lists places from the innermost call outwards, so the first place outside of numba is taken. If the
    message has no such place, the result is ``file`` and ``first``, which are those of the compiled function.
    """
    for found in _PLACES.finditer(message):
        named, line = found["file"] or found["path"], int(found["line"] or found["number"])
        if Path(named).name == Path(file).name:
            return file, line
        if named.endswith(".py") and "numba" not in Path(named).parts and Path(named).is_file():
            return str(Path(named).resolve()), line
    return file, first
