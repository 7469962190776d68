"""The reference has every public module once, and the navigation every page."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "docs" / "pages"


def test_every_public_module_is_in_the_reference_once() -> None:
    """A module is listed, or its package with all that it holds."""
    listed = [
        name
        for page in (PAGES / "reference").glob("*.md")
        for name in re.findall(r"^::: (\S+)$", page.read_text(encoding="utf-8"), re.M)
    ]
    second_names = {ROOT / "nonsmooth" / f"{package}.py" for package in ("bodies", "laws", "scenarios")}
    for package in ("nonsmooth", "bodies", "laws", "scenarios"):
        for file in (ROOT / package).rglob("*.py"):
            if not file.stem.startswith("_") and file not in second_names:
                module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
                found = [name for name in listed if module == name or module.startswith(f"{name}.")]
                assert len(found) == 1, f"{module} is in the reference as {found}"


def test_every_page_is_in_the_navigation() -> None:
    """What is not listed cannot be found."""
    navigation = set(re.findall(r": (\S+\.md)$", (ROOT / "docs" / "mkdocs.yml").read_text(encoding="utf-8"), re.M))
    assert navigation == {page.relative_to(PAGES).as_posix() for page in PAGES.rglob("*.md")}
