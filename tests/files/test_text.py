"""Tables to TOML text and back, by the library's reader and by our own."""

from __future__ import annotations

import math
import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nonsmooth.files.text import text_of
from nonsmooth.files.toml import TOMLDecodeError, loads

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


@pytest.mark.slow
@given(_tables)
def test_our_reader_gives_back_what_was_written(tables: dict[str, Any]) -> None:
    assert _same(loads(text_of(tables)), tables)


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info < (3, 11), reason="the library of Python 3.10 has no reader")
@given(_tables)
def test_the_reader_of_the_library_does_too(tables: dict[str, Any]) -> None:
    import tomllib

    assert _same(tomllib.loads(text_of(tables)), tables)


_BY_HAND = """
# a comment
t_end = 1_000.5  # another
a.b.c = +1
'a b' = "tab\\t, µ \\u00b5 \\U0001F600 # no comment"
empty = []
[bodies . ball]
radius = 1e-3
start = { position = [0, 0.0, -1.5e+2], place = 'touching' }
[[contacts]]
between = [
    "ball",  # first
    "floor",
]
[[contacts]]
shapes = [[0, 1], "all"]
[contacts.friction]
type = "coulomb"
[engine]
on = true
off = false
far = -inf
"""


@pytest.mark.skipif(sys.version_info < (3, 11), reason="the library of Python 3.10 has no reader")
def test_both_readers_agree_on_what_a_user_writes() -> None:
    import tomllib

    assert loads(_BY_HAND) == tomllib.loads(_BY_HAND)
    assert len(loads(_BY_HAND)["contacts"]) == 2


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a = 1\na = 2", "a comes twice, line 2"),
        ("[a]\n[a]", "table a comes twice, line 2"),
        ("a = ", "a value is missing"),
        ("a = 1 b = 2", "a new line is missing, line 1"),
        ("a = [1, 2", "']' is missing"),
        ("a = 1\n[a]", "a is no table, line 2"),
        ("a = 1\n[[a]]", "a is no array of tables, line 2"),
        ("a 1", "'=' is missing"),
        ("= 1", "a key is missing"),
        ('a = """b"""', "a string over several lines is not read here"),
        ('a = "\\q"', "unknown escape"),
        ("a = 1979-05-27", "a value is missing, or of a kind that is not read here"),
    ],
)
def test_what_is_wrong_is_told_with_the_line(text: str, told: str) -> None:
    with pytest.raises(TOMLDecodeError) as raised:
        loads(text)
    assert told in str(raised.value)
