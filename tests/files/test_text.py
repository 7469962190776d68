"""Tables to TOML text and back to the last bit, and text that is not TOML."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nonsmooth as ns
from nonsmooth.files.formats import text_of

_words = st.text(st.characters(codec="utf-8", exclude_characters="\x00"), max_size=8)
_scalars = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats() | _words
_values = st.recursive(
    _scalars, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_words, inner, max_size=3), max_leaves=8
)
_tables = st.dictionaries(_words, _values, max_size=4)


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return (math.isnan(one) and math.isnan(other)) or repr(one) == repr(other)
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return type(one) is type(other) and bool(one == other)


@given(_tables)
def test_toml_gives_back_what_was_written(tables: dict[str, Any]) -> None:
    assert _same(tomllib.loads(text_of(tables)), tables)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("t_end = 1\nt_end = 2\n", "Cannot overwrite a value (at line 2, column 10)"),
        ("[bodies]\n[bodies]", "Cannot declare ('bodies',) twice (at line 2, column 8)"),
        ("t_end = ", "Invalid value (at end of document)"),
        ("t_end = 1\n\nsample_interval = 1e-3 s", "after a statement (at line 3, column 24)"),
        ('title = "\\q"', "Unescaped '\\\\' in a string (at line 1, column 12)"),
    ],
)
def test_broken_toml_is_told_with_file_line_and_remedy(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text(text)
    with pytest.raises(ns.InvalidInput) as raised:
        ns.load_system(path)
    message = str(raised.value)
    assert message.startswith(f"{path} must be TOML text, but it is ")
    assert told in message
    assert message.endswith("Correct the place it names.")
