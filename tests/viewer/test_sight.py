"""What the first look at a page shows: the whole way, bodies of one colour, forces, numbers that mean something."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, DrivenBody, Hinge, OpenBox, Plate, Rod, Wall
from laws import Coulomb, EnergeticImpact, Unilateral
from tests.viewer.seen import READY, Seen, wait_until

pytestmark = pytest.mark.xdist_group("browser")  # one browser for all
_LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.2), "impact": EnergeticImpact(0.4)}
_CORNERS = """() => { const { world } = view; world.draw(view.t, -1, 1); world.scene.updateMatrixWorld(true);
    return world.run.told.parts.filter((part) => !part.sheet).map((part) => world.frames[part.frame].position.clone()
        .project(world.camera).toArray()); }"""
_SPELLED = """() => { const found = []; const pen = CanvasRenderingContext2D.prototype; const kept = pen.fillText;
    pen.fillText = function (text, x, y) { const size = this.measureText(text).width;
        const left = x - size * { left: 0, center: 0.5, right: 1 }[this.textAlign];
        found.push([text, left, left + size]); kept.call(this, text, x, y); };
    view.draw(); pen.fillText = kept; return [found, view.at('strips').clientWidth]; }"""

_HEIGHTS = "view.timeline.energies.map(([, levels]) => levels.map((level) => level / view.timeline.top))"
"""Heights of the kinetic, the potential energy and the sum at each time, relative to the strip."""


def _sliding(distance: float) -> ns.Solution:
    """Return the run of a block of 50 mm that slides over a plate to a wall."""
    floor, wall, block = Plate(), Wall(normal=(-1.0, 0.0, 0.0), point=(distance, 0.0, 0.0)), BoxBody(0.05, 0.04, 0.02)
    system = ns.System([floor, wall, block])
    system.contact(floor, block, **{**_LAWS, "friction": Coulomb(0.0)})
    system.contact(wall, block, **_LAWS)
    ns.touching(system, block, velocity=(distance, 0.0, 0.0))
    return ns.simulate(system, 1.2)


def _pendulum() -> ns.Solution:
    """Return the run of two rods that swing."""
    base, upper, lower = DrivenBody(), Rod(0.3, 0.005), Rod(0.3, 0.005)
    system = ns.System([base, upper, lower])
    system.joint(Hinge((0.0, 0.0, 0.0), (-0.15, 0.0, 0.0)), base, upper)
    system.joint(Hinge((0.15, 0.0, 0.0), (-0.15, 0.0, 0.0)), upper, lower)
    system.place(upper, position=(0.15, 0.0, 0.0))
    system.place(lower, position=(0.45, 0.0, 0.0))
    return ns.simulate(system, 2.0)


def _see(browser: Any, run: ns.Solution, folder: Path, **words: Any) -> Seen:
    return Seen(browser, run.to_html(folder / "page.html"), **words)


def test_the_whole_way_is_in_the_first_picture(browser: Any, tmp_path: Path) -> None:
    seen = _see(browser, _sliding(0.8), tmp_path)
    assert not seen("view.world.follow")
    assert not seen("view.at('follow').checked")
    for time in ("view.run.t0", "view.run.t1"):
        seen(f"view.go({time})")
        (place,) = seen(_CORNERS)
        assert np.max(np.abs(place[:2])) < 1.0
    # the wall shows its upper side
    assert seen("view.world.sheets.map((sheet) => sheet.face.visible)") == [True, True]


def test_the_camera_goes_with_a_body_whose_way_is_long_and_keeps_its_distance(browser: Any, tmp_path: Path) -> None:
    seen = _see(browser, _sliding(4.0), tmp_path)
    assert seen("view.world.follow")
    size = seen("2 * view.world.reach / (view.world.camera.position.distanceTo(view.world.controls.target))")
    # the angle of the body beside that of the picture, of 35 degrees
    assert 0.1 < size / (2.0 * np.tan(np.radians(17.5))) < 0.4


@pytest.mark.parametrize("width", [400, 1280])
def test_a_rod_has_one_colour_and_its_joints_a_mark(browser: Any, tmp_path: Path, width: int) -> None:
    seen = _see(browser, _pendulum(), tmp_path, viewport={"width": width, "height": 800})
    kinds = seen("view.run.told.strokes.map((stroke) => stroke.frames[0] === stroke.frames[1])")
    assert kinds == [False, False]
    script = """view.world.frames.map((frame) => frame.children.filter((one) => one.type === 'Group').map((ring) =>
        ring.position.toArray()))"""
    base, upper, lower = seen(script)
    assert base == [[0, 0, 0]]
    assert upper == [[-0.15, 0, 0], [0.15, 0, 0]]
    assert lower == [[-0.15, 0, 0]]


def test_walls_that_face_away_are_outlines(browser: Any, tmp_path: Path) -> None:
    box, ball = OpenBox(0.1, 0.1), Ball(0.02)
    system = ns.System([box, ball])
    system.exclude(box, ball)
    system.place(ball, position=(0.0, 0.0, 0.3))
    seen = _see(browser, ns.simulate(system, 0.2), tmp_path)
    faces = "view.world.sheets.map(({ face, grid, edge }) => [face.visible, grid.visible, edge.visible])"
    # floor, then the walls at -x, x, -y and y, seen from x and -y
    shown = [True, True, False, False, True]
    assert seen(faces) == [[one, one, True] for one in shown]


def test_forces_at_rest_are_seen(browser: Any, tmp_path: Path) -> None:
    box, balls = OpenBox(0.1, 0.1), [Ball(0.015), Ball(0.02)]
    system = ns.System([box, *balls])
    system.contact_all(ns.Materials({}, default=ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.3))))
    for i, ball in enumerate(balls):
        system.place(ball, position=(0.05 * i - 0.02, 0.0, 0.6 + 0.1 * i))
    seen = _see(browser, ns.simulate(system, 1.5), tmp_path)
    seen("view.go(view.run.t1)")
    script = """() => { const { world } = view; const away = world.camera.position.distanceTo(world.controls.target);
        const pixel = 2 * away * Math.tan(Math.PI * 35 / 360) / world.renderer.domElement.clientHeight;
        return world.arrows.pool.filter((one) => one.visible).map((one) => [one.children[0].scale.x / pixel,
            one.userData.length / pixel, one.children[0].material.opacity,
            one.children[0].material.color.getHexString()]); }"""
    found = seen(script)
    assert len(found) >= 2
    assert {colour for *_, colour in found} <= {"009e73", "0072b2", "e69f00"}
    pushes = [row for row in found if row[3] == "009e73"]
    # half widths and lengths in pixels
    assert max(row[0] for row in pushes) > 1.0
    assert min(row[1] for row in pushes) > 5.0
    assert all(row[2] == 1 for row in pushes)


def test_arrows_leave_the_bodies_in_sight(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    seen = Seen(browser, drift[1])
    strongest = seen("view.run.strength.reduce((most, one, i, all) => (one > all[most] ? i : most), 0)")
    seen(f"view.stepTo({strongest})")
    assert max(seen("view.world.arrows.lengths()")) <= 0.21 * seen("view.world.span")


def test_round_off_of_energies_is_shown_as_nothing(browser: Any, tmp_path: Path) -> None:
    seen = _see(browser, _pendulum(), tmp_path)
    for part in (0.0, 0.137, 0.5, 1.0):
        seen(f"view.go({part} * view.run.t1)")
        kinetic, potential, *others = (cell.inner_text() for cell in seen.page.query_selector_all("#energies td"))
        assert others == ["0.00000"] * 3
        assert float(kinetic) == pytest.approx(-float(potential), abs=2e-5)


def test_energies_at_rest_are_flat_lines_in_the_strip(browser: Any, tmp_path: Path) -> None:
    floor, boxes = Plate(), [BoxBody(0.2, 0.1, 0.06) for _ in range(3)]
    system = ns.System([floor, *boxes])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.5), EnergeticImpact(0.3)))
    for i, box in enumerate(boxes):
        system.place(box, position=(0.0, 0.0, 0.06 + 0.12 * i))
    run = ns.simulate(system, 0.5)
    assert np.max(run.history("kinetic_energy")["kinetic_energy"]) > 0.0
    assert np.max(np.ptp(_see(browser, run, tmp_path)(_HEIGHTS), axis=0)) < 0.01


def test_the_strip_is_as_high_as_the_energy_exchanged(browser: Any, tmp_path: Path) -> None:
    kinetic, potential, total = np.ptp(_see(browser, _pendulum(), tmp_path)(_HEIGHTS), axis=0)
    # the pendulum starts at rest and horizontal, and loses nothing
    assert min(kinetic, potential) > 0.9
    assert total < 1e-5


def test_energies_have_a_unit_of_their_size(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    run, path = drift
    seen = Seen(browser, path)
    # between its knots the player goes straight
    time = seen("(view.go(view.run.time[1234]), view.t)")
    assert seen.page.inner_text("#energies caption") == "energies [mJ]"
    shown = [float(cell.inner_text()) for cell in seen.page.query_selector_all("#energies td")]
    names = ("kinetic_energy", "potential_energy", "restitution_loss")
    expected = list(run.history(*names, times=time).values())
    np.testing.assert_allclose(shown[:3], 1e3 * np.array(expected), atol=6e-5)


def test_times_have_as_many_digits_at_any_time(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    seen = Seen(browser, drift[1])
    found = []
    for time in (0.0, 0.5, 1.0 / 3.0, 9.0):
        seen(f"view.go({time})")
        found.append(seen.page.inner_text("#clock"))
    assert found == ["0.0000000 s", "0.5000000 s", "0.3333333 s", "9.0000000 s"]


def test_modes_break_after_commas_alone(browser: Any, tmp_path: Path) -> None:
    balls: Sequence[Ball] = [Ball(0.01) for _ in range(12)]
    floor = Plate()
    system = ns.System([floor, *balls])
    for i, ball in enumerate(balls):
        system.contact(floor, ball, **_LAWS)
        system.place(ball, position=(0.05 * i, 0.0, 0.01))
    seen = _see(browser, ns.simulate(system, 0.1), tmp_path)
    lines = seen("""() => { const range = document.createRange(); const word = view.at('word'); const found = {};
        for (const node of word.childNodes) for (let i = 0; i < (node.data ?? '').length; i++) {
            range.setStart(node, i); range.setEnd(node, i + 1);
            const top = Math.round(range.getBoundingClientRect().top); found[top] = (found[top] ?? '') + node.data[i]; }
        return Object.values(found); }""")
    assert "".join(lines) == "{111111111111,000000000000,000000000000}"
    assert len(lines) > 1
    assert all(line.endswith((",", "}")) for line in lines)


def test_labels_of_the_strips_are_whole_and_names_keep_their_ends(browser: Any, tmp_path: Path) -> None:
    floor, balls = Plate(), [Ball(0.01), Ball(0.01)]
    system = ns.System([floor, *balls])
    system.name(floor, "a plate of a long name")
    for i, ball in enumerate(balls):
        system.contact(floor, ball, **_LAWS)
        system.place(ball, position=(0.05 * i, 0.0, 0.01))
    found, width = _see(browser, ns.simulate(system, 1.0), tmp_path)(_SPELLED)
    assert "1.0" in [text for text, *_ in found]
    assert all(left >= 0.0 and right <= width for _, left, right in found)
    lanes = [text for text, *_ in found if "…" in text]
    assert len({*lanes}) == 2
    assert sorted(text[-8:] for text in lanes) == ["- ball 1", "- ball 2"]


def test_a_page_of_its_own_plays_at_once(browser: Any, tmp_path: Path) -> None:
    seen = _see(browser, _sliding(0.8), tmp_path, reduced_motion="no-preference")
    wait_until(seen.page, "view.t > view.run.t0")
    assert seen("view.playing")
    assert not seen.page.is_visible("#start")
    # who steps to an event stays there
    seen("view.stepTo(1)")
    seen.page.wait_for_timeout(100)
    assert not seen("view.playing")
    assert seen("view.t") == seen("view.run.event_time[1]")


def test_who_wants_no_motion_is_asked(browser: Any, tmp_path: Path) -> None:
    seen = _see(browser, _sliding(0.8), tmp_path)
    seen.page.wait_for_timeout(100)
    assert seen("[view.playing, view.t]") == [False, 0]
    seen.page.click("#start")
    wait_until(seen.page, "view.t > view.run.t0")
    assert not seen.page.is_visible("#start")


def test_in_a_frame_it_waits(browser: Any, tmp_path: Path) -> None:
    outer = tmp_path / "notebook.html"
    outer.write_text(f"<!DOCTYPE html><body>{_sliding(0.8)._repr_html_()}</body>", encoding="utf-8")
    page = browser.new_page()
    page.goto(outer.as_uri())
    frame = page.frames[1]
    wait_until(frame, READY)
    page.wait_for_timeout(100)
    assert frame.evaluate("[view.playing, view.t]") == [False, 0]
    assert frame.is_visible("#start")
    frame.evaluate("view.stepTo(1)")
    assert not frame.is_visible("#start")


def test_speeds_are_told_in_words(browser: Any, drift: tuple[ns.Solution, Path]) -> None:
    words = Seen(browser, drift[1])("[...view.at('speed').options].map((one) => [Number(one.value), one.text])")
    assert [1, "real time"] in words
    assert [0.05, "20 \u00d7 slower"] in words
