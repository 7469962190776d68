"""Files and folders of a command: checked before the computation begins, filled with pictures and texts at its end."""

from __future__ import annotations

import contextlib
import importlib.util
import traceback
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, final

from nonsmooth.cli.parse.options import flag
from nonsmooth.cli.report.messages import complain, say, tell
from nonsmooth.errors import InvalidInput, MissingPackagesError, NonsmoothError
from nonsmooth.storage import files

OVERWRITE = flag("--overwrite", "write there even if something is there already")
_REMEDY = f"Choose another name, or add {OVERWRITE.name}."
_DPI = 150
"""Resolution of pictures [dots per inch]."""


def require_matplotlib() -> None:
    """Raise MissingPackagesError unless matplotlib is installed; it is not imported."""
    if importlib.util.find_spec("matplotlib") is None:
        raise MissingPackagesError('--out needs matplotlib: pip install "nonsmooth[full]"')


def without_display() -> None:
    """Make matplotlib draw to files only, so that it needs no display."""
    import matplotlib

    matplotlib.use("Agg")


def prepare_folder(folder: Path, overwrite: bool, remedy: str = _REMEDY) -> None:
    """Create a folder; InvalidInput if it cannot be created, or it has content and ``overwrite`` is false."""
    if not overwrite and folder.is_dir() and any(folder.iterdir()):
        raise InvalidInput(str(folder), "must be a folder that is empty or new", "a folder with files", remedy)
    files.prepare(folder)


def prepare_file(path: Path, overwrite: bool) -> None:
    """Create the folder of a file; InvalidInput if it cannot be created, or the file exists without ``overwrite``."""
    if path.is_dir():
        raise InvalidInput(str(path), "must be a file", "a folder", "Add the name of a file.")
    if not overwrite and path.exists():
        raise InvalidInput(str(path), "must be a new file", "there already", _REMEDY)
    try:
        files.prepare(path.parent)
    except InvalidInput as error:
        rule = "must be in a folder that can be written to"
        raise InvalidInput(str(path), rule, error.value, error.remedy) from error


@final
@dataclass(frozen=True)
class Saver:
    """Saves pictures and texts. A failure is printed and noted, and the other files are still saved.

    Attributes
    ----------
    folder : Path or None
        Folder of the pictures and texts; None if the command saves nothing.
    troubles : list of str
        Messages of the failures.
    """

    folder: Path | None
    troubles: list[str] = field(default_factory=list)

    @classmethod
    def of_pictures(cls, folder: Path | None, overwrite: bool) -> Saver:
        """Return a saver of pictures. If a folder is given, it is checked and created."""
        if folder is not None:
            require_matplotlib()
            prepare_folder(folder, overwrite)
            without_display()
        return cls(folder)

    @contextlib.contextmanager
    def noting(self, what: str) -> Iterator[None]:
        """Context that notes and prints an exception instead of raising it; ``what`` names the failing action."""
        try:
            yield
        except NonsmoothError as error:
            self.troubles.append(str(error))
            complain(str(error))
        except Exception as error:  # a fault of a plug-in must not lose the results; its author needs the traceback
            tell(traceback.format_exc())
            self.troubles.append(f"{what} failed: {type(error).__name__}: {error}")
            complain(self.troubles[-1])

    def figures(self, figures: Mapping[str, Any], note: str = "") -> list[Path]:
        """Save matplotlib figures as PNG files of their names, with a note below each; return the written paths."""
        assert self.folder is not None
        paths: list[Path] = []
        for name, figure in figures.items():
            path = self.folder / f"{name.removesuffix('.png')}.png"
            with self.noting(f"figure {name}"):
                with files.replacing(path) as part:
                    figure.text(0.01, -0.01, note, va="top", fontsize=8, color="tab:red")
                    figure.savefig(part, dpi=_DPI, format="png", bbox_inches="tight" if note else None)
                paths.append(path)
        return paths

    def text(self, text: str, name: str) -> Path:
        """Save a text as a file of the folder; return the path of the file."""
        assert self.folder is not None
        path = self.folder / name
        with self.noting(name), files.replacing(path) as part:
            part.write_text(text + "\n", encoding="utf-8")
        return path

    def gallery(self, figures: Mapping[str, Any]) -> bool:
        """Save figures and print their paths; return whether all could be written."""
        say("\n".join(map(str, self.figures(figures))))
        return not self.troubles

    def diagram(self, name: str, draw: Callable[[], Any], numbers: str) -> bool:
        """Save a picture (PNG) and its numbers (CSV) if there is a folder; return whether both could be written."""
        if self.folder is not None:
            say("\n".join(map(str, [*self.figures({name: draw().figure}), self.text(numbers, f"{name}.csv")])))
        return not self.troubles
