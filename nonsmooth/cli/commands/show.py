"""``nonsmooth show``: the parameters of a scenario, body, joint, load or law."""

from __future__ import annotations

import argparse
from typing import Any

from nonsmooth.cli.asking import trust
from nonsmooth.cli.commands.list import GROUPS
from nonsmooth.cli.telling.messages import say
from nonsmooth.cli.telling.parameter_rows import ASSUMED, HEAD, parameter_rows
from nonsmooth.cli.telling.table import first_line, lines
from nonsmooth.plugins import file, registry


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "show", help="parameters with units, defaults, ranges, and what is assumed", allow_abbrev=False
    )
    command.add_argument(
        "name",
        metavar="NAME",
        help="name or class of `nonsmooth list`, FILE.py:CLASS, or a scenario file for --proximity",
    )
    command.add_argument(
        "--proximity",
        action="store_true",
        help="of a scenario or a file: which bodies are near each other at the start, and what is said of them",
    )
    trust.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Print everything of that name: a scenario and a body may share one."""
    if arguments.proximity:
        # imported when asked for: the other commands start faster without it
        from nonsmooth.cli.commands import near

        say(near.table(arguments.name, arguments.trust))
        return True
    if file.is_file(arguments.name):
        owner = file.load("show", registry.INTERFACES, arguments.name)
        say(_describe(owner, f"{owner.__name__}: {registry.kind_of(owner)} of {arguments.name.rpartition(':')[0]}"))
        return True
    say("\n\n".join(_installed(group, name) for group, name in registry.called(arguments.name, GROUPS)))
    return True


def _installed(group: str, name: str) -> str:
    title = f"{name}: {registry.KINDS[group]} of {registry.source(group, name)}"
    return _describe(registry.load(group, name), title, registry.imported(group, name))


def _describe(owner: Any, title: str, *imported: str) -> str:
    rows = parameter_rows(owner)
    table = lines([HEAD, *rows]) if rows else ["  no parameters"]
    legend = [f"  {ASSUMED}"] if any(row[1].endswith("*") for row in rows) else []
    told = [f"  {line}" for line in (first_line(owner), *imported)]
    return "\n".join([title, *told, "", *table, *legend])
