"""Output of a run: the folder for its results, and the versions of software and the machine that made the results."""

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
"""Name of the folder of arrays, within the folder of results."""


@final
@dataclass(frozen=True)
class Output:
    """Folder for the results of a run, with the origin of the run.

    Parameters
    ----------
    folder : Path
        The folder of the results; the solution is in ``solution.zarr`` there.
    title : str
        Title of the run, one line.
    request : mapping
        Arguments of the command line for scenario, parameters and laws; empty for a run that a script started.
    parameters : mapping
        All parameters of the scenario, as values of JSON.
    overwrite : bool
        True if new results may replace those of a finished run in the folder.
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
        """Output for a folder; an Output is returned unchanged.

        Raises
        ------
        InvalidInput
            `where` is not a path, is empty, or is a path that this machine cannot have.
        """
        return where if isinstance(where, cls) else cls(path_of("folder of results", where))

    @property
    def solution(self) -> Path:
        """The folder of arrays."""
        return self.folder / SOLUTION


class OtherVersions(NonsmoothWarning):
    """A run or a study continues with other versions of the software than it began with; its last bits may differ."""


@functools.cache
def versions() -> Mapping[str, str]:
    """Versions of nonsmooth and its packages, and the platform, by name.

    With other versions or on another platform, the last bits of a run may differ.
    """
    found = {
        "nonsmooth": version("nonsmooth"),
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "machine": f"{sys.platform} {platform.machine()}",
        "engine": "plain",
    }
    if not PLAIN:
        # plain Python (NONSMOOTH_PLAIN=1) does not need this module, which imports llvmlite
        from nonsmooth.engine.native.folders import build_name

        found |= {"numba": version("numba"), "engine": build_name()}
    return found
