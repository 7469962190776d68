"""``nonsmooth list``: what is installed, plug-ins included."""

from __future__ import annotations

import argparse
from typing import Any

from nonsmooth.cli.asking.law import ROLES
from nonsmooth.cli.telling.messages import say
from nonsmooth.cli.telling.table import first_line, folded
from nonsmooth.plugins import registry

GROUPS = ("scenarios", "bodies", "shapes", "motions", "joints", "loads", "guards", "laws", "engines")


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("list", help="what is installed, plug-ins included", allow_abbrev=False)
    command.add_argument("group", nargs="?", choices=GROUPS, help="all by default")
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Print name, kind of a law, source, class and first docstring line of every usable plug-in."""
    registry.check_groups()
    wanted = (arguments.group,) if arguments.group else GROUPS
    say("\n\n".join(_section(group) for group in wanted))
    return True


def _section(group: str) -> str:
    loaded = registry.load_all(group).items()
    rows = [
        (name, *_kind(group, owner), registry.source(group, name), f"{owner.__name__}: {first_line(owner)}")
        for name, owner in loaded
    ]
    return "\n".join([f"{group}:", *(folded(rows) or ["  none"])])


def _kind(group: str, owner: type) -> tuple[str, ...]:
    """Return what a law is for, in a column of its own; nothing for groups of one kind."""
    return tuple(role for role, base in ROLES.items() if issubclass(owner, base)) if group == "laws" else ()
