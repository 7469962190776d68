"""Every Python block of the README and of the documentation runs, and prints what the text block behind it says."""

from __future__ import annotations

import re
import sys
import types
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "pages").rglob("*.md"))]
NEEDS = {"study_tools.md": ("SALib", "optuna", "sbi")}
"""What a page needs beyond the extra test: where it is not installed the page is not run."""
_BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```\n(?:\nprints\n\n```text\n(?P<output>.*?)^```\n)?", re.M | re.S)


def _blocks(page: Path) -> list[re.Match[str]]:
    return list(_BLOCK.finditer(page.read_text(encoding="utf-8")))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("page", [p for p in PAGES if _blocks(p)], ids=lambda p: p.relative_to(ROOT).as_posix())
def test_blocks_run_as_printed(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The blocks of a page run in order, as one module."""
    for package in NEEDS.get(page.name, ()):
        pytest.importorskip(package)
    module = types.ModuleType("example")
    monkeypatch.setitem(sys.modules, "example", module)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda address: True)
    text = page.read_text(encoding="utf-8")
    for block in _blocks(page):
        lines_before = text.count("\n", 0, block.start("code"))
        try:
            exec(compile("\n" * lines_before + block["code"], page, "exec"), vars(module))
        except pytest.skip.Exception as reason:  # a property of the kit that was not looked at
            pytest.fail(f"{page.name} stops with: {reason}")
        printed = capsys.readouterr().out
        if block["output"] is not None:
            assert printed == block["output"]


def test_there_are_examples() -> None:
    """The README and the first page have some, each with what it prints."""
    for page in PAGES[0], ROOT / "docs" / "pages" / "index.md":
        assert any(block["output"] for block in _blocks(page))


EXTENSION_POINTS = (
    "body",
    "contact_kinematics",
    "engine",
    "friction_law",
    "guard",
    "impact_law",
    "joint",
    "load",
    "motion",
    "normal_law",
    "scenario",
    "traction_law",
)
LONGEST = 25


@pytest.mark.parametrize("name", EXTENSION_POINTS)
def test_the_page_of_an_extension_point_is_complete_and_short(name: str) -> None:
    """A contract as a numbered list, examples that fit on a screen, how to check and how to ship it."""
    page = ROOT / "docs" / "pages" / "plugins" / f"{name}.md"
    text = page.read_text(encoding="utf-8")
    codes = [block["code"] for block in _blocks(page)]
    assert any("class " in code for code in codes)
    for code in codes:
        assert len(code.splitlines()) <= LONGEST, code
    contract = re.search(r"^## The contract.*?(?=^## )", text, re.M | re.S)
    assert contract is not None
    points = [int(number) for number in re.findall(r"^(\d+)\. ", contract[0], re.M)]
    assert points == list(range(1, len(points) + 1))
    assert len(points) >= 3
    assert re.search(r"^## Check it$.*`nonsmooth check [\w-]+`.*check_\w+\(", text, re.M | re.S)
    assert re.search(r"^## Ship it$.*entry-points\.\"nonsmooth\.\w+\"", text, re.M | re.S)
