"""Make the pictures of the pages on the viewer and on walls: ``python docs/viewer_pictures.py docs/pages/figures``.

They are pictures of the viewer, so that this needs the extra browser, Chromium and Pillow.
"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

import nonsmooth as ns
from nonsmooth.bodies import Ball, OpenBox, Plate, Wall
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral

_CHROMIUM = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"]
_READY = "document.documentElement.dataset.ready === 'yes'"
_MARKS = ((350, 195), (262, 258), (975, 120), (975, 313), (975, 520), (230, 595))
"""Centres of the numbers 1, 2, ... in the picture of the viewer [pixels]."""
_NUMBER = """([x, y, number]) => {
  const mark = document.createElement("div");
  mark.textContent = number;
  mark.style.cssText = `position:fixed;left:${x - 15}px;top:${y - 15}px;width:30px;height:30px;border-radius:50%;` +
    "background:#1c2430;color:#fff;font:bold 18px/30px system-ui,sans-serif;text-align:center;z-index:9";
  document.body.append(mark);
}"""
_BODIES_ONLY = "#steer, #panel { display: none !important } main { grid-template: 1fr / 1fr !important }"
_ANGLE = 0.2


def bouncing() -> ns.Solution:
    """Return the run of the page on the viewer."""
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.017), impact=EnergeticImpact(0.7))
    system.place(ball, position=(0.0, 0.0, 0.12), velocity=(0.6, 0.0, 0.0))
    return ns.simulate(system, 1.2)


def on_slope() -> ns.Solution:
    """Return the run of a ball on a slope that ends at a wall."""
    slope = Wall(normal=(np.sin(_ANGLE), 0.0, np.cos(_ANGLE)))
    wall, ball = Wall(normal=(-1.0, 0.0, 0.0), point=(0.3, 0.0, 0.0)), Ball(radius=0.01)
    system = ns.System([slope, wall, ball])
    for plane in (slope, wall):
        system.contact(plane, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    ns.touching(system, ball)
    return ns.simulate(system, 3.0)


def in_box() -> ns.Solution:
    """Return the run of four balls in an open box."""
    box, balls = OpenBox(half_x=0.03, half_y=0.04), [Ball(0.01) for _ in range(4)]
    system = ns.System([box, *balls])
    system.contact_all(ns.ContactLaws(normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5)))
    random = np.random.default_rng(0)
    for number, ball in enumerate(balls):
        place = (0.015 * (-1) ** number, 0.0, 0.02 + 0.025 * number)
        system.place(ball, position=place, velocity=tuple(random.uniform(-0.5, 0.5, 3)))
    return ns.simulate(system, 1.0)


def picture(browser: Any, run: ns.Solution, size: tuple[int, int], steps: list[str], title: str = "") -> Image.Image:
    """Return a picture of the viewer after scripts; with a title, all of the page and its numbers."""
    page = browser.new_page(
        viewport={"width": size[0], "height": size[1]}, color_scheme="light", reduced_motion="reduce"
    )
    with tempfile.TemporaryDirectory() as folder:
        page.goto(run.to_html(Path(folder) / "run.html", title=title).as_uri())
        page.wait_for_function(_READY)
    page.add_style_tag(content="#start { display: none !important }" + ("" if title else _BODIES_ONLY))
    page.wait_for_timeout(200)
    for step in steps:
        page.evaluate(step)
    if title:
        for number, (x, y) in enumerate(_MARKS, 1):
            page.evaluate(_NUMBER, [x, y, number])
    page.wait_for_timeout(500)
    shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    page.close()
    return shot


def main() -> None:
    """Save the pictures in the folder given."""
    folder = Path(sys.argv[1])
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=shutil.which("chromium"), args=_CHROMIUM)
        step = "view.step(1)"
        view = picture(browser, bouncing(), (1000, 640), [step, step], "A ball that slides until it rolls")
        slope = picture(browser, on_slope(), (480, 400), ["view._view('front')", "view.go(0.4)"])
        box = picture(browser, in_box(), (480, 400), ["view._view('corner')", "view.go(0.12)"])
        browser.close()
    view.save(folder / "viewer_numbered.webp", quality=85, method=6)
    both = Image.new("RGB", (slope.width + box.width, slope.height), "white")
    both.paste(slope, (0, 0))
    both.paste(box, (slope.width, 0))
    both.save(folder / "walls.webp", quality=85, method=6)


if __name__ == "__main__":
    main()
