"""The gallery has a page of every scenario, with what is made of a run of it."""

from __future__ import annotations

from pathlib import Path

from nonsmooth.plugins import registry

PAGES = Path(__file__).parents[2] / "docs" / "pages" / "gallery"


def test_every_scenario_has_its_view_and_its_numbers_on_one_page() -> None:
    """``docs/build_pages.py`` makes the parts; the build of the site fails where one is missing."""
    texts = [page.read_text(encoding="utf-8") for page in PAGES.glob("*.md")]
    for name in registry.names("scenarios"):
        view, numbers = (f'--8<-- "{name}.{part}.md"\n' for part in ("view", "numbers"))
        assert sum(view in text for text in texts) == 1, name
        assert any(view in text and numbers in text for text in texts), name
