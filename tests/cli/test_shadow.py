"""A user's own module of the name of one of our packages does no harm, and no class exists twice."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

Start = Callable[..., subprocess.Popen[str]]


@pytest.mark.slow
@pytest.mark.parametrize("words", [("list", "laws"), ("run", "tiny"), ("show", "ball"), ("show", "dumbbell")])
@pytest.mark.parametrize(
    ("file", "content"),
    [("laws.py", "1 +"), ("laws/__init__.py", ""), ("bodies.py", "import laws"), ("scenarios.py", "")],
)
def test_commands_go_as_ever(start: Start, tmp_path: Path, file: str, content: str, words: tuple[str, ...]) -> None:
    expected = _printed(start(*words))
    own = tmp_path / file
    own.parent.mkdir(exist_ok=True)
    own.write_text(content)
    process = start(*words)
    assert _printed(process) == expected
    assert process.returncode == 0


def _printed(process: subprocess.Popen[str]) -> tuple[str, ...]:
    """Output and errors without wall times."""
    return tuple(re.sub(r"\S+ s of wall time", "", text) for text in process.communicate(timeout=120))


def _run(folder: Path, script: str) -> str:
    (folder / "script.py").write_text(script)
    words = [sys.executable, "-W", "error", "script.py"]
    done = subprocess.run(
        words, cwd=folder, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_script_has_its_own_module_and_the_package(tmp_path: Path) -> None:
    (tmp_path / "bodies.py").write_text("Mine = 1\n")
    script = "from bodies import Mine\nfrom nonsmooth.bodies import Ball\nprint(Ball(0.1).radius, Mine)\n"
    assert _run(tmp_path, script) == "0.1 1\n"


@pytest.mark.parametrize(
    "imports",
    [
        ("bodies", "nonsmooth.bodies"),
        ("nonsmooth.bodies", "bodies"),
        ("bodies.shapes.box", "nonsmooth.bodies.shapes.box"),
        ("nonsmooth.bodies.shapes.box", "bodies.shapes.box"),
        ("laws.friction.coulomb", "nonsmooth.laws.friction.coulomb"),
        ("scenarios.dumbbell.scenario", "nonsmooth.scenarios.dumbbell.scenario"),
    ],
)
def test_both_names_are_one_module(tmp_path: Path, imports: tuple[str, str]) -> None:
    """In either order, and its specification is that of the longer name."""
    script = f"""
import sys, {imports[0]}, {imports[1]}
a, b = (sys.modules[name] for name in {imports!r})
assert a is b
assert a.__spec__.name == a.__name__ == {max(imports, key=len)!r}
"""
    assert _run(tmp_path, script) == ""


def test_a_module_that_is_missing_is_named(tmp_path: Path) -> None:
    script = """
import bodies
try:
    import bodies.nothing
except ModuleNotFoundError as error:
    print(error)
"""
    assert _run(tmp_path, script) == "No module named 'bodies.nothing'\n"
