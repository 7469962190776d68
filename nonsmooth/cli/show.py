"""``nonsmooth show``: the parameters of a scenario, body, joint, load or law."""

from __future__ import annotations

import argparse
from typing import Any

from nonsmooth.cli.list import GROUPS
from nonsmooth.cli.messages import say
from nonsmooth.cli.parameter_rows import ASSUMED, HEAD, parameter_rows
from nonsmooth.cli.table import first_line, lines
from nonsmooth.errors import UnknownName
from nonsmooth.plugins import file, registry


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "show", help="parameters with units, defaults, ranges, and what is assumed", allow_abbrev=False
    )
    command.add_argument(
        "name", metavar="NAME", help="anything of `nonsmooth list`, FILE.py:CLASS, or a scenario file for --proximity"
    )
    command.add_argument(
        "--proximity",
        action="store_true",
        help="of a scenario or a file: which bodies are near each other at the start, and what is said of them",
    )
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Print everything of that name: a scenario and a body may share one."""
    if arguments.proximity:
        # imported when asked for: the other commands start faster without it
        from nonsmooth.cli import near

        say(near.table(arguments.name))
        return True
    if file.is_file(arguments.name):
        owner = file.load("show", registry.INTERFACES, arguments.name)
        say(_describe(owner, f"{owner.__name__}: {registry.kind_of(owner)} of {arguments.name.rpartition(':')[0]}"))
        return True
    groups = [group for group in GROUPS if arguments.name in registry.names(group)]
    if not groups:
        known = {name for group in GROUPS for name in registry.names(group)}
        raise UnknownName("component", arguments.name, known)
    say("\n\n".join(_installed(group, arguments.name) for group in groups))
    return True


def _installed(group: str, name: str) -> str:
    title = f"{name}: {registry.KINDS[group]} of {registry.source(group, name)}"
    return _describe(registry.load(group, name), title)


def _describe(owner: Any, title: str) -> str:
    rows = parameter_rows(owner)
    table = lines([HEAD, *rows]) if rows else ["  no parameters"]
    legend = [f"  {ASSUMED}"] if any(row[1].endswith("*") for row in rows) else []
    return "\n".join([title, f"  {first_line(owner)}", "", *table, *legend])
