"""Nothing that a file of another person names is imported, called or loaded, unless the user trusts the file."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.solution.variable import Variable

MARK = "it_ran"
EVIL = f"""
import pathlib
pathlib.Path(__file__).with_name({MARK!r}).touch()
from bodies import Ball, Rest, Spring, Sphere, Hinge
from laws import EnergeticImpact, Frictionless, Unilateral
def function(t):
    return 0.0, 0.0, 0.0
"""
SYSTEM = """
t_end = 0.01
{engine}
[bodies.plate]
type = "plate"
motion = {motion}

[bodies.ball]
{body}
start = {{ position = [0.0, 0.0, 0.1] }}

[[contacts]]
between = ["plate", "ball"]
normal = {normal}
friction = {friction}
impact = {impact}
{more}
"""
GOOD = {
    "engine": "",
    "motion": '"rest"',
    "body": 'type = "ball"\nradius = 0.01',
    "normal": '"unilateral"',
    "friction": '"frictionless"',
    "impact": '{ type = "energetic", restitution = 0.5 }',
    "more": "",
}
TIED = 'between = ["plate", "ball"]'
FUNCTIONS = (
    '{{ type = "function_motion", position = {0}, velocity = {0}, acceleration = {0}, '
    "duration = 1.0, shortest_change = 1.0 }}"
)
KEYS: dict[str, Callable[[str], dict[str, str]]] = {
    "body": lambda word: {"body": f"type = {word}\nradius = 0.01"},
    "shape": lambda word: {"body": f'type = "rigid"\nmass = 1.0\nmoments = [1.0, 1.0, 1.0]\nshapes = [{word}]'},
    "normal law": lambda word: {"normal": word},
    "friction law": lambda word: {"friction": word},
    "impact law": lambda word: {"impact": word},
    "motion": lambda word: {"motion": word},
    "function": lambda word: {"motion": FUNCTIONS.format(word)},
    "load": lambda word: {"more": f"[[loads]]\n{TIED}\ntype = {word}"},
    "function of a load": lambda word: {"more": f'[[loads]]\n{TIED}\ntype = "function_load"\nfunction = {word}'},
    "joint": lambda word: {"more": f"[[joints]]\n{TIED}\ntype = {word}"},
    "guard": lambda word: {"more": f"[[guards]]\ntype = {word}"},
    "engine": lambda word: {"engine": f"engine = {{ type = {word} }}"},
    "helper": lambda word: {"body": f'type = "mesh"\ndensity = 1.0\nsurface = {{ type = {word} }}'},
}
WORDS: dict[str, Callable[[Path], str]] = {
    "a file beside it": lambda folder: '"evil.py:Ball"',
    "a table": lambda folder: '{ type = "evil.py:Ball" }',
    "an absolute path": lambda folder: f'"{folder}/evil.py:Ball"',
    "a path over the parent": lambda folder: f'"../{folder.name}/evil.py:Ball"',
    "a link": lambda folder: '"link.py:Ball"',
    "a line break": lambda folder: f'"\\n{folder}/evil.py:Ball"',
    "a name of a module": lambda folder: '"evil:function"',
    "of the standard library": lambda folder: '"code:interact"',
    "shown by a module that is installed": lambda folder: '"bodies.rod:dataclass"',
}


@pytest.fixture
def stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return a folder with code of a stranger, which is the working folder and can be imported from."""
    (tmp_path / "evil.py").write_text(EVIL)
    (tmp_path / "link.py").symlink_to(tmp_path / "evil.py")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path
    sys.modules.pop("evil", None)


def test_the_file_itself_is_sound(stranger: Path) -> None:
    path = stranger / "system.toml"
    path.write_text(SYSTEM.format(**GOOD))
    assert len(ns.load_system(path).system.contacts) == 1


