"""Moving pictures: GIF, WebP and PNG by Pillow, MP4 by ffmpeg."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np

from nonsmooth.errors import InvalidInput, MissingPackagesError, NonsmoothError
from nonsmooth.export.camera import VIEWS, Camera
from nonsmooth.export.film import Film
from nonsmooth.export.marks import Marks
from nonsmooth.export.pictures import LOOKS, Pixels, drawn, require, rgb
from nonsmooth.parameters import Rule, check_number
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_RULES = {
    "speed": Rule("time of the run that passes in one second watched", "1", above=0.0),
    # players of GIF show pictures with a duration below 20 ms for 100 ms
    "frames_per_second": Rule("number of pictures in one second watched", "1/s", above=0.0, maximum=50.0),
    "size": Rule("longer side of the pictures in pixels", "1", minimum=240.0, maximum=1920.0),
}
_MOST = 1000
"""Largest number of pictures, because all are in memory until the file is written."""
_SEEN = 0.12
"""Duration in the film for which an impact is marked [s]."""
_DIGITS = np.array([1 << 16, 1 << 8, 1])
_LOOKED_AT = 8
"""Largest number of pictures from which the colours of a GIF are chosen."""


@final
@dataclass(frozen=True)
class Movie:
    """Moving pictures in parallel projection, with marks of contacts that stick or slip, and of impacts.

    Attributes
    ----------
    kind : str
        "gif", "webp", "png" or "mp4".
    view : str
        Direction of view: "corner", "front" along y, "side" along -x or "top".
    speed : float
        Simulated time per time of the film [1]; 0.5 shows the motion at half its speed.
    frames_per_second : float
        Number of pictures per second of the film [1/s].
    size : int
        Longer side of the drawn scene [pixels]; the shorter side depends on the motion.
    """

    kind: str
    view: str = "corner"
    speed: float = 1.0
    frames_per_second: float = 25.0
    size: int = 640

    def __post_init__(self) -> None:
        for name, rule in _RULES.items():
            check_number(f"export: {name}", getattr(self, name), rule)
        if self.view not in VIEWS:
            known = f"must be one of {', '.join(map(repr, VIEWS))}"
            raise InvalidInput("export: view", known, self.view, "It says where the pictures are seen from.")
        require()
        if self.kind == "mp4" and shutil.which("ffmpeg") is None:
            raise MissingPackagesError(
                "MP4 is written by the program ffmpeg, which is not found. Install it (apt install ffmpeg, brew "
                "install ffmpeg, winget install ffmpeg), or name a file that ends in .webp or .gif."
            )

    def write(self, solution: Solution, path: Path) -> None:
        """Write the file of a run."""
        start, step = float(solution.track.time[0]), self.speed / self.frames_per_second
        n = int((solution.t_end - start) / step + 1e-9) + 1
        if n > _MOST:
            rule = f"must leave {_MOST} pictures at most, and {self.frames_per_second:g} a second make {n}"
            raise InvalidInput("export: speed", rule, self.speed, "Raise it, or ask for fewer frames_per_second.")
        times = np.minimum(start + step * np.arange(n), solution.t_end)
        film, marks = Film.of(solution, times), Marks.of(solution, times, max(_SEEN * self.speed, step))
        pictures = drawn(film, marks, Camera.of(film, self.view), int(self.size))
        with replacing(path) as part:
            (self._mp4 if self.kind == "mp4" else self._animated)(pictures, part)

    def _animated(self, pictures: Iterator[Pixels], path: Path) -> None:
        from PIL import Image

        shown = list(pictures)
        images = _few_colours(shown) if self.kind == "gif" else [Image.fromarray(one) for one in shown]
        # a GIF counts time in hundredths of a second
        unit = 10 if self.kind == "gif" else 1
        ends = np.rint(1000.0 / unit / self.frames_per_second * np.arange(len(images) + 1)).astype(int)
        durations: list[int] = (unit * np.diff(ends)).tolist()
        more: dict[str, Any] = {"quality": 85} if self.kind == "webp" else {}
        images[0].save(
            path, self.kind.upper(), save_all=True, append_images=images[1:], duration=durations, loop=0, **more
        )

    def _mp4(self, pictures: Iterator[Pixels], path: Path) -> None:
        first = next(pictures)
        height, width = first.shape[:2]
        raw = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {self.frames_per_second:g}".split()
        packed = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"]
        words = ["ffmpeg", "-loglevel", "error", "-y", *raw, "-i", "-", *packed, str(path)]
        images = b"".join(one.tobytes() for one in (first, *pictures))
        done = subprocess.run(words, input=images, capture_output=True, check=False)
        if done.returncode != 0:
            raise NonsmoothError(f"ffmpeg wrote no MP4: {done.stderr.decode(errors='replace').strip()} Try .webp.")


def _few_colours(pictures: list[Pixels]) -> list[Any]:
    """Pictures with one palette for all: their most frequent colours, and the colours of the marks."""
    from PIL import Image

    looked_at = np.concatenate([one.reshape(-1, 3) for one in pictures[:: -(-len(pictures) // _LOOKED_AT)]])
    numbers, counts = np.unique(looked_at @ _DIGITS, return_counts=True)
    often = numbers[np.argsort(-counts, kind="stable")][: 256 - len(LOOKS)]
    marks = [np.rint(255.0 * rgb(look["color"])) for look in LOOKS.values()]
    palette = np.concatenate([marks, often[:, None] // _DIGITS % 256])
    images = []
    for picture in pictures:
        numbers, places = np.unique(picture @ _DIGITS, return_inverse=True)
        own = numbers[:, None] // _DIGITS % 256
        # the nearest colour p of the palette to x has the least |p|^2 - 2 p x
        nearest = np.argmin(np.sum(palette**2, axis=1) - 2.0 * own @ palette.T, axis=1)
        image = Image.fromarray(nearest[places].reshape(picture.shape[:2]).astype(np.uint8))
        image.putpalette(palette.astype(int).ravel().tolist())
        images.append(image)
    return images
