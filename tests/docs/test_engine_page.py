"""The page on how the engine works: what it follows, it follows through functions that there are."""

from __future__ import annotations

import re
from pathlib import Path

import nonsmooth.engine

_PAGE = (
    (Path(__file__).parents[2] / "docs/pages/engine.md")
    .read_text(encoding="utf-8")
    .split("## One step")[1]
    .split("## Another engine")[0]
)
_ENGINE = Path(nonsmooth.engine.__file__).parent


def test_at_most_twelve_functions_are_named() -> None:
    named = set(re.findall(r"\*\*`(\w+)`\*\*", _PAGE))
    assert 0 < len(named) <= 12
    assert set(re.findall(r"`(\w+_\w+|collide|locate|slope|advance|_step)`", _PAGE)) == named
    defined = {
        name for path in _ENGINE.rglob("*.py") for name in re.findall(r"^def (\w+)\(", path.read_text(), re.MULTILINE)
    }
    assert named <= defined


def test_the_files_are_there() -> None:
    files = re.findall(r"`(\w+/\w+\.py)`", _PAGE)
    assert files
    for name in files:
        assert (_ENGINE / name).is_file(), name
