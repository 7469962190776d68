"""The page on slow runs explains every limit of a step."""

from __future__ import annotations

import re
from pathlib import Path

from nonsmooth.engine.memory.modes import LIMITS

PAGE = Path(__file__).parents[2] / "docs" / "pages" / "why_slow.md"


def test_every_limit_has_a_row() -> None:
    table = PAGE.read_text(encoding="utf-8").split("## All limits of a step")[1]
    assert sorted(re.findall(r'^\| `"(.+?)"` \|', table, re.MULTILINE)) == sorted(LIMITS)
