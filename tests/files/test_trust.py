"""Nothing that a file of another person names is imported, called or loaded, unless the user trusts the file.

One table: every key that can hold a name, times every form of a name, times every road on which a file is read.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.cli.main import main
from nonsmooth.files import yaml_text
from nonsmooth.plugins import registry
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.studies.study_folder import StudyFolder
from tests.storage.forging import say

ROOT = Path(__file__).resolve().parents[2]
MARK = "it_ran"
EVIL = f"""
import pathlib
pathlib.Path(__file__).with_name({MARK!r}).touch()
from bodies import Ball, Rest, Spring, Sphere, Hinge
from laws import EnergeticImpact, Frictionless, Unilateral
from scenarios.bouncing_ball import BouncingBall
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
    "law by a name of the file": lambda word: {"friction": '"ice"', "more": f"[laws]\nice = {word}"},
    "law of materials": lambda word: {
        "more": f'[materials]\ndefault = {{ normal = "unilateral", friction = {word}, impact = "plastic" }}'
    },
    "motion": lambda word: {"motion": word},
    "function": lambda word: {"motion": FUNCTIONS.format(word)},
    "load": lambda word: {"more": f"[[loads]]\n{TIED}\ntype = {word}"},
    "function of a load": lambda word: {"more": f'[[loads]]\n{TIED}\ntype = "function_load"\nfunction = {word}'},
    "joint": lambda word: {"more": f"[[joints]]\n{TIED}\ntype = {word}"},
    "guard": lambda word: {"more": f"[[guards]]\ntype = {word}"},
    "engine": lambda word: {"engine": f"engine = {{ type = {word} }}"},
    "helper": lambda word: {"body": f'type = "mesh"\ndensity = 1.0\nsurface = {{ type = {word} }}'},
    "mesh": lambda word: {
        "body": f'type = "mesh"\ndensity = 1.0\nsurface = {{ type = "bodies:MeshFile", path = {word}, unit = "m" }}'
    },
}
FORMS: dict[str, Callable[[Path], str]] = {
    "a file beside it": lambda folder: '"evil.py:Ball"',
    "a table": lambda folder: '{ type = "evil.py:Ball" }',
    "an absolute path": lambda folder: f'"{folder}/evil.py:Ball"',
    "a path over the parent": lambda folder: f'"../{folder.name}/evil.py:Ball"',
    "a link": lambda folder: '"link.py:Ball"',
    "a line break": lambda folder: f'"\\n{folder}/evil.py:Ball"',
    "a file without a class": lambda folder: '"evil.py"',
    "a plain word": lambda folder: '"evil"',
    "a name of a module": lambda folder: '"evil:function"',
    "a class of a module": lambda folder: '"evil:Ball"',
    "of the standard library": lambda folder: '"code:interact"',
    "shown by a module that is installed": lambda folder: '"bodies.rod:dataclass"',
    "the program of a package that is installed": lambda folder: '"bodies.__main__:main"',
    "a number": lambda folder: "5",
    "a list": lambda folder: '["evil.py:Ball"]',
}


def _command(*words: str) -> None:
    """Run a command; raise InvalidInput where it refuses the request."""
    status = main(words)
    if status == 2:
        raise ns.InvalidInput("the command", "must not be refused", words, "")
    assert status == 0, words


def _as_file(name: str, text: str) -> str:
    Path(name).write_text(yaml_text.text_of(tomllib.loads(text)) if name.endswith(".yaml") else text)
    return name


def _as_folder(text: str) -> str:
    """Put a system into a folder of results in place of the one that ran."""
    folder = SolutionFolder.opened(Output(Path("run")))
    folder._arrays.add("system", (), np.array(text), {}, grows=False)
    folder._arrays.commit(safely=False)
    return "run"


def _as_study(text: str) -> str:
    """Put a system into the file that a stored study varies."""
    Path("good.toml").write_text(text)
    return "study.zarr"


