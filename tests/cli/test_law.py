"""``--law``: another law in a scenario, installed or out of a single file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Call = Callable[..., tuple[int, str, str]]

LAW = '''
from dataclasses import dataclass

from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


def _coefficient(speed, friction, unused):
    return friction + 0.0 * unused * speed


@dataclass(frozen=True)
class Flat(FrictionLaw):
    """The same coefficient at every speed."""

    friction: float = parameter(0.2, doc="coefficient", minimum=0.0, usual=(0.01, 2.0))
    unused: float = parameter(1.0, doc="nothing", unit="s/m")

    @property
    def coefficient(self):
        """The function above."""
        return _coefficient

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        """Accept everything."""
        return True


@dataclass(frozen=True)
class Needy(Flat):
    """The same without a default."""

    friction: float = parameter(doc="coefficient", minimum=0.0)
'''


@pytest.fixture
def law(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return a word for the class of a file."""
    monkeypatch.chdir(tmp_path)
    Path("my_law.py").write_text(LAW)
    return "./my_law.py:Flat"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["dumbbell", "tiny"])
def test_a_law_of_a_file_is_that_law(call: Call, law: str, name: str) -> None:
    words = ("run", name, "--set", "t_end=0.2", "--json", "--law")
    reports = []
    for word in (f"friction={law}", "friction=coulomb,friction=0.2", f"friction={law},friction=0.5"):
        status, output, errors = call(*words, word)
        assert status == 0, errors
        reports.append(json.loads(output))
    assert reports[0]["laws"] == {"friction": {"law": "Flat", "friction": 0.2, "unused": 1.0}}
    assert reports[0]["final"] == reports[1]["final"]
    assert name == "tiny" or reports[0]["final"] != reports[2]["final"]
    assert "static_friction" not in reports[0]["parameters"]


def test_two_roles_at_once(call: Call, law: str) -> None:
    words = ("--law", f"friction={law}", "--law", "impact=newton,restitution=0.5")
    status, output, _ = call("run", "dumbbell", "--set", "t_end=0.1", "--json", *words)
    assert status == 0
    report = json.loads(output)
    assert report["laws"]["impact"] == {"law": "NewtonImpact", "restitution": 0.5, "duration": 2e-5}
    assert not {"restitution", "contact_time", "impact", "friction"} & set(report["parameters"])


def test_an_axis_is_three_numbers_apart_by_colons(call: Call, law: str) -> None:
    word = "friction=anisotropic,along=0.1,across=0.3,axis=0:1:0,body=first"
    status, output, errors = call("run", "dumbbell", "--set", "t_end=0.1", "--json", "--law", word)
    assert status == 0, errors
    assert json.loads(output)["laws"]["friction"]["axis"] == [0.0, 1.0, 0.0]


def test_a_compliant_normal_law_takes_the_place_of_an_impact_law(call: Call) -> None:
    words = ("--law", "normal=hunt_crossley,stiffness=1e9,dissipation=1")
    status, output, errors = call("run", "dumbbell", "--set", "t_end=0.2", "--json", *words)
    assert status == 0, errors
    report = json.loads(output)
    assert report["n_impacts"] == 0
    assert not {"restitution", "contact_time", "impact"} & set(report["parameters"])


@pytest.mark.fast_cases(12)
@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("friction={file}:Flt", "unknown class of my_law.py 'Flt'. Did you mean 'Flat'?"),
        ("friction=no.py:Flat", "must name a file that exists, but it is 'no.py'."),
        ("friction={file}", "must name a class of the file"),
        ("fricton={file}:Flat", "Unknown --law role 'fricton'. Did you mean 'friction'?"),
        ("friction=columb", "Unknown --law friction 'columb'. Did you mean 'coulomb'?"),
        (
            "friction=newton",
            "Unknown --law friction 'newton'. That is an impact law. Known: ",
        ),
        ("friction", "must have the form ROLE=LAW"),
        ("friction={file}:Flat,friction", "must have the form ROLE=LAW"),
        ("friction={file}:Flat,friction=1,friction=2", "each NAME once"),
        ("friction={file}:Flat,friction=a", "Flat.friction must be a number, but it is 'a'."),
        ("friction=anisotropic,axis=1:b:0", "Anisotropic.axis must be numbers apart by colons, but it is '1:b:0'."),
        ("friction=anisotropic,along=1,across=1,axis=1:0", "Anisotropic.axis must be three finite numbers"),
        ("friction={file}:Flat,friction=-1", "Flat.friction must be >= 0 [1], but it is -1.0."),
        ("friction={file}:Flat,frictio=1", "Unknown parameter of Flat 'frictio'."),
        ("friction={file}:Needy", "Needy.friction must be given, but it is None. Add friction=VALUE to --law"),
    ],
)
def test_a_wrong_request_is_told(call: Call, law: str, word: str, told: str) -> None:
    status, output, errors = call("run", "dumbbell", "--law", word.format(file="my_law.py"))
    assert (status, output) == (2, "")
    *before, last = errors.splitlines()
    assert last.startswith("error: ")
    assert told in last
    assert all(line.startswith("warning: law 'tiny_") for line in before)  # broken on purpose, and told


