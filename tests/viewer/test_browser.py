"""The player in a browser, from a file: what it shows is what the run was."""

from __future__ import annotations

import html
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.plugins import registry
from tests.viewer.seen import READY, Seen, wait_until

pytestmark = pytest.mark.xdist_group("browser")  # one browser for all


@pytest.mark.slow
def test_it_asks_for_one_file_and_complains_of_nothing(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    seen = Seen(browser, drift[1])
    seen("view.play(true)")
    seen.page.wait_for_timeout(500)
    seen("view.play(false)")
    assert seen("view.t") > 0.0
    assert len([url for url in seen.requests if not url.startswith("data:")]) == 1
    assert seen.errors == []
    assert drift[1].stat().st_size < 1.5e6


def test_every_event_that_is_stepped_to_shows_its_time_and_words(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    run, path = drift
    events, seen = run.events, Seen(browser, path)
    script = """(n) => { const found = []; view.world = null; view.go(view.run.t0);
        const said = (id) => document.getElementById(id).textContent;
        for (let e = 0; e < n; e++) { view.stepTo(e); found.push([view.t, said('event'), said('word')]) }
        return found; }"""
    found = seen.page.evaluate(script, len(events))
    assert [time for time, _, _ in found] == events.time.tolist()
    columns = [events.words(which) for which in ("before", "during", "after")]
    for number, (_, text, word) in enumerate(found):
        words = " → ".join(column[number] for column in columns)
        assert text.startswith(f"Event {number + 1} of {len(events)}, {events.causes()[number]}")
        assert text.endswith(f". {words}")
        assert word == columns[2][number]


def test_keys_step_from_event_to_event(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    run, path = drift
    seen = Seen(browser, path)
    for _ in range(5):
        seen.page.keyboard.press("]")
    assert (seen("view.event"), seen("view.t")) == (4, run.events.time[4]) or seen("view.event") == 5
    here = seen("view.event")
    seen.page.keyboard.press("[")
    assert seen("view.event") == here - 1
    seen.page.keyboard.press("End")
    assert seen("view.t") == run.t_end


def test_arrows_are_as_long_as_impulses(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    run, path = drift
    events, seen = run.events, Seen(browser, path)
    seen("view.at('forces').click()")
    ratios = []
    for number in range(400, 460):
        seen(f"view.stepTo({number})")
        entries = slice(*events.first[number : number + 2])
        sizes = np.linalg.norm(events.listed_impulse[entries], axis=1)
        lengths = seen("view.world.arrows.lengths()")
        assert len(lengths) == np.count_nonzero(sizes)
        ratios += (np.array(lengths) / sizes[sizes > 0.0]).tolist()
    assert len(ratios) > 20
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-5)


def test_bodies_are_drawn(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    seen = Seen(browser, drift[1])
    script = """() => { view.draw(); const gl = view.world.renderer.getContext();
        const out = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
        gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, out);
        const blue = []; for (let i = 0; i < out.length; i += 4) if (out[i + 2] > out[i] + 40) blue.push(i);
        return [out.length / 4, blue.length]; }"""
    total, blue = seen(script)
    assert 0.001 < blue / total < 0.5


def test_without_webgl_it_says_so_and_keeps_times_and_words(
    launch: Callable[[list[str]], Any], drift: tuple[ns.Solution, Path]
) -> None:
    run, path = drift
    seen = Seen(launch(["--disable-gpu", "--disable-3d-apis"]), path)
    assert "WebGL" in seen.page.inner_text("#trouble")
    seen("view.stepTo(7)")
    assert seen("view.t") == run.events.time[7]
    assert seen.page.inner_text("#word") == run.events.words("after")[7]


@pytest.mark.parametrize("part", [0.999, 0.9, 0.75])
def test_a_file_that_is_cut_short_says_so(
    browser: Any, drift: tuple[ns.Solution, Path], tmp_path: Path, part: float
) -> None:
    text = drift[1].read_text(encoding="utf-8")
    short = tmp_path / "short.html"
    short.write_text(text[: int(part * len(text))], encoding="utf-8")
    seen = Seen(browser, short)
    assert "cut short" in seen.page.inner_text("#failure")


def test_a_file_that_ends_before_its_player_says_so(
    browser: Any, drift: tuple[ns.Solution, Path], tmp_path: Path
) -> None:
    text = drift[1].read_text(encoding="utf-8")
    short = tmp_path / "short.html"
    short.write_text(text[:20_000], encoding="utf-8")
    page = browser.new_page()
    page.goto(short.as_uri())
    assert "cut short" in page.inner_text("#cut")


def test_another_format_is_refused_by_name(browser: Any, drift: tuple[ns.Solution, Path], tmp_path: Path) -> None:
    text = drift[1].read_text(encoding="utf-8").replace("nonsmooth-view/1", "nonsmooth-view/9", 1)
    assert "nonsmooth-view/9" in text
    other = tmp_path / "other.html"
    other.write_text(text, encoding="utf-8")
    assert "nonsmooth-view/9" in Seen(browser, other).page.inner_text("#failure")


def test_it_plays_in_the_frame_of_a_notebook(browser: Any, drift: tuple[ns.Solution, Path], tmp_path: Path) -> None:
    outer = tmp_path / "notebook.html"
    outer.write_text(f"<!DOCTYPE html><body>{drift[0]._repr_html_()}</body>", encoding="utf-8")
    page = browser.new_page()
    page.goto(outer.as_uri())
    frame = page.frames[1]
    wait_until(frame, READY)
    frame.evaluate("view.stepTo(3)")
    assert frame.evaluate("view.t") == drift[0].events.time[3]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_can_be_used_without_seeing_or_a_mouse(browser: Any, drift: tuple[ns.Solution, Path], scheme: str) -> None:
    axe = pytest.importorskip("axe_core_python.sync_playwright", reason="the extra browser is not installed")
    seen = Seen(browser, drift[1], color_scheme=scheme)
    seen("view.stepTo(5)")
    found = axe.Axe().run(seen.page)["violations"]
    assert [(one["id"], one["nodes"][0]["html"]) for one in found] == []


def test_names_of_users_are_text(browser: Any, tmp_path: Path) -> None:
    scenario = registry.load("scenarios", "newtons_cradle")()
    system = scenario.build()
    run = ns.simulate(system, scenario.t_end)
    path = run.to_html(tmp_path / "page.html", title="<img src=x onerror=alert(1)>")
    seen = Seen(browser, path)
    assert seen.page.inner_text("h1") == "<img src=x onerror=alert(1)>"
    assert re.search(r"<img", html.unescape(seen("document.body.innerHTML").split("<script")[0])) is None
