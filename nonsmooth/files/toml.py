"""Enough of TOML for scenario files, for Python 3.10, whose library has no reader; no dates, no multi-line strings."""

from __future__ import annotations

import json
import re
from typing import Any

_SPACE = re.compile(r"[ \t]*")
_GAP = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_END = re.compile(r"[ \t]*(?:#[^\n]*)?(?:\r?\n|\Z)")
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_BASIC = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_LITERAL = re.compile(r"'[^'\n]*'")
_NUMBER = re.compile(r"[+-]?(?:inf|nan|\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d[\d_]*)?)(?![\w.:-])")
_LONG = re.compile(r"\\U([0-9a-fA-F]{8})")


class TOMLDecodeError(ValueError):
    """A text that is no TOML, with the line."""


def loads(text: str) -> dict[str, Any]:
    """Return the tables of a text.

    Raises
    ------
    TOMLDecodeError
        If it is no TOML, or has what this reader leaves out.
    """
    return _Reader(text).document()


class _Reader:
    def __init__(self, text: str) -> None:
        self._text, self._at = text, 0

    def document(self) -> dict[str, Any]:
        root: dict[str, Any] = {}
        here, defined = root, set()
        while self._skip(_GAP) < len(self._text):
            if self._take("["):
                array = self._take("[")
                path = self._path()
                self._need("]]" if array else "]")
                if not array and id(self._walk(root, path)) in defined:
                    raise self._error(f"table {'.'.join(path)} comes twice")
                here = self._append(root, path) if array else self._walk(root, path)
                defined.add(id(here))
            else:
                self._pair(here)
            if _END.match(self._text, self._at) is None:
                raise self._error("a new line is missing")
        return root

    def _pair(self, table: dict[str, Any]) -> None:
        *way, last = self._path()
        self._need("=")
        self._skip(_SPACE)
        place = self._walk(table, way)
        if last in place:
            raise self._error(f"{last} comes twice")
        place[last] = self._value()

    def _path(self) -> list[str]:
        found = [self._key()]
        while self._skip(_SPACE) < len(self._text) and self._take("."):
            self._skip(_SPACE)
            found.append(self._key())
        return found

    def _key(self) -> str:
        self._skip(_SPACE)
        word = self._match(_BARE)
        if word is not None:
            return word
        quoted = self._string()
        if quoted is None:
            raise self._error("a key is missing")
        return quoted

    def _walk(self, table: Any, path: list[str]) -> dict[str, Any]:
        for key in path:
            table = table.setdefault(key, {})
            table = table[-1] if isinstance(table, list) and table else table
            if not isinstance(table, dict):
                raise self._error(f"{key} is no table")
        found: dict[str, Any] = table
        return found

    def _append(self, table: dict[str, Any], path: list[str]) -> dict[str, Any]:
        many = self._walk(table, path[:-1]).setdefault(path[-1], [])
        if not isinstance(many, list):
            raise self._error(f"{path[-1]} is no array of tables")
        made: dict[str, Any] = {}
        many.append(made)
        return made

    def _value(self) -> Any:
        string = self._string()
        if string is not None:
            return string
        for word, value in (("true", True), ("false", False)):
            if self._take(word):
                return value
        if self._take("["):
            return self._array()
        if self._take("{"):
            return self._table()
        digits = self._match(_NUMBER)
        if digits is None:
            raise self._error("a value is missing, or of a kind that is not read here")
        plain = digits.replace("_", "")
        return int(plain) if re.fullmatch(r"[+-]?\d+", plain) else float(plain)

    def _array(self) -> list[Any]:
        found: list[Any] = []
        while True:
            self._skip(_GAP)
            if self._take("]"):
                return found
            found.append(self._value())
            self._skip(_GAP)
            if not self._take(","):
                self._need("]")
                return found

    def _table(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        self._skip(_SPACE)
        if self._take("}"):
            return found
        while True:
            self._pair(found)
            self._skip(_SPACE)
            if not self._take(","):
                self._need("}")
                return found

    def _string(self) -> str | None:
        if self._text.startswith(('"""', "'''"), self._at):
            raise self._error("a string over several lines is not read here")
        word = self._match(_LITERAL)
        if word is not None:
            return word[1:-1]
        word = self._match(_BASIC)
        if word is None:
            return None
        try:
            return str(json.loads(_LONG.sub(lambda m: json.dumps(chr(int(m[1], 16)))[1:-1], word), strict=False))
        except (ValueError, OverflowError):
            raise self._error(f"the string {word} has an unknown escape") from None

    def _skip(self, pattern: re.Pattern[str]) -> int:
        self._match(pattern)
        return self._at

    def _match(self, pattern: re.Pattern[str]) -> str | None:
        match = pattern.match(self._text, self._at)
        if match is None:
            return None
        self._at = match.end()
        return match[0]

    def _take(self, word: str) -> bool:
        found = self._text.startswith(word, self._at)
        self._at += len(word) * found
        return found

    def _need(self, word: str) -> None:
        self._skip(_SPACE)
        if not self._take(word):
            raise self._error(f"{word!r} is missing")

    def _error(self, reason: str) -> TOMLDecodeError:
        return TOMLDecodeError(f"{reason}, line {self._text.count(chr(10), 0, self._at) + 1}")
