"""``nonsmooth new plugin``: the package that it writes works from the first minute."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import pytest

from tests.environments import Environment

Call = Callable[..., tuple[int, str, str]]


@pytest.mark.slow
def test_its_own_tests_are_green_and_find_a_mistake(call: Call, tmp_path: Path) -> None:
    folder = tmp_path / "somewhere"
    status, output, errors = call("new", "plugin", "wet_sand", "--dir", str(folder))
    assert (status, errors) == (0, "")
    assert sorted(Path(line).relative_to(folder).as_posix() for line in output.split()) == [
        "README.md",
        "pyproject.toml",
        "tests/test_friction.py",
        "tests/test_scenario.py",
        "wet_sand/__init__.py",
        "wet_sand/friction.py",
        "wet_sand/scenario.py",
    ]
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    law = folder / "wet_sand" / "friction.py"
    law.write_text(law.read_text().replace("return kinetic +", "return -kinetic +"))
    done = subprocess.run([*words, "tests/test_friction.py"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 1
    assert "not negative" in done.stdout


@pytest.mark.slow
def test_a_script_in_the_parent_folder_imports_it_after_an_editable_installation(tmp_path: Path) -> None:
    """The folder ``wet_sand`` next to the script must not hide the package ``wet_sand`` within it."""
    environment = Environment(tmp_path / "environment")
    environment.nonsmooth("new", "plugin", "wet_sand", folder=tmp_path)
    environment.pip("install", "-e", "./wet_sand", folder=tmp_path)
    (tmp_path / "script.py").write_text("from wet_sand import WetSand\nprint(WetSand().static)\n")
    assert environment.run([str(environment.python), "script.py"], tmp_path) == ("0.3\n", "")


@pytest.mark.parametrize("name", ["Sand", "1sand", "wet-sand", "class", "math", "laws", "coulomb", "sand_", "tests"])
def test_a_name_that_cannot_be_is_refused(call: Call, tmp_path: Path, name: str) -> None:
    status, output, errors = call("new", "plugin", name, "--dir", str(tmp_path / "new"))
    assert (status, output) == (2, "")
    assert f"but it is {name!r}" in errors
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("name", "holder"),
    [
        ("numpy", f"the installed package numpy {version('numpy')}"),
        ("nonsmooth", "the installed package nonsmooth"),
        ("dateutil", "the module "),
        ("math", "a module of Python"),
        ("coulomb", "a law of nonsmooth"),
    ],
)
def test_a_name_that_would_hide_something_is_refused(call: Call, tmp_path: Path, name: str, holder: str) -> None:
    status, output, errors = call("new", "plugin", name, "--dir", str(tmp_path / "new"))
    assert (status, output) == (2, "")
    assert f"must not be taken already, but it is {name!r}. It is that of {holder}" in errors


def test_a_folder_of_that_name_hides_nothing(call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "wet_sand").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path))
    assert call("new", "plugin", "wet_sand", "--dir", str(tmp_path / "new"))[0] == 0


def test_the_readme_begins_with_what_its_tests_need(call: Call, tmp_path: Path) -> None:
    assert call("new", "plugin", "wet_sand", "--dir", str(tmp_path))[0] == 0
    commands = [line.strip() for line in (tmp_path / "README.md").read_text().splitlines() if line.startswith("    ")]
    assert commands[:2] == ["python -m pip install -e '.[test]'", "python -m pytest"]
    assert 'test = ["pytest>=8", "nonsmooth[testing]"]' in (tmp_path / "pyproject.toml").read_text()


def test_a_folder_that_cannot_be_made_is_a_wrong_request(call: Call, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    status, output, errors = call("new", "plugin", "wet_sand", "--dir", str(tmp_path / "file" / "new"))
    assert (status, output) == (2, "")
    assert f"{tmp_path / 'file' / 'new'} must be a folder that can be written to" in errors


def test_nothing_is_overwritten(call: Call, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("kept")
    status, _, errors = call("new", "plugin", "sand", "--dir", str(tmp_path))
    assert status == 2
    assert f"{tmp_path} must be a folder that is empty or new" in errors
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
