"""The reference of the command line has every command, every option and an example that the parser accepts."""

from __future__ import annotations

import argparse
import re
import shlex
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from nonsmooth.cli.commands import COMMANDS
from nonsmooth.cli.main import parser

DOCS = Path(__file__).parents[2] / "docs"
pytest.importorskip("griffe", reason="the extra docs is not installed")
sys.path.insert(0, str(DOCS))
pages: Any = import_module("command_pages")
sys.path.remove(str(DOCS))


def _parts(owner: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in owner._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def _parsers() -> Iterator[tuple[str, argparse.ArgumentParser]]:
    for name in COMMANDS:
        command = _parts(parser([name]))[name]
        parts = _parts(command)
        yield from ((f"{name} {part}", one) for part, one in parts.items())
        if not parts:
            yield name, command


def test_every_command_and_option_is_on_the_page() -> None:
    """As the parser has them."""
    head, *sections = re.split(r"^## (.+)$", pages.command_page(), flags=re.MULTILINE)
    assert head == ""
    texts = dict(zip(sections[::2], sections[1::2], strict=True))
    found = dict(_parsers())
    assert list(texts) == list(found)
    for name, command in found.items():
        named = {a.option_strings[0] if a.option_strings else a.dest for a in command._actions} - {"-h"}
        assert {*re.findall(r"^\| `([^`]+)` \|", texts[name], re.MULTILINE)} == named, name


@pytest.mark.fast_cases(19)
@pytest.mark.parametrize("name", pages.EXAMPLES)
def test_the_parser_accepts_the_example_of_a_command(name: str) -> None:
    program, *words = shlex.split(pages.EXAMPLES[name])
    assert program == "nonsmooth"
    assert words[: len(name.split())] == name.split()
    assert parser(words).parse_args(words).execute


def test_the_page_of_the_command_line_includes_it() -> None:
    assert '--8<-- "commands.md"' in (DOCS / "pages" / "reference" / "cli.md").read_text(encoding="utf-8")
