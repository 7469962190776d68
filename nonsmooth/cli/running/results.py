"""The files of a run or a gallery; a failure is told at once, noted, and keeps nothing else from being saved."""

from __future__ import annotations

import contextlib
import traceback
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from nonsmooth.cli.telling.messages import complain, tell
from nonsmooth.errors import NonsmoothError
from nonsmooth.storage.files import replacing

_DPI = 150


@contextlib.contextmanager
def noting(troubles: list[str], what: str) -> Iterator[None]:
    """Note and tell a failure instead of raising it."""
    try:
        yield
    except NonsmoothError as error:
        troubles.append(str(error))
        complain(str(error))
    except Exception as error:  # a plug-in's mistake must not cost the results; its author needs the trace
        tell(traceback.format_exc())
        troubles.append(f"{what} failed: {type(error).__name__}: {error}")
        complain(troubles[-1])


def without_display() -> None:
    """Let matplotlib draw into files only, on machines without a screen too."""
    import matplotlib

    matplotlib.use("Agg")


def save_figures(figures: Mapping[str, Any], folder: Path, troubles: list[str], note: str = "") -> list[Path]:
    """Save matplotlib figures as PNG by name, with a note below each; return the paths of those that were written."""
    paths: list[Path] = []
    frame = "tight" if note else None
    for name, figure in figures.items():
        path = folder / f"{name.removesuffix('.png')}.png"
        with noting(troubles, f"figure {name}"):
            with replacing(path) as part:
                figure.text(0.01, -0.01, note, va="top", fontsize=8, color="tab:red")
                figure.savefig(part, dpi=_DPI, format="png", bbox_inches=frame)
            paths.append(path)
    return paths


def save_text(text: str, path: Path, troubles: list[str]) -> None:
    """Save a text."""
    with noting(troubles, path.name), replacing(path) as part:
        part.write_text(text + "\n", encoding="utf-8")
