"""Output: the folder of the results of a run, with their origin."""

from __future__ import annotations

import functools
import platform
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any, final

from nonsmooth.checks import check_kind, path_of
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothWarning

SOLUTION = "solution.zarr"
"""The folder of arrays within that of the results."""


@final
@dataclass(frozen=True)
class Output:
    """Where the results of a run go.

    Parameters
    ----------
    folder : Path
        The folder of the results; the solution is in ``solution.zarr`` there.
    title : str
        One line that says what it is.
    request : mapping
        The words by which the command line was asked for the scenario, its parameters and laws; empty elsewhere.
    parameters : mapping
        All parameters of the scenario, as JSON has them.
    overwrite : bool
        Whether a run that has ended there is replaced.
    """

    folder: Path
    title: str = ""
    request: Mapping[str, Any] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)
    overwrite: bool = True

    def __post_init__(self) -> None:
        check_kind("Output.folder", self.folder, Path, 'For example pathlib.Path("results").')

    @classmethod
    def to(cls, where: Output | Path | str) -> Output:
        """Output that is meant by it or by its folder.

        Raises
        ------
        InvalidInput
            If it is no folder, or a text without a letter.
        """
        return where if isinstance(where, cls) else cls(path_of("folder of results", where))

    @property
    def solution(self) -> Path:
        """The folder of arrays."""
        return self.folder / SOLUTION


class OtherVersions(NonsmoothWarning):
    """A run or a study is continued with other versions than it began with, so that its last bits may differ."""


@functools.cache
def versions() -> Mapping[str, str]:
    """Versions on which the last bits of a run hang."""
    found = {
        "nonsmooth": version("nonsmooth"),
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "machine": f"{sys.platform} {platform.machine()}",
        "engine": "plain",
    }
    if not PLAIN:
        # the plain half does not import numba
        from nonsmooth.engine.native.folders import build_name

        found |= {"numba": version("numba"), "engine": build_name()}
    return found
