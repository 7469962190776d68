"""``nonsmooth view``: of a scenario and of what was stored, as a page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

Call = Callable[..., tuple[int, str, str]]


def test_a_scenario_is_run_and_written_as_a_page(call: Call, tmp_path: Path) -> None:
    page = tmp_path / "run.html"
    status, output, errors = call("view", "tiny", "--html", str(page))
    assert (status, output) == (0, "")
    assert f"the page is {page}" in errors
    assert "nonsmooth-view/1" in page.read_text(encoding="utf-8")


def test_what_was_stored_is_shown_as_it_was(call: Call, tmp_path: Path) -> None:
    folder, page = str(tmp_path / "stored"), tmp_path / "run.html"
    assert call("run", "tiny", "--out", folder)[0] == 0
    assert call("view", folder, "--html", str(page))[0] == 0
    assert page.is_file()
    status, _, errors = call("view", folder, "--set", "t_end=1")
    assert status == 2
    assert "view takes --set, --law and --engine for a scenario only" in errors
