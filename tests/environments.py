"""A Python environment of its own, fresh for a test, that sees the packages of this one."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sysconfig
import venv
from pathlib import Path

ROOT = Path(__file__).parents[1]


class Environment:
    """A virtual environment in a folder; what a test installs there is gone with it.

    pip works there without a network: it takes no dependencies and builds with the setuptools of this environment.
    """

    def __init__(self, folder: Path) -> None:
        for package in ("pip", "setuptools"):
            assert importlib.util.find_spec(package), f"{package} is missing: pip install '.[test]'"
        self._folder = folder
        venv.create(folder, with_pip=False, symlinks=os.name != "nt")
        scripts = folder / ("Scripts" if os.name == "nt" else "bin")
        self._path = f"{scripts}{os.pathsep}{os.environ['PATH']}"
        self.python = scripts / ("python.exe" if os.name == "nt" else "python")
        known = dict.fromkeys(sysconfig.get_paths()[name] for name in ("purelib", "platlib"))
        own = self._ask("import sysconfig; print(sysconfig.get_paths()['purelib'])")
        lines = [f"import site; site.addsitedir({path!r})\n" for path in known]
        Path(own, "outside.pth").write_text("".join(lines), encoding="utf-8")
        script = scripts / "nonsmooth"
        script.write_text(f'#!/bin/sh\nexec "{self.python}" -m nonsmooth "$@"\n', encoding="utf-8")
        script.chmod(0o755)

    def _ask(self, code: str) -> str:
        return subprocess.run([self.python, "-c", code], check=True, capture_output=True, text=True).stdout.strip()

    @property
    def variables(self) -> dict[str, str]:
        """The environment variables of its processes."""
        kept = {k: v for k, v in os.environ.items() if not k.startswith(("PIP_", "NONSMOOTH_PLAIN", "PYTEST_"))}
        pip = {"NO_INDEX": "1", "NO_DEPS": "1", "NO_BUILD_ISOLATION": "0", "DISABLE_PIP_VERSION_CHECK": "1"}
        pip |= {"ROOT_USER_ACTION": "ignore", "REQUIRE_VIRTUALENV": "0"}
        return kept | {
            "PATH": self._path,
            "VIRTUAL_ENV": str(self._folder),
            "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
            **{f"PIP_{name}": value for name, value in pip.items()},
        }

    def run(self, words: list[str] | str, folder: Path, status: int = 0) -> tuple[str, str]:
        """Return what a command prints to standard output and error; a text is one for the shell.

        It fails unless the exit status is the one expected.
        """
        done = subprocess.run(
            words, cwd=folder, env=self.variables, shell=isinstance(words, str), capture_output=True, text=True
        )
        assert done.returncode == status, f"{words} ends with {done.returncode}\n{done.stdout}\n{done.stderr}"
        return done.stdout, done.stderr

    def nonsmooth(self, *words: str, folder: Path, status: int = 0) -> tuple[str, str]:
        """Return what ``nonsmooth`` prints."""
        return self.run([str(self.python), "-m", "nonsmooth", *words], folder, status)

    def pip(self, *words: str, folder: Path) -> str:
        """Return what pip prints."""
        return self.run([str(self.python), "-m", "pip", *words], folder)[0]
