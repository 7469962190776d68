"""A user's own module of the name of one of our packages."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

Start = Callable[..., subprocess.Popen[str]]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "content", "words"),
    [
        ("laws.py", "1 +", ("list", "laws")),
        ("laws/__init__.py", "", ("list", "laws")),
        ("laws.py", "", ("run", "tiny")),  # not the file's own group: a scenario that needs the laws
        ("bodies.py", "import laws", ("show", "ball")),
    ],
)
def test_the_file_that_hides_a_package_is_named(
    start: Start, tmp_path: Path, file: str, content: str, words: tuple[str, ...]
) -> None:
    own = tmp_path / file
    own.parent.mkdir(exist_ok=True)
    own.write_text(content)
    process = start(*words)
    output, errors = process.communicate(timeout=120)
    package = own.relative_to(tmp_path).parts[0].removesuffix(".py")
    assert f"The file {own} hides the package {package!r} that comes with nonsmooth: rename it." in errors
    assert "Traceback" not in errors
    assert process.returncode == (0 if words[0] == "list" else 1)
    # what is said of a name goes on in the lines below it, farther in
    listed = [line.split()[0] for line in output.splitlines() if not line.startswith("   ")]
    # the only law of another package is in a scenario that imports laws of the hidden one
    assert listed == (["laws:", "none"] if words[0] == "list" else [])


@pytest.mark.slow
def test_a_script_is_told_when_it_imports_nonsmooth(tmp_path: Path) -> None:
    """Of the file that hides a package, and not of a folder without modules, which hides none."""
    own = tmp_path / "bodies.py"
    own.touch()
    (tmp_path / "laws").mkdir()
    (tmp_path / "scenarios.py").touch()  # which no script imports
    (tmp_path / "script.py").write_text("import nonsmooth\nfrom laws import Coulomb\nfrom bodies import Ball\n")
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    words = [sys.executable, "script.py"]
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    told = (
        f"script.py:1: HiddenPackage: The file {own} hides the package 'bodies' that comes with nonsmooth: rename it."
    )
    assert told in done.stderr
    assert done.stderr.count("HiddenPackage") == 1
    assert "cannot import name 'Ball'" in done.stderr.splitlines()[-1]
