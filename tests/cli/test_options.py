"""Every option says the same as the Python function that it belongs to; the top level help imports no numerics."""

from __future__ import annotations

import argparse
import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module

import pytest

from nonsmooth.cli.commands import COMMANDS
from nonsmooth.cli.docstrings import described_parameters, plain
from nonsmooth.cli.main import parser
from nonsmooth.cli.parse.options import Command, CommandGroup, Option

_OF_THE_COMMAND_LINE = {
    "--accept", "--dir", "--figures", "--follow", "--html", "--json", "--law", "--out", "--overwrite", "--proximity",
    "--set", "--show", "--spin", "--trust", "--turn", "--view", "file", "folder", "group", "name", "run", "scenario",
    "study",
}  # fmt: skip
"""Options without a parameter of a Python function, or that stand for an object or a call of it."""
_LIGHT = (
    "import sys, types\n"
    "package = types.ModuleType('nonsmooth')\n"
    "package.__path__ = [sys.argv[1]]\n"
    "sys.modules['nonsmooth'] = package\n"
    "from nonsmooth.cli.main import parser\n"
    "parser([]).format_help()\n"
    "print([name for name in ('numpy', 'numba', 'scipy', 'matplotlib') if name in sys.modules])\n"
)


def _commands() -> Iterator[tuple[str, Command]]:
    for name, (module, _) in COMMANDS.items():
        found = import_module(f"nonsmooth.cli.commands.{module}").COMMANDS[name]
        parts = found.parts.items() if isinstance(found, CommandGroup) else [("", found)]
        yield from ((f"{name} {part}".strip(), command) for part, command in parts)


def _options() -> Iterator[tuple[str, Option]]:
    return ((f"{name} {option.name}", option) for name, command in _commands() for option in command.options)


@pytest.mark.parametrize(("name", "option"), [pytest.param(*one, id=one[0]) for one in _options()])
def test_an_option_says_what_its_function_says(name: str, option: Option) -> None:
    if option.source is None:
        assert option.name in _OF_THE_COMMAND_LINE
        assert option.text
        return
    function, parameter = option.source
    known = inspect.signature(function).parameters[parameter]
    text = re.sub(r",? shape \[[^]]*\]", "", described_parameters(function)[parameter]).rstrip(".")
    assert text
    assert text.lower() in option.text.lower()
    units = re.findall(r"\[[^]]+\]", text)
    assert all(unit in option.text for unit in units)
    default = None if known.default is known.empty else known.default
    # an option of a format is given to the format only if it is typed
    assert option.default == default or (name.startswith("export ") and option.default is None)
    if default is not None:
        word = f"{default:g}" if isinstance(default, float) else str(default)
        assert f"{word} by default" in option.text


@pytest.mark.parametrize(("name", "command"), [pytest.param(*one, id=one[0]) for one in _commands()])
def test_the_help_of_a_command_has_all_of_its_options(name: str, command: Command) -> None:
    found = _of(parser(name.split()), name.split())
    text = " ".join(found.format_help().split())
    for option in command.options:
        assert (option.name if option.name.startswith("--") else option.metavar or "{") in text
        assert re.sub(r"\W", "", option.text) in re.sub(r"\W", "", text)
    assert found.get_default("execute") is command.execute


def _of(found: argparse.ArgumentParser, words: list[str]) -> argparse.ArgumentParser:
    for word in words:
        parts = next(action for action in found._actions if isinstance(action, argparse._SubParsersAction))
        found = parts.choices[word]
    return found


def test_a_parameter_is_described_across_lines_and_names() -> None:
    def function(one: int, two: int) -> None:
        """Do nothing.

        Parameters
        ----------
        one, two : int
            Of :func:`nonsmooth.simulate`,
            both ``1``.

        Raises
        ------
        InvalidInput
            Never.
        """

    assert described_parameters(function) == dict.fromkeys(("one", "two"), "Of simulate, both 1.")
    assert plain(":class:`~a.B`") == "B"


def test_the_help_imports_no_numerics() -> None:
    """Commands are imported as they are used."""
    import nonsmooth

    found = subprocess.run(
        [sys.executable, "-c", _LIGHT, nonsmooth.__path__[0]], capture_output=True, text=True, check=True, timeout=60
    )
    assert found.stdout.splitlines()[-1] == "[]"
