"""``nonsmooth list`` and ``show``: installed components, their parameters, and bodies near each other at the start."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nonsmooth.cli.docstrings import first_line
from nonsmooth.cli.parse.components import ROLES
from nonsmooth.cli.parse.options import Command, Option, flag
from nonsmooth.cli.parse.request import TRUST, job
from nonsmooth.cli.report.messages import say
from nonsmooth.cli.report.table import ASSUMED, HEAD, folded, lines, parameter_rows
from nonsmooth.files.formats import SUFFIXES
from nonsmooth.files.reading import read
from nonsmooth.plugins import file, registry

GROUPS = ("scenarios", "bodies", "shapes", "motions", "joints", "loads", "guards", "laws", "engines")
_NEAR = ("gap [m]", "", "bodies", "found by", "contact")
"""Column heads of the table of near bodies. The second column, without a head, has the state of the pair."""
_GROUP = Option("group", "all by default", choices=GROUPS)
_SHOW = (
    Option("name", "name or class of `nonsmooth list`, FILE.py:CLASS, or a scenario file", metavar="NAME"),
    flag("--proximity", "of a scenario or a file: bodies near each other at the start, and their contacts"),
    TRUST,
)


def _list(arguments: argparse.Namespace) -> bool:
    """Print a line for each usable component: name, role if a law, source, class and first docstring line."""
    registry.check_groups()
    wanted = (arguments.group,) if arguments.group else GROUPS
    say("\n\n".join(_section(group) for group in wanted))
    return True


def _section(group: str) -> str:
    rows = [
        (name, *_kind(group, owner), registry.source(group, name), f"{owner.__name__}: {first_line(owner)}")
        for name, owner in registry.load_all(group).items()
    ]
    return "\n".join([f"{group}:", *(folded(rows) or ["  none"])])


def _kind(group: str, owner: type) -> tuple[str, ...]:
    """Return the role of a law as a column of the list; () for other groups."""
    return tuple(role for role, base in ROLES.items() if issubclass(owner, base)) if group == "laws" else ()


def _show(arguments: argparse.Namespace) -> bool:
    """Print the parameters of all components of a name, as a scenario and a body may have the same name."""
    if arguments.proximity:
        say(_near_bodies(arguments.name, arguments.trust))
    elif file.is_file(arguments.name):
        owner = file.load("show", registry.INTERFACES, arguments.name)
        say(_described(owner, f"{owner.__name__}: {registry.kind_of(owner)} of {arguments.name.rpartition(':')[0]}"))
    else:
        say("\n\n".join(_installed(group, name) for group, name in registry.called(arguments.name, GROUPS)))
    return True


def _installed(group: str, name: str) -> str:
    title = f"{name}: {registry.KINDS[group]} of {registry.source(group, name)}"
    return _described(registry.load(group, name), title, registry.imported(group, name))


def _described(owner: Any, title: str, *imported: str) -> str:
    rows = parameter_rows(owner)
    table = lines([HEAD, *rows]) if rows else ["  no parameters"]
    legend = [f"  {ASSUMED}"] if any(row[1].endswith("*") for row in rows) else []
    head = [f"  {line}" for line in (first_line(owner), *imported)]
    return "\n".join([title, *head, "", *table, *legend])


def _near_bodies(name: str, trust: bool) -> str:
    """Return a table of the pairs of bodies that are near each other at the start of a run.

    ``name`` is the name of a scenario, which gets its default parameters, or the path of a scenario file. If ``trust``
    is True, the file may name code that is not installed.
    """
    # imported on use: the other commands start faster without it
    from nonsmooth.queries.proximity import proximity

    system = read(Path(name), trust).system if name.endswith(SUFFIXES) else job(name, (), trust=trust).build()
    pairs, names = proximity(system), system.names.bodies
    if not pairs:
        return f"{name}: no two bodies are near each other at the start."
    rows = [
        (
            f"{pair.distance.gap:.3g}",
            pair.state,
            " and ".join(names[number] for number in pair.numbers),
            pair.distance.how,
            ", ".join(word for word in ("declared", "joined", "excluded") if getattr(pair, word)) or "none",
        )
        for pair in pairs
    ]
    return "\n".join([f"{name}: bodies near each other at the start", "", *lines([_NEAR, *rows])])


COMMANDS = {"list": Command(_list, (_GROUP,)), "show": Command(_show, _SHOW)}
