"""``nonsmooth view`` and ``run --view``: the page, and what they refuse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote, urlparse

import numpy as np
import pytest

import nonsmooth as ns
from tests.viewer.decoded import decoded

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the addresses that a browser was to open."""
    addresses: list[str] = []

    def opens(address: str) -> bool:
        addresses.append(address)
        return True

    monkeypatch.setattr("webbrowser.open", opens)
    return addresses


def _page(address: str) -> str:
    return Path(unquote(urlparse(address).path)).read_text(encoding="utf-8")


def test_a_scenario_is_run_and_opened(call: Call, opened: list[str]) -> None:
    status, output, errors = call("view", "tiny", "--set", "t_end=0.05")
    assert (status, output) == (0, "")
    told, arrays = decoded(_page(opened[0]))
    assert told["status"] == "done"
    assert arrays["time"][-1] == 0.05
    assert "plays in the browser" in errors


def test_a_run_may_be_opened_too(call: Call, opened: list[str]) -> None:
    status, output, _ = call("run", "tiny", "--view")
    assert status == 0
    assert output.startswith("tiny: done at t = 0.1 s")
    assert decoded(_page(opened[0]))[0]["title"] == "A ball on a vibrating plate"


def test_without_a_browser_it_says_which_file_to_open(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("webbrowser.open", lambda _: False)
    status, _, errors = call("view", "tiny", "--set", "t_end=0.05")
    assert status == 0
    assert "plays in the browser" not in errors
    path = errors.partition("no browser was found; open this file: ")[2].splitlines()[0]
    assert decoded(Path(path).read_text(encoding="utf-8"))[0]["status"] == "done"


def test_an_ordinary_script_is_no_scenario(call: Call, tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text("")
    status, _, errors = call("view", str(tmp_path / "mine.py"))
    assert status == 2
    assert "must have the form file.py:Class" in errors
    assert "mine.py:MyScenario; a script is run by python itself." in errors


@pytest.mark.slow
def test_a_folder_of_results_is_opened_as_it_ran(call: Call, opened: list[str], tmp_path: Path) -> None:
    folder = tmp_path / "results"
    call("run", "tiny", "--set", "t_end=0.1", "--out", str(folder))
    path = tmp_path / "page.html"
    status, _, errors = call("view", str(folder), "--html", str(path))
    assert status == 0
    assert opened == []
    assert f"the page is {path}" in errors
    _, arrays = decoded(path.read_text(encoding="utf-8"))
    np.testing.assert_array_equal(arrays["event_time"], ns.open_solution(folder).events.time)


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nofolder",), "'nofolder' is neither a folder nor a scenario. `nonsmooth list"),
        (("tinny",), "'tinny' is neither a folder nor a scenario. Did you mean the scenario 'tiny'?"),
        (("plate",), "That is a body."),
        (("tiny", "--set", "no=1"), "no"),
        (("{folder}",), "solution.zarr"),
        (("{folder}", "--set", "t_end=1"), "--set"),
    ],
)
def test_what_is_wrong_is_said_by_name(call: Call, tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    status, _, errors = call("view", *(word.format(folder=tmp_path) for word in words))
    assert status == 2
    assert said in errors


def test_a_page_that_cannot_be_written_is_an_error_with_its_path(call: Call, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    status, _, errors = call("view", "tiny", "--html", str(tmp_path / "file" / "page.html"))
    assert status == 2
    assert "page.html must be in a folder that can be written to" in errors


def test_a_page_is_not_overwritten_unasked(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_text("precious")
    status, _, errors = call("view", "tiny", "--html", str(path))
    assert (status, path.read_text()) == (2, "precious")
    assert "--overwrite" in errors
    assert call("view", "tiny", "--html", str(path), "--overwrite")[0] == 0
    assert "precious" not in path.read_text(encoding="utf-8")


def test_of_a_run_that_fails_what_was_computed_is_shown(call: Call, opened: list[str]) -> None:
    status, _, errors = call("view", "tiny", "--set", "mode=nan law")
    assert status == 1
    assert "not finite" in errors
    assert "see the page 'Stuck?' of the documentation\n" in errors
    assert decoded(_page(opened[0]))[0]["status"] == "failed"
