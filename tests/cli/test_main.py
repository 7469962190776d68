"""Exit statuses and the form of errors."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from importlib.metadata import version

import pytest

from nonsmooth.cli.report.messages import say
from nonsmooth.storage.files import FileError

Call = Callable[..., tuple[int, str, str]]
Start = Callable[..., subprocess.Popen[str]]


def test_version(call: Call) -> None:
    assert call("--version") == (0, f"nonsmooth {version('nonsmooth')}\n", "")


@pytest.mark.parametrize(
    "words",
    [
        (),
        ("list", "planets"),
        ("show",),
        ("run",),
        ("figures", "tiny"),
    ],
)
def test_a_request_that_cannot_be_read_is_wrong(call: Call, words: tuple[str, ...]) -> None:
    status, output, errors = call(*words)
    assert status == 2
    assert output == ""
    assert "usage: nonsmooth" in errors


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("view", "tiny", "--htm"), "nonsmooth view: error: Unknown option '--htm'. Did you mean '--html'?"),
        (("run", "tiny", "--sets=t_end=1"), "nonsmooth run: error: Unknown option '--sets'. Did you mean '--set'?"),
        (("export", "tiny", "--out", "tiny.gif"), "nonsmooth export: error: Unknown option '--out'."),
        (
            ("run", "tiny", "--set", "radius", "0.5"),
            "nonsmooth run: error: Unexpected word '0.5'. Did you mean '--set radius=0.5'?",
        ),
        (("run", "tiny", "--set", "radius", "-0.5"), "Unexpected word '-0.5'. Did you mean '--set radius=-0.5'?"),
        (("run", "tiny", "small"), "nonsmooth run: error: Unexpected word 'small'."),
        (("study", "status", "tiny", "--js"), "nonsmooth study status: error: Unknown option '--js'."),
        (("run", "tiny", "--js"), "nonsmooth run: error: Unknown option '--js'. Did you mean '--json'?"),
    ],
)
def test_a_word_too_many_gets_the_usage_of_its_command(call: Call, words: tuple[str, ...], said: str) -> None:
    status, output, errors = call(*words)
    assert (status, output) == (2, "")
    assert errors.startswith(f"usage: nonsmooth {words[0]} ")
    assert errors.splitlines()[-1].endswith(said)


@pytest.mark.parametrize("words", [("list",), ("--help",), ("run", "--help"), ("--version",)])
def test_a_closed_pipe_ends_quietly(start: Start, words: tuple[str, ...]) -> None:
    process = start(*words)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()  # before the first line is written, as `head` does after its last
    # the broken entries of the plug-in are warned of
    assert [line for line in process.stderr if not line.startswith("warning: ")] == []
    assert process.wait() == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("figure", "dumbbell"), "Unknown command 'figure'. Did you mean 'figures'? Known: basin, "),
        (("Run", "tiny"), "Did you mean 'run'? "),
        (("quux",), "Unknown command 'quux'. Known: basin, "),
    ],
)
def test_an_unknown_command_gets_the_nearest(call: Call, words: tuple[str, ...], said: str) -> None:
    status, output, errors = call(*words)
    assert (status, output) == (2, "")
    assert said in errors
    assert errors.count("\n") == 1


@pytest.mark.fast_cases(10)
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("run", "tinny"), "Did you mean 'tiny'"),
        (("run", "tiny", "--set", "radios=1"), "Did you mean 'radius'?"),
        (("run", "tiny", "--set", "radius"), "must have the form name=value, but it is 'radius'"),
        (("run", "tiny", "--set", "radius="), "must have the form name=value"),
        (("run", "tiny", "--set", "t_end=1", "--set", "t_end=2"), "must come once, but it is '1 and 2'"),
        (("run", "tiny", "--set", "radius=5mm"), "must be a number, but it is '5mm'. Give it in [m]"),
        (("run", "dumbbell", "--set", "friction=felt"), "For a law of that name, write --law friction=felt."),
        (("run", "tiny", "--set", "friction=felt"), "Known: mode, radius, t_end. For a law of that name, write --law"),
        (("run", "tiny", "--set", "radius=-1"), "Tiny.radius must be > 0 [m], but it is -1.0"),
        (("run", "tiny", "--set", "radius=nan"), "Tiny.radius must be a finite number"),
        (("run", "tiny", "--set", "mode=bouncy"), "Did you mean 'bounce'?"),
        (("run", "tiny_demanding"), "tiny_demanding.t_end must be given"),
        (("figures", "tinny", "--out", "x"), "Did you mean 'tiny'"),
        (("show", "dumbell"), "Did you mean 'dumbbell'"),
        (("run", "dumbell"), "Did you mean 'dumbbell'? Known: "),
        (("run", "plate"), "'plate'. That is a body. Known: "),
        (("run", "system.json"), "must end in .toml, .yaml, .yml, but it is 'system.json'. Scenario files are TOML or"),
        (("run", "system.toml"), "must be a file that can be read"),
        (("run", "scenario.py"), "must have the form file.py:Class, but it is 'scenario.py'"),
    ],
)
def test_a_wrong_request_is_one_line_with_the_remedy(call: Call, words: tuple[str, ...], told: str) -> None:
    status, output, errors = call(*words)
    assert status == 2
    assert output == ""
    assert told in errors
    assert errors.startswith("error: ")
    assert errors.count("\n") == 1


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("dumbbell", "--set", "impact=coulomb"), "'coulomb'. That is a friction law. Known: energetic, "),
        (("tiny", "--law", "friction=newton"), "'newton'. That is an impact law. Known: "),
        (("tiny", "--law", "friction=ball"), "'ball'. That is a body. Known: "),
    ],
)
def test_a_name_of_another_kind_is_told_which(call: Call, words: tuple[str, ...], told: str) -> None:
    status, _, errors = call("run", *words)
    assert status == 2
    assert told in errors.splitlines()[-1]  # warnings of broken plug-ins come first


def test_a_broken_scenario_is_a_failure_that_names_it(call: Call) -> None:
    status, output, errors = call("run", "tiny_broken")
    assert status == 1
    assert output == ""
    assert "scenario 'tiny_broken' (tiny_scenario:Missing, from tiny 0.1) cannot be loaded" in errors


def test_an_unusual_value_is_one_line_per_parameter(call: Call) -> None:
    status, _, errors = call("run", "tiny", "--set", "radius=10")
    assert status == 0
    warned = [line for line in errors.splitlines() if line.startswith("warning: ")]
    assert [line.split(" = ")[0] for line in warned] == ["warning: Tiny.radius", "warning: Ball.radius"]


def test_an_output_that_takes_nothing_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    with open("/dev/full", "w") as full:
        monkeypatch.setattr("sys.stdout", full)
        with pytest.raises(FileError, match="standard output could not be written: No space left"):
            say("result")
