"""The two sides of a comparison: a tree of files each, with an environment of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import venv
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
"""The working tree."""
COMPARED = ("nonsmooth", "bodies", "laws", "scenarios", "tests", "pyproject.toml", "README.md", "LICENSE")
"""What is copied of either side."""
_RUNNER = Path("tests/benchmarks/against")
_ADAPTER = Path("tests/benchmarks/described")
_EXTRA = "full"
"""The extra with which the runs are made."""


@dataclass(frozen=True)
class Side:
    """One of the two trees.

    Attributes
    ----------
    name : str
        "this" or "other".
    folder : Path
        Holds the tree, what says which entry points it has, and its cache.
    python : Path
        The interpreter of its environment.
    """

    name: str
    folder: Path
    python: Path = Path(sys.executable)

    @property
    def tree(self) -> Path:
        """The files of the commit."""
        return self.folder / "tree"

    @property
    def cache(self) -> Path:
        """Where its compiled code is kept."""
        return self.folder / "cache"

    @property
    def project(self) -> dict[str, Any]:
        """What the tree's project file says of it."""
        text = (self.tree / "pyproject.toml").read_text(encoding="utf-8")
        project: dict[str, Any] = tomllib.loads(text)["project"]
        return project

    @property
    def environment(self) -> dict[str, str]:
        """Variables with which Python imports this tree before anything that is installed."""
        path = os.pathsep.join(map(str, (self.folder / "installed", self.tree)))
        own = {"PYTHONPATH": path, "PYTHONSAFEPATH": "1", "XDG_CACHE_HOME": str(self.cache)}
        # bytecode is kept as for an installed package, but in this folder
        bytecode = {"PYTHONPYCACHEPREFIX": str(self.folder / "bytecode"), "PYTHONDONTWRITEBYTECODE": ""}
        return os.environ | own | bytecode

    def fill_cache(self) -> None:
        """Take over what the user's cache has; its files are named after the source that was compiled."""
        home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "nonsmooth"
        target = self.cache / "nonsmooth"
        if home.is_dir() and not target.exists():
            shutil.copytree(home, target)

    def command(self, *words: str) -> list[str]:
        """Return the command that runs a module on this side."""
        return [str(self.python), "-m", *words]


def snapshot(folder: Path) -> Side:
    """Return a side with the working tree as it is now, uncommitted changes included."""
    listed = _git("ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *COMPARED)
    side = _empty("this", folder)
    for name in filter(None, listed.decode().split("\0")):
        if (ROOT / name).is_file():
            target = side.tree / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, target)
    return _prepared(side)


def commit(revision: str, folder: Path, this: Side) -> Side:
    """Return a side with the tree of a commit, with this side's runner, and its adapter if the commit has none."""
    side = _empty("other", folder)
    with tarfile.open(fileobj=BytesIO(_git("archive", "--format=tar", revision, "--", *COMPARED))) as archive:
        archive.extractall(side.tree, filter="data")
    shutil.rmtree(side.tree / _RUNNER, ignore_errors=True)
    shutil.copytree(this.tree / _RUNNER, side.tree / _RUNNER)
    if not (side.tree / _ADAPTER).exists():
        shutil.copytree(this.tree / _ADAPTER, side.tree / _ADAPTER)
    if _needs(side) != _needs(this):
        side = replace(side, python=_installed(side))
    return _prepared(side)


def _needs(side: Side) -> list[str]:
    """Return the packages that a run needs, sorted."""
    project = side.project
    return sorted([*project["dependencies"], *project["optional-dependencies"][_EXTRA]])


def _installed(side: Side) -> Path:
    """Make an environment with the dependencies of a side, and return its interpreter."""
    home = side.folder / "environment"
    venv.create(home, with_pip=True, clear=True)
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-compile", f"{side.tree}[{_EXTRA}]"], check=True)
    return python


def resolved(revision: str) -> str:
    """Return the hash of a commit."""
    return _git("rev-parse", "--verify", f"{revision}^{{commit}}").decode().strip()


def _git(*words: str) -> bytes:
    return subprocess.run(["git", *words], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout


def _empty(name: str, folder: Path) -> Side:
    side = Side(name, folder / name)
    shutil.rmtree(side.tree, ignore_errors=True)
    side.tree.mkdir(parents=True)
    side.cache.mkdir(exist_ok=True)
    return side


def _prepared(side: Side) -> Side:
    """Write what an installation would say of the tree: its name, version and entry points."""
    project = side.project
    described = side.folder / "installed" / f"{project['name']}-{project['version']}.dist-info"
    described.mkdir(parents=True, exist_ok=True)
    head = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (described / "METADATA").write_text(head, encoding="utf-8")
    points = {"console_scripts": project["scripts"]} | project["entry-points"]
    groups = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in rows.items()) for group, rows in points.items()]
    (described / "entry_points.txt").write_text("\n".join(groups), encoding="utf-8")
    return side
