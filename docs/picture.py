"""Make the picture of the viewer for the first page: ``python docs/picture.py``; it needs the extra browser, Chromium.

It shows the drift mode over three periods of the plate.
"""

from __future__ import annotations

import io
import shutil
import tempfile
from pathlib import Path

from nonsmooth.scenarios.dumbbell import DumbbellScenario
from PIL import Image
from playwright.sync_api import sync_playwright

import nonsmooth as ns

PICTURE = Path(__file__).parent / "pages" / "figures" / "drift.webp"
_WORDS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"]
_FRAMES, _PERIODS, _FROM = 56, 3, 2.0
_SIZE = {"width": 800, "height": 460}
_STYLE = "#bar, #energies, .key { display: none !important }"


def frames(page_path: Path, period: float) -> list[Image.Image]:
    """Return pictures of the page at equal steps of time."""
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=shutil.which("chromium"), args=_WORDS)
        page = browser.new_page(viewport=_SIZE, color_scheme="light", reduced_motion="reduce")
        page.goto(page_path.as_uri())
        page.wait_for_function("document.documentElement.dataset.ready === 'yes'")
        page.add_style_tag(content=_STYLE)
        end = _FROM + _PERIODS * period
        page.evaluate(f"() => {{ view.timeline.from = {_FROM}; view.timeline.to = {end}; view.speed = 0.05; }}")
        found = []
        for i in range(_FRAMES):
            page.evaluate(f"view.go({_FROM + i * _PERIODS * period / _FRAMES})")
            found.append(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
        browser.close()
    return found


def main() -> None:
    """Run it and write the picture."""
    scenario = DumbbellScenario(mode="drift", t_end=2.5)
    run = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    with tempfile.TemporaryDirectory() as folder:
        path = run.to_html(Path(folder) / "drift.html", title="Drift of a dumbbell on a vibrating plate")
        first, *rest = frames(path, 1.0 / scenario.frequency)
    first.save(PICTURE, save_all=True, append_images=rest, duration=50, loop=0, quality=40, method=6)


if __name__ == "__main__":
    main()
