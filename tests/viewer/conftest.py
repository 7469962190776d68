"""A browser, and a page to look at."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import nonsmooth as ns
from nonsmooth.plugins import registry

_QUIET = ["--no-sandbox", "--disable-background-networking", "--disable-component-update", "--disable-sync"]
_SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"]


@pytest.fixture(scope="module")
def launch() -> Iterator[Callable[[list[str]], Any]]:
    """Return a function that starts a browser with some words."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="the extra browser is not installed")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        pytest.skip("no Chromium is installed")
    with sync_api.sync_playwright() as play:
        yield lambda words: play.chromium.launch(executable_path=chromium, args=[*_QUIET, *words])


@pytest.fixture(scope="module")
def browser(launch: Callable[[list[str]], Any]) -> Any:
    """Return a browser that draws by software."""
    return launch(_SOFTWARE)


@pytest.fixture(scope="module")
def drift(tmp_path_factory: pytest.TempPathFactory) -> tuple[ns.Solution, Path]:
    """Return ten seconds of the drift mode and their page."""
    scenario = registry.load("scenarios", "dumbbell")(mode="drift", t_end=10.0)
    run = ns.simulate(scenario.build(), 10.0, sample_interval=scenario.sample_interval)
    return run, run.to_html(tmp_path_factory.mktemp("page") / "drift.html", title="Drift")
