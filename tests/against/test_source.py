"""Sizes of source are counted as they are said to be."""

from __future__ import annotations

from pathlib import Path

from tests.benchmarks.against import source

_MODULE = '''"""What it is.

Two lines more.
"""

from math import pi  # code with a comment

# a comment

WIDTH = 3
"""A string that stands by itself."""
_TURN, AXIS = 2.0 * pi, "x"
LIMIT: float = -1e-3


class Public:
    """A class."""

    text = """two
lines"""

    def method(self) -> int:
        """A method."""
        return (
            WIDTH
        )


def _private() -> None:
    """A function."""
'''


def test_blank_lines_comments_and_docstrings_are_no_code() -> None:
    # import, three values, class, two of a text, def, four of a return, def
    assert source.lines_of_code(_MODULE) == 1 + 3 + 1 + 2 + 1 + 3 + 1


def test_names_are_public_without_an_underscore_and_where_they_are_defined() -> None:
    assert source.public_names(_MODULE) == {"WIDTH", "AXIS", "LIMIT", "Public"}


def test_constants_are_numeric_if_they_are_computed_from_numbers() -> None:
    assert source.numeric_constants(_MODULE) == {"WIDTH", "_TURN", "LIMIT"}
    assert source.numeric_constants('A = f(1.0)\nB = True\nC = A\nD = (1.0, 2.0)\nE = "1"\n') == set()


def test_folders_of_the_package_are_rows_of_their_own_where_they_differ(tmp_path: Path) -> None:
    for side, more in (("this", "x = 1\n"), ("other", "")):
        for name, text in (("laws/one.py", "a = 1\n"), ("nonsmooth/__init__.py", ""), ("nonsmooth/engine/e.py", more)):
            path = tmp_path / side / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
    rows = list(source.table(source.sizes(tmp_path / "this"), source.sizes(tmp_path / "other")))
    assert rows[2:] == [
        "| laws | 1 | 1 | 1 |",
        "| nonsmooth | 2 | 0 → 1 (+1) | 0 → 1 (+1) |",
        "| nonsmooth/engine | 1 | 0 → 1 (+1) | 0 → 1 (+1) |",
    ]
    assert source.engine_constants(tmp_path / "this") == 1
