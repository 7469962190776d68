"""Links lead somewhere: those inside the repository to a file and a heading, the others to a well-formed address.

Whether addresses answer is asked only where ``NONSMOOTH_LINKS=1`` is set: that needs a network, and hosts may fail.
"""

from __future__ import annotations

import json
import os
import re
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "docs" / "pages"
TEXTS = [
    *(ROOT / name for name in ("README.md", "CHANGELOG.md", "CITATION.cff", "pyproject.toml", "docs/mkdocs.yml")),
    *sorted(PAGES.rglob("*.md")),
    *sorted((ROOT / "docs" / "notebooks").glob("*.ipynb")),
]
_BLOCK = re.compile(r"^(`{3,}).*?^\1", re.MULTILINE | re.DOTALL)
_CODE = re.compile(r"`[^`\n]+`")
_LINK = re.compile(r"\]\(([^)\s]+)[^)]*\)|\b(?:src|href)=\"([^\"]+)\"")
_ADDRESS = re.compile(r"https?:[^\s\"'<>()\[\]{}`,]+")


def _prose(path: Path) -> str:
    """Return what is read as Markdown, without blocks of code."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "markdown"]
        text = "\n\n".join("".join(cell["source"]) for cell in cells)
    return _BLOCK.sub("", text)


def _headings(page: Path) -> set[str]:
    """Return the anchors of a page, as MkDocs makes them."""
    titles = re.findall(r"^#+ (.+)$", _prose(page), re.MULTILINE)
    return {re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", title.lower()).strip()) for title in titles}


def _broken(path: Path) -> list[str]:
    broken = []
    for link in map("".join, _LINK.findall(_CODE.sub("", _prose(path)))):
        place, _, anchor = link.partition("#")
        target = path.parent / place if place else path
        # anchors of the reference are made out of docstrings: the strict build looks at them
        made = {PAGES / "reference", PAGES / "developers"} & {*target.resolve().parents}
        known = made or not anchor
        if not urlsplit(link).scheme and not (target.exists() and (known or anchor in _headings(target))):
            broken.append(link)
    return broken


def _addresses() -> set[str]:
    return {address.rstrip(".;:") for path in TEXTS for address in _ADDRESS.findall(path.read_text(encoding="utf-8"))}


@pytest.mark.fast_cases(41)
@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_inside_lead_to_a_file_and_a_heading(path: Path) -> None:
    assert _broken(path) == []


def test_the_site_says_each_thing_once_and_finds_what_it_adds() -> None:
    """The second of two keys of a name would be taken without a word, as a missing style sheet is."""
    text = (ROOT / "docs" / "mkdocs.yml").read_text(encoding="utf-8")
    keys = re.findall(r"^(\w+):", text, re.MULTILINE)
    assert sorted(keys) == sorted(set(keys))
    added = re.findall(r"assets/[\w./-]+", text)
    assert "assets/site.css" in added
    assert [name for name in added if not (PAGES / name).is_file()] == []


def test_addresses_are_well_formed() -> None:
    """A host with a name that others can reach, asked by https."""
    found = _addresses()
    assert any(address.startswith("https://doi.org/") for address in found)
    for address in found:
        parts = urlsplit(address)
        assert parts.scheme == "https", address
        assert re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)*\.[a-z]{2,}", parts.netloc), address


@pytest.mark.skipif("NONSMOOTH_LINKS" not in os.environ, reason="asks the network: NONSMOOTH_LINKS=1")
@pytest.mark.parametrize("address", sorted(_addresses()))
def test_addresses_answer(address: str) -> None:
    request = urllib.request.Request(address, headers={"User-Agent": "Mozilla/5.0"})
    with urllib.request.urlopen(request, timeout=30) as answer:
        assert answer.status == 200
