"""Pages that play a run: in a file, in the browser, in a notebook."""

from __future__ import annotations

import html
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from nonsmooth.checks import path_of
from nonsmooth.storage.files import replacing
from nonsmooth.viewer.page import page

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

MOST_KNOTS = 4000
"""Default of the largest number of times at which a page shows the poses of the bodies, in addition to the instants of
events."""


def write(solution: Solution, path: Path | str, title: str, most_knots: int) -> Path:
    """Write the page of a run to a file; return its path."""
    found = path_of("to_html: path", path)
    text = page(solution, title, most_knots)
    with replacing(found) as part:
        part.write_text(text, encoding="utf-8")
    return found


def show(solution: Solution, title: str, most_knots: int) -> tuple[Path, bool]:
    """Write the page of a run to a new temporary file and open it; return its path, and True if a browser was found."""
    folder = Path(tempfile.mkdtemp(prefix="nonsmooth-"))
    path = write(solution, folder / "run.html", title, most_knots)
    return path, webbrowser.open(path.as_uri())


def not_opened(path: Path) -> str:
    """Message if no browser was found, as on a machine without a display."""
    return f"no browser was found; open this file: {path}"


def framed(solution: Solution) -> str:
    """HTML of a frame with the page of a run, for notebooks."""
    text = html.escape(page(solution, "", MOST_KNOTS))
    words = 'sandbox="allow-scripts" title="a run of nonsmooth" style="width:100%;height:600px;border:0"'
    return f'<iframe srcdoc="{text}" {words}></iframe>'