def test_a_parameter_of_the_replaced_law_is_refused(call: Call, law: str) -> None:
    status, _, errors = call("run", "dumbbell", "--set", "friction=0.3", "--law", f"friction={law}")
    assert status == 2
    assert "--set friction must not be given with --law friction, which replaces the law that it belongs to" in errors
    soft = "normal=hertz,stiffness=1e9"
    status, _, errors = call("run", "dumbbell", "--set", "restitution=0.3", "--law", soft)
    assert status == 2
    assert "--set restitution must not be given with --law normal" in errors
    status, _, errors = call("run", "dumbbell", "--law", f"friction={law}", "--law", f"friction={law}")
    assert status == 2
    assert "must come once" in errors


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("\n1 +", "my_law.py, line 2, cannot be loaded: SyntaxError: invalid syntax"),
        ("\n\nraise KeyError('x')", "my_law.py, line 3, cannot be loaded: KeyError: 'x'"),
        ("import no_such_module", "my_law.py, line 1, cannot be loaded: ModuleNotFoundError"),
        ("class Flat: pass", "must be a subclass of TangentialLaw"),
        (LAW.replace("def is_fulfilled", "def fulfils"), "must define is_fulfilled"),
        (LAW.replace("@dataclass(frozen=True)", ""), "must be a dataclass"),
    ],
)
def test_a_broken_file_is_told_with_its_line(call: Call, law: str, content: str, told: str) -> None:
    Path("my_law.py").write_text(content)
    status, output, errors = call("run", "dumbbell", "--law", f"friction={law}")
    assert (status, output) == (1, "")
    assert told in errors
    assert "Traceback" not in errors


def test_show_knows_the_class_of_a_file(call: Call, law: str) -> None:
    status, output, _ = call("show", law)
    assert status == 0
    assert output.startswith("Flat: law of ./my_law.py\n  The same coefficient at every speed.\n")
    assert "unused     1.0      s/m   any finite number  nothing" in output


@pytest.mark.slow
def test_a_figure_says_that_laws_were_replaced(call: Call, law: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.figure import Figure

    written: list[str] = []
    text = Figure.text

    def noted(self: Figure, x: float, y: float, words: str, **more: Any) -> Any:
        written.append(words)
        return text(self, x, y, words, **more)

    monkeypatch.setattr(Figure, "text", noted)
    assert call("run", "tiny", "--law", f"friction={law}", "--out", "results")[0] == 0
    assert written.count("In place of the scenario's own:\nFlat(friction=0.2, unused=1.0)") == 1


def test_a_saved_scenario_is_the_same_run(call: Call, law: str) -> None:
    words = ("dumbbell", "--set", "t_end=0.3", "--law", "friction=coulomb,friction=0.3")
    status, output, errors = call("save", "dumbbell", "one.toml", *words[1:])
    assert (status, output, errors.splitlines()[-1]) == (0, "", "the system is in one.toml")
    one = json.loads(call("run", *words, "--json")[1])
    two = json.loads(call("run", "one.toml", "--json")[1])
    assert one["n_steps"] == two["n_steps"]
    assert one["mode_words"] == two["mode_words"]
    assert one["energy_residual"] == two["energy_residual"]
    # the file itself with a value changed
    three = json.loads(call("run", "one.toml", "--set", "laws.coulomb.friction=0.1", "--json")[1])
    assert three["parameters"]["laws.coulomb.friction"] == 0.1
    assert three["n_steps"] != two["n_steps"]


def test_a_scenario_of_a_file_runs(call: Call, law: str) -> None:
    Path("mine.py").write_text("from tiny_scenario import Tiny\n\n\nclass Mine(Tiny): pass\n")
    status, _, errors = call("run", "mine.py:Mine")
    assert status == 1
    assert "must be a dataclass" in errors
    Path("mine.py").write_text("from tiny_scenario import Tiny\n\nMine = Tiny\n")
    reports = [json.loads(call("run", name, "--set", "radius=0.004", "--json")[1]) for name in ("mine.py:Mine", "tiny")]
    assert reports[0]["final"] == reports[1]["final"]


def test_what_cannot_be_saved_is_told(call: Call, law: str) -> None:
    status, _, errors = call("save", "dumbbell", "one.toml", "--law", f"friction={law}")
    assert status == 2
    assert "must be of an installed class" in errors
    status, _, errors = call("save", "dumbbell", "one.txt")
    assert status == 2
    assert "must end in .toml, .yaml, .yml" in errors
    status, _, errors = call("run", "one.toml")
    assert status == 2
    assert "must be a file that can be read" in errors


def test_show_says_how_an_axis_is_written(call: Call) -> None:
    status, output, _ = call("show", "anisotropic")
    assert status == 0
    assert "numbers apart by colons" in output


@pytest.mark.slow
def test_a_run_with_a_law_of_a_file_is_looked_at_with_trust(call: Call, law: str) -> None:
    assert call("run", "tiny", "--set", "t_end=0.05", "--law", f"friction={law}", "--out", "results")[0] == 0
    status, _, errors = call("view", "results", "--html", "page.html")
    assert status == 2
    assert "results: the system that ran must be given, but it is None." in errors
    assert "without './my_law.py:Flat'" in errors
    assert "see --trust" in errors
    assert call("view", "results", "--html", "page.html", "--trust")[0] == 0
    assert call("export", "results", "run.csv", "--trust")[0] == 0