LOOKED = ("--period", "0.005", "--within", "z,vz")
DRAWN = ("--period", "0.005", "--show", "z", "--settle", "1", "--keep", "1")
OVER = ("--over", "bodies.ball.radius=0.01,0.02", "--record", "t_end")
ROADS: dict[str, Callable[[str, bool], Any]] = {
    "load_system": lambda text, trust: ns.load_system(_as_file("system.toml", text), trust=trust),
    "load_system of YAML": lambda text, trust: ns.load_system(_as_file("system.yaml", text), trust=trust),
    "run": lambda text, trust: _command("run", _as_file("system.toml", text), *["--trust"] * trust),
    "view of a file": lambda text, trust: _command(
        "view", _as_file("system.toml", text), "--html", "page.html", "--overwrite", *["--trust"] * trust
    ),
    "save": lambda text, trust: _command(
        "save", _as_file("system.toml", text), "out.toml", "--overwrite", *["--trust"] * trust
    ),
    "show --proximity": lambda text, trust: _command(
        "show", _as_file("system.toml", text), "--proximity", *["--trust"] * trust
    ),
    "sweep": lambda text, trust: _command(
        "sweep", _as_file("system.toml", text), *OVER, "--out", "new.zarr", *["--trust"] * trust
    ),
    "basin": lambda text, trust: _command(
        "basin", _as_file("system.toml", text), *OVER[:2], *LOOKED, "--out", "new.zarr", *["--trust"] * trust
    ),
    "bifurcation": lambda text, trust: _command(
        "bifurcation", _as_file("system.toml", text), *OVER[:2], *DRAWN, *["--trust"] * trust
    ),
    "orbit": lambda text, trust: _command("orbit", _as_file("system.toml", text), *LOOKED, *["--trust"] * trust),
    "study resume": lambda text, trust: _command("study", "resume", _as_study(text), *["--trust"] * trust),
    "open_solution": lambda text, trust: ns.open_solution(_as_folder(text), trust=trust),
    "resume": lambda text, trust: ns.resume(_as_folder(text), trust=trust),
    "view of results": lambda text, trust: _command(
        "view", _as_folder(text), "--html", "page.html", "--overwrite", *["--trust"] * trust
    ),
    "export of results": lambda text, trust: _command(
        "export", _as_folder(text), "out.csv", "--overwrite", *["--trust"] * trust
    ),
    "resume by command": lambda text, trust: _command("resume", _as_folder(text), *["--trust"] * trust),
}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the results of a run that was cut off, and a study, both of a system of a file."""

    class Dies(Exception):
        pass

    def die(t: float, t_end: float) -> None:
        raise Dies

    place = tmp_path_factory.mktemp("written")
    (place / "good.toml").write_text(SYSTEM.format(**GOOD))
    (place / "evil.py").write_text(EVIL)
    (place / "link.py").symlink_to(place / "evil.py")
    with pytest.raises(Dies):
        ns.simulate(ns.load_system(place / "good.toml").system, 0.01, output=place / "run", progress=die)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        _command("sweep", "good.toml", *OVER, "--out", "study.zarr")
    return place


@pytest.fixture
def stranger(written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return a folder with code of a stranger, which is the working folder and can be imported from."""
    place = tmp_path / "stranger"
    shutil.copytree(written, place, symlinks=True)
    monkeypatch.chdir(place)
    monkeypatch.syspath_prepend(place)
    yield place
    sys.modules.pop("evil", None)


def test_the_file_itself_is_sound(stranger: Path) -> None:
    assert len(ns.load_system("good.toml").system.contacts) == 1


@pytest.mark.fast_cases(48)
@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("key", KEYS)
def test_no_name_of_a_file_leads_to_code(key: str, road: str, stranger: Path) -> None:
    """Every form of a name."""
    for form, word in FORMS.items():
        text = SYSTEM.format(**(GOOD | KEYS[key](word(stranger))))
        with pytest.raises(ns.InvalidInput):
            ROADS[road](text, False)
        assert not (stranger / MARK).exists(), form
        assert "evil" not in sys.modules, form


@pytest.mark.parametrize("road", ROADS)
def test_a_trusted_file_is_loaded(road: str, stranger: Path) -> None:
    """By each road: so the table above is of roads that lead somewhere."""
    text = SYSTEM.format(**(GOOD | KEYS["friction law"](f'"{stranger}/evil.py:Frictionless"')))
    # what such a system is not made for is refused, or fails, behind that
    with contextlib.suppress(ns.InvalidInput, AssertionError):
        ROADS[road](text, True)
    assert (stranger / MARK).exists()


def test_the_refusal_names_the_remedy(stranger: Path) -> None:
    text = SYSTEM.format(**(GOOD | KEYS["friction law"]('"evil.py:Frictionless"')))
    with pytest.raises(ns.InvalidInput, match=r"friction.*as the file is not trusted.*trust=True.*--trust"):
        ns.load_system(_as_file("system.toml", text))


