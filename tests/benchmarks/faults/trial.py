"""Run tests in a copy of a tree in which faults are planted."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.faults.draw import Fault

LIMIT = 1800.0
"""Time after which a run is ended [s]; faults that make tests endless are found by it, too."""
_HANGS = ["--timeout=120", "--override-ini=faulthandler_timeout=150"]
"""Times after which a single test fails, and after which its process ends [s]."""
_FAILED = re.compile(r"^(?:FAILED|ERROR|SUBFAILED(?:\[.*?\])?|SUBFAILED\(.*?\)) (\S+?\.py(?:::.*?)?)(?: - .*)?$", re.M)


@dataclass(frozen=True)
class Trial:
    """What a run of the tests said.

    Attributes
    ----------
    fails : bool
        Whether the run failed.
    failed : list of str
        The tests that failed, by their ids.
    seconds : float
        Wall time [s].
    """

    fails: bool
    failed: list[str]
    seconds: float


def _cache(folder: Path) -> Path:
    """Copy what is compiled already: its names are hashes of sources, so that a fault in them is compiled anew."""
    compiled = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"), "nonsmooth")
    if compiled.is_dir():
        shutil.copytree(compiled, folder / "nonsmooth")
    return folder


def run(tree: Path, faults: list[Fault], words: list[str]) -> Trial:
    """Plant the faults in a copy of a tree and run pytest there.

    Parameters
    ----------
    tree : Path
        Folder of the project, under git.
    faults : list of Fault
        What is planted.
    words : list of str
        Arguments of pytest.
    """
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "tree")
        listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        for name in subprocess.run(listed, cwd=tree, check=True, capture_output=True, text=True).stdout.split("\0"):
            if name and (tree / name).is_file():
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(tree / name, copy / name)
        # a later piece of a line first: an earlier one may change the length of the line
        for fault in sorted(faults, key=lambda f: (f.file, f.line, f.column), reverse=True):
            fault.plant(copy)
        environment = os.environ | {"PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(_cache(Path(folder, "cache")))}
        command = [sys.executable, "-m", "pytest", "-q", "-rfE", "--tb=no", "-p", "no:cacheprovider", *_HANGS, *words]
        began = time.monotonic()
        try:
            done = subprocess.run(
                command, cwd=copy, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            return Trial(True, [], time.monotonic() - began)
        failed = list(dict.fromkeys(_FAILED.findall(done.stdout)))
        return Trial(done.returncode != 0, failed, time.monotonic() - began)