@pytest.mark.parametrize("form", WORDS)
@pytest.mark.parametrize("key", KEYS)
def test_no_name_of_a_file_leads_to_code(key: str, form: str, stranger: Path) -> None:
    """Every key that can hold a name, times every way to write one."""
    path = stranger / "system.toml"
    path.write_text(SYSTEM.format(**(GOOD | KEYS[key](WORDS[form](stranger)))))
    with pytest.raises(ns.InvalidInput):
        ns.load_system(path)
    assert not (stranger / MARK).exists()
    assert "evil" not in sys.modules


def test_a_trusted_file_is_loaded(stranger: Path) -> None:
    path = stranger / "system.toml"
    path.write_text(SYSTEM.format(**(GOOD | KEYS["friction law"]('"evil.py:Frictionless"'))))
    with pytest.raises(ns.InvalidInput, match=r"friction.*as the file is not trusted.*trust=True.*--trust"):
        ns.load_system(path)
    ns.load_system(path, trust=True)
    assert (stranger / MARK).exists()


def _folder(stranger: Path, text: str) -> Path:
    """Return a folder of results that says another system than the one that ran."""
    path = stranger / "good.toml"
    path.write_text(SYSTEM.format(**GOOD))
    run = stranger / "run"
    shutil.rmtree(run, ignore_errors=True)
    ns.simulate(ns.load_system(path).system, 0.01, output=run)
    folder = SolutionFolder.opened(Output(run))
    folder._arrays.add(Variable("system", (), np.array(text), {}), grows=False)
    folder._arrays.commit()
    return run


@pytest.mark.parametrize("key", ["friction law", "motion", "function", "body"])
@pytest.mark.parametrize("form", ["an absolute path", "a name of a module", "a line break"])
def test_no_name_of_a_folder_leads_to_code(key: str, form: str, stranger: Path) -> None:
    run = _folder(stranger, SYSTEM.format(**(GOOD | KEYS[key](WORDS[form](stranger)))))
    for ask in (ns.open_solution, ns.resume):
        with pytest.raises(ns.InvalidInput):
            ask(run)
    assert not (stranger / MARK).exists()


def test_no_word_of_a_stored_request_leads_to_code(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Laws and engines by files, also behind a line break; what the folder says of its system takes their place."""
    from nonsmooth.cli.main import main

    run = _folder(stranger, SYSTEM.format(**GOOD))
    folder = SolutionFolder.opened(Output(run))
    for asked in (
        {"law": [f"friction={stranger}/evil.py:Frictionless"]},
        {"law": [f"friction=\n{stranger}/evil.py:Frictionless"]},
        {"law": [" friction = evil.py:Frictionless,a=1"]},
        {"engine": f"{stranger}/evil.py:Engine"},
        {"engine": f"\n{stranger}/evil.py:Engine"},
        {"scenario": f"{stranger}/evil.py:Scenario"},
        {"scenario": f"\n{stranger}/evil.py:Scenario"},
    ):
        request: dict[str, Any] = {"scenario": "bouncing_ball", "set": [], "law": [], "engine": None} | asked
        folder.attributes["request"] = json.dumps(request)
        folder._arrays.commit()
        main(["view", str(run), "--html", str(stranger / "page.html"), "--overwrite"])
        assert not (stranger / MARK).exists(), asked
    capsys.readouterr()


def test_metadata_in_the_working_folder_are_no_installed_package(stranger: Path) -> None:
    """With ``python -m`` the working folder can be imported from, but nobody has installed what lies there."""
    info = stranger / "evil-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: evil\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[nonsmooth.laws]\nevil_law = evil:Frictionless\n")
    (stranger / "system.toml").write_text(SYSTEM.format(**(GOOD | {"friction": '"evil_law"'})))
    project = Path(__file__).resolve().parents[2]
    environment = os.environ | {"PYTHONPATH": str(project)}
    for words in (["list", "laws"], ["run", "system.toml"]):
        ran: Any = subprocess.run(
            [sys.executable, "-m", "nonsmooth", *words], env=environment, capture_output=True, text=True, check=False
        )
        assert "evil_law" not in ran.stdout
        assert not (stranger / MARK).exists()
