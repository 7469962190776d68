"""``nonsmooth check``: the conformance kit on what is installed."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from typing import Any

from nonsmooth.cli.asking import request
from nonsmooth.cli.telling.messages import say
from nonsmooth.cli.telling.table import lines
from nonsmooth.plugins import file, registry

_HOLDS, _FAILS, _DEPARTS, _OPEN = "holds", "fails", "departs", "not checked"


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "check",
        help="check that a component has the properties that it must have",
        allow_abbrev=False,
    )
    command.add_argument("name", metavar="NAME", help="a name or class of `nonsmooth list`, or FILE.py:CLASS")
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of `nonsmooth show NAME`, in SI units; may come often",
    )
    command.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Check everything of that name; return whether all properties hold that could be checked."""
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints: standard output is for the result
        found = _look(arguments.name, request.assignments(arguments.set))
    failed = any(row["outcome"] == _FAILS for part in found for row in part["properties"])
    if arguments.json:
        say(json.dumps({"name": arguments.name, "status": _FAILS if failed else _HOLDS, "components": found}))
    else:
        say("\n\n".join(_as_text(part) for part in found))
    return not failed


def _look(name: str, words: dict[str, str]) -> list[dict[str, Any]]:
    if file.is_file(name):
        owner = file.load("check", registry.INTERFACES, name)
        path, _, word = name.rpartition(":")
        return [_part(owner, word, registry.kind_of(owner), path, words)]
    return [
        _part(registry.load(group, known), known, registry.KINDS[group], registry.source(group, known), words)
        for group, known in registry.called(name, registry.GROUPS)
    ]


def _part(owner: Any, name: str, kind: str, source: str, words: dict[str, str]) -> dict[str, Any]:
    # imported when asked for: the other commands start faster without it
    from nonsmooth.testing.registered import check_class

    rows = [_row(prop) for prop in check_class(owner, name, words)]
    return {"name": name, "kind": kind, "source": source, "properties": rows}


def _row(prop: Any) -> dict[str, Any]:
    from nonsmooth.testing.outcome import NotChecked
    from nonsmooth.testing.property import Departs, PropertyFailed

    row = {"property": prop.name, "says": prop.says, "outcome": _HOLDS, "message": ""}
    try:
        prop()
    except Departs as error:
        row |= {"outcome": _DEPARTS, "message": str(error)}
    except NotChecked as error:
        row |= {"outcome": _OPEN, "message": str(error)}
    except PropertyFailed as error:
        row |= {
            "outcome": _FAILS,
            "message": str(error),
            "parameter": error.parameter,
            "value": error.value if isinstance(error.value, (int, float, str, dict)) else repr(error.value),
            "input": error.case,
        }
    return row


def _as_text(part: dict[str, Any]) -> str:
    rows = part["properties"]
    table = lines([(row["outcome"], row["property"], row["says"]) for row in rows])
    told = [row["message"] for outcome in (_OPEN, _DEPARTS, _FAILS) for row in rows if row["outcome"] == outcome]
    # properties that are not checked for the same reason are told once
    notes = [f"  {message}" for message in dict.fromkeys(told)]
    counts = ", ".join(f"{sum(row['outcome'] == o for row in rows)} {w}" for o, w in _WORDS.items())
    title = f"{part['name']}: {part['kind']} of {part['source']}"
    return "\n".join([title, "", *table, *([""] if notes else []), *notes, "", f"  {counts}"])


_WORDS = {_HOLDS: "hold", _FAILS: "fail", _DEPARTS: "known departures", _OPEN: "not checked"}
