"""Moving pictures: so many, so long, and something on them."""

from __future__ import annotations

import shutil
import stat
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import nonsmooth as ns
from nonsmooth.export.camera import VIEWS, Camera
from nonsmooth.export.film import Film
from nonsmooth.export.marks import Marks


def _frames(path: Path) -> Iterator[tuple[NDArray[np.uint8], int]]:
    """Give pictures and how long they are shown [ms]."""
    with Image.open(path) as image:
        for number in range(getattr(image, "n_frames", 1)):
            image.seek(number)
            yield np.asarray(image.convert("RGB")).copy(), int(image.info["duration"])


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["gif", "webp", "png"])
def test_it_lasts_as_long_as_it_is_told_and_shows_the_motion(drift: ns.Solution, tmp_path: Path, kind: str) -> None:
    path = drift.export(tmp_path / f"run.{kind}", speed=0.5, frames_per_second=12, size=240)
    found = list(_frames(path))
    assert len(found) == 1 + round(0.3 / 0.5 * 12 - 0.5)
    assert sum(shown for _, shown in found) == pytest.approx(1000.0 * len(found) / 12, abs=6)
    for picture, _ in found:
        assert np.std(picture) > 10.0
        assert max(picture.shape[:2]) in (240, 292)
    assert np.any(found[0][0] != found[-1][0])


@pytest.mark.slow
@pytest.mark.parametrize("view", VIEWS)
def test_nothing_is_cut_off(cradle: ns.Solution, tmp_path: Path, view: str) -> None:
    """Of balls without a ground the outermost pixels are white, and each view is another picture."""
    pictures = [one for one, _ in _frames(cradle.export(tmp_path / "a.png", view=view, speed=0.05, size=240))]
    for picture in pictures:
        drawn = picture[26:-26]
        assert np.std(drawn) > 10.0
        for edge in (drawn[:, 0], drawn[:, -1]):
            assert np.all(edge == 255)


def test_marks_are_the_contacts_that_stick_and_slip(drift: ns.Solution) -> None:
    times = np.linspace(0.0, 0.3, 200)
    marks, modes = Marks.of(drift, times, 0.01), drift.at(times)["mode"]
    for k, mode in enumerate((1, 2)):
        assert [len(one[k]) for one in marks.places] == np.count_nonzero(modes == mode, axis=1).tolist()
    assert sum(len(one[2]) for one in marks.places) > 0


@pytest.mark.slow
def test_a_gif_keeps_white_and_the_colours_of_marks(drift: ns.Solution, tmp_path: Path) -> None:
    path = drift.export(tmp_path / "a.gif", speed=0.1, frames_per_second=20, size=240)
    shown = [picture @ [1 << 16, 1 << 8, 1] for picture, _ in _frames(path)]
    assert all(picture[0, -1] == 0xFFFFFF for picture in shown)
    assert any(np.any(picture == 0xE69F00) for picture in shown)


def test_a_long_way_is_followed(drift: ns.Solution) -> None:
    """A ball that flies far stays in the middle; what does not go far is seen from one place."""
    from bodies import Ball

    ball = Ball(0.01)
    system = ns.System([ball])
    system.place(ball, position=(0.0, 0.0, 0.0), velocity=(5.0, 0.0, 0.0))
    times = np.linspace(0.0, 1.0, 11)
    film = Film.of(ns.simulate(system, 1.0), times)
    camera = Camera.of(film, "front")
    middle = film.origin[:, 0] @ np.column_stack([camera.across, camera.up])
    np.testing.assert_allclose(0.5 * (camera.low + camera.high), middle, atol=1e-12)
    still = Camera.of(Film.of(drift, np.linspace(0.0, 0.3, 11)), "corner")
    assert np.all(still.low == still.low[0])


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg")
def test_mp4_has_so_many_pictures(drift: ns.Solution, tmp_path: Path) -> None:
    data = drift.export(tmp_path / "run.mp4", size=240).read_bytes()
    assert data[4:8] == b"ftyp"


@pytest.mark.slow
def test_ffmpeg_gets_whole_pictures_and_its_trouble_is_told(
    drift: ns.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    raw = drift.export(tmp_path / "run.mp4", size=240, frames_per_second=10).read_bytes()
    assert len(raw) % (4 * (1 + int(0.3 * 10 + 1e-9))) == 0
    program.write_text("#!/bin/sh\necho no encoder >&2\nexit 1\n")
    with pytest.raises(ns.errors.NonsmoothError, match=r"ffmpeg wrote no MP4: no encoder"):
        drift.export(tmp_path / "run.mp4", size=240, frames_per_second=10)