WORDS: dict[str, dict[str, Any]] = {
    "law": {"law": ["friction={0}:Frictionless"]},
    "law in spaces, with a parameter": {"law": [" friction = {0}:Frictionless,a=1"]},
    "engine": {"engine": "{0}:Engine"},
    "scenario": {"scenario": "{0}:BouncingBall"},
    "key of a file": {"scenario": "good.toml", "set": ["contacts.0.friction={0}:Frictionless"], "over": OVER[1:2]},
    "values of a key": {"scenario": "good.toml", "over": ["contacts.0.friction={0}:Frictionless,frictionless"]},
    "values of a parameter": {"over": ["restitution={0}:Frictionless,0.5"]},
    "record": {"record": ["{0}:BouncingBall"]},
}
FILES = ("evil.py", "{folder}/evil.py", "../stranger/evil.py", "link.py", "\n{folder}/evil.py", "evil")


@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("road", ["view", "export", "resume", "study resume"])
def test_no_word_of_a_stored_request_leads_to_code(
    road: str, word: str, stranger: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whether it is refused, or what a folder says of its system takes its place."""
    roads = {
        "view": ("view", "run", "--html", "page.html", "--overwrite"),
        "export": ("export", "run", "out.csv", "--overwrite"),
        "resume": ("resume", "run"),
        "study resume": ("study", "resume", "study.zarr"),
    }
    usual: dict[str, Any] = {"scenario": "bouncing_ball", "set": [], "law": [], "engine": None}
    for file in FILES:
        asked: dict[str, Any] = {}
        for name, value in WORDS[word].items():
            place = file.format(folder=stranger)
            asked[name] = value.format(place) if isinstance(value, str) else [one.format(place) for one in value]
        if road == "study resume":
            known = json.loads(str(StudyFolder(Path("study.zarr")).attributes["request"]))
            say(Path("study.zarr"), request=json.dumps(known | asked))
        else:
            say(Path("run") / "solution.zarr", request=json.dumps(usual | asked))
        main(roads[road])
        assert "Traceback" not in capsys.readouterr().err
        assert not (stranger / MARK).exists(), file
        assert "evil" not in sys.modules, file


def test_a_run_with_classes_of_a_stranger_is_opened_without_them(
    stranger: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As the command line itself has written it."""
    main(["run", "bouncing_ball", "--set", "t_end=0.1", "--law", "friction=evil.py:Frictionless", "--out", "theirs"])
    main(["run", "evil.py:BouncingBall", "--set", "t_end=0.1", "--out", "theirs too"])
    (stranger / MARK).unlink()
    for folder in ("theirs", "theirs too"):
        assert ns.open_solution(folder).status == "done"
        _command("view", folder, "--html", "page.html", "--overwrite")
        _command("export", folder, "out.csv", "--overwrite")
        assert main(["resume", folder]) == 2
        assert not (stranger / MARK).exists()


def test_a_study_of_a_class_of_a_stranger_needs_trust(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As the command line itself has written it."""
    words = ["sweep", "evil.py:BouncingBall", "--over", "restitution=0.5,0.6", "--set", "t_end=0.01"]
    _command(*words, "--record", "t_end", "--out", "theirs.zarr")
    (stranger / MARK).unlink()
    assert main(["study", "resume", "theirs.zarr"]) == 2
    assert "as the file is not trusted" in capsys.readouterr().err
    assert not (stranger / MARK).exists()
    _command("study", "resume", "theirs.zarr", "--trust")
    assert (stranger / MARK).exists()


SCRIPT = """
import json, sys
from nonsmooth.cli.main import main
for words in json.loads(sys.argv[1]):
    print(main(words))
"""


def _commands(text: str) -> list[list[str]]:
    """Return commands on a file, a folder and two studies that name code, the second one in its stored request."""
    shutil.copytree("study.zarr", "words.zarr")
    known = json.loads(str(StudyFolder(Path("words.zarr")).attributes["request"]))
    say(Path("words.zarr"), request=json.dumps(known | {"engine": "evil.py:Engine"}))
    return [
        ["run", _as_file("system.toml", text)],
        ["view", _as_folder(text), "--html", "page.html", "--overwrite"],
        ["export", "run", "out.csv", "--overwrite"],
        ["resume", "run"],
        ["study", "resume", "words.zarr"],
        ["study", "resume", _as_study(text)],
    ]


@pytest.mark.slow
@pytest.mark.parametrize("how", ["python -m nonsmooth", "python script.py", "python -c"])
def test_nor_where_the_working_folder_can_be_imported_from(how: str, stranger: Path) -> None:
    """As with ``python -m``, which begins its path with it, a script that lies there, and an empty entry."""
    text = SYSTEM.format(**(GOOD | KEYS["function"]('"evil:function"')))
    commands = _commands(text)
    (stranger / "script.py").write_text(SCRIPT)
    words = {"python script.py": ["script.py"], "python -c": ["-c", SCRIPT]}
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    if how == "python -m nonsmooth":
        processes = [["-m", "nonsmooth", *command] for command in commands]
    else:
        processes = [[*words[how], json.dumps(commands)]]
    for process in processes:
        ran = subprocess.run([sys.executable, *process], env=environment, capture_output=True, text=True, check=False)
        assert ran.returncode == 2 if len(processes) > 1 else ran.stdout.split() == ["2"] * len(commands), ran.stderr
        assert "as the file is not trusted" in ran.stderr
        assert not (stranger / MARK).exists()


def _metadata(place: Path, kind: str) -> None:
    info = place / f"evil-1.0.{kind}"
    info.mkdir()
    (info / ("METADATA" if kind == "dist-info" else "PKG-INFO")).write_text(
        "Metadata-Version: 2.1\nName: evil\nVersion: 1.0\n"
    )
    (info / "entry_points.txt").write_text("[nonsmooth.laws]\nevil_law = evil:Frictionless\n")


@pytest.fixture
def _anew() -> Iterator[None]:
    caches: list[Any] = [registry._points, registry._is_installed_in, registry.packages]
    for cache in caches:
        cache.cache_clear()
    yield
    for cache in caches:
        cache.cache_clear()


@pytest.mark.usefixtures("_anew")
@pytest.mark.parametrize("kind", ["dist-info", "egg-info"])
@pytest.mark.parametrize("where", ["the working folder", "that of the script", "where the process began", "elsewhere"])
def test_only_installed_packages_register_names(
    where: str, kind: str, stranger: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not metadata in a folder from which Python imports although nobody installed what lies there."""
    _metadata(stranger, kind)
    if where != "the working folder":
        monkeypatch.chdir(tmp_path)
    if where == "that of the script":
        monkeypatch.setitem(vars(sys.modules["__main__"]), "__file__", str(stranger / "script.py"))
    if where == "where the process began":
        monkeypatch.setattr(registry, "_BEGAN_IN", (stranger,))
    assert ("evil_law" in registry.names("laws")) == (where == "elsewhere")
    assert ("evil" in registry.packages()) == (where == "elsewhere")


@pytest.mark.usefixtures("_anew")
def test_a_part_of_a_namespace_is_no_installed_package(
    stranger: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A namespace package spreads over all folders of its name, also the working one."""
    place = tmp_path / "installed"
    (place / "wide").mkdir(parents=True)
    (place / "wide" / "laws.py").write_text("from laws import Frictionless\n")
    _metadata(place, "dist-info")
    (place / "evil-1.0.dist-info" / "entry_points.txt").write_text("[nonsmooth.laws]\nwide = wide.laws:Frictionless\n")
    (stranger / "wide").mkdir()
    shutil.copy(stranger / "evil.py", stranger / "wide" / "evil.py")
    monkeypatch.syspath_prepend(place)
    assert "wide" in registry.names("laws")
    text = SYSTEM.format(**(GOOD | KEYS["function"]('"wide.evil:function"')))
    with pytest.raises(ns.InvalidInput, match="as the file is not trusted"):
        ns.load_system(_as_file("system.toml", text))
    assert not (stranger / "wide" / MARK).exists()


@pytest.mark.slow
def test_metadata_in_the_working_folder_are_no_installed_package(stranger: Path) -> None:
    """With ``python -m`` the working folder can be imported from."""
    _metadata(stranger, "dist-info")
    text = SYSTEM.format(**(GOOD | {"friction": '"evil_law"'}))
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    for words in (["list", "laws"], ["run", _as_file("system.toml", text)]):
        ran: Any = subprocess.run(
            [sys.executable, "-m", "nonsmooth", *words], env=environment, capture_output=True, text=True, check=False
        )
        assert "evil_law" not in ran.stdout
        assert not (stranger / MARK).exists()
