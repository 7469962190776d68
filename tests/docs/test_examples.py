"""Every Python block of the README and of the documentation runs, and prints what the text block behind it says."""

from __future__ import annotations

import re
import sys
import types
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "pages").rglob("*.md"))]
_BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```\n(?:\nprints\n\n```text\n(?P<output>.*?)^```\n)?", re.M | re.S)


def _blocks(page: Path) -> list[re.Match[str]]:
    return list(_BLOCK.finditer(page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("page", [p for p in PAGES if _blocks(p)], ids=lambda p: p.relative_to(ROOT).as_posix())
def test_blocks_run_as_printed(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The blocks of a page run in order, as one module."""
    module = types.ModuleType("example")
    monkeypatch.setitem(sys.modules, "example", module)
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    for block in _blocks(page):
        lines_before = text.count("\n", 0, block.start("code"))
        exec(compile("\n" * lines_before + block["code"], page, "exec"), vars(module))
        printed = capsys.readouterr().out
        if block["output"] is not None:
            assert printed == block["output"]


def test_there_are_examples() -> None:
    """The README and the first page have some, each with what it prints."""
    for page in PAGES[0], ROOT / "docs" / "pages" / "index.md":
        assert any(block["output"] for block in _blocks(page))
