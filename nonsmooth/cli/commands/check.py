"""``nonsmooth check``: runs the conformance kit on a component, installed or of a Python file."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from typing import Any

from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.parse.request import JSON, SET, assignments
from nonsmooth.cli.report.messages import say
from nonsmooth.cli.report.table import lines
from nonsmooth.plugins import file, registry

_HOLDS, _FAILS, _DEPARTS, _OPEN = "holds", "fails", "departs", "not checked"


_NAME = Option("name", "a name or class of `nonsmooth list`, or FILE.py:CLASS", metavar="NAME")


def _execute(arguments: argparse.Namespace) -> bool:
    """Check all components of a name and print the outcomes; return True if no property fails."""
    # prints of a plug-in go to standard error, because standard output is for the result only
    with contextlib.redirect_stdout(sys.stderr):
        found = _checked(arguments.name, assignments(arguments.set))
    failed = any(row["outcome"] == _FAILS for part in found for row in part["properties"])
    if arguments.json:
        say(json.dumps({"name": arguments.name, "status": _FAILS if failed else _HOLDS, "components": found}))
    else:
        say("\n\n".join(_as_text(part) for part in found))
    return not failed


def _checked(name: str, words: dict[str, str]) -> list[dict[str, Any]]:
    if file.is_file(name):
        owner = file.load("check", registry.INTERFACES, name)
        path, _, word = name.rpartition(":")
        return [_part(owner, word, registry.kind_of(owner), path, words)]
    return [
        _part(registry.load(group, known), known, registry.KINDS[group], registry.source(group, known), words)
        for group, known in registry.called(name, registry.GROUPS)
    ]


def _part(owner: Any, name: str, kind: str, source: str, words: dict[str, str]) -> dict[str, Any]:
    # imported on use: the other commands start faster without it
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
    messages = [row["message"] for outcome in (_OPEN, _DEPARTS, _FAILS) for row in rows if row["outcome"] == outcome]
    # a reason that several properties share is printed once
    notes = [f"  {message}" for message in dict.fromkeys(messages)]
    counts = ", ".join(f"{sum(row['outcome'] == o for row in rows)} {w}" for o, w in _WORDS.items())
    title = f"{part['name']}: {part['kind']} of {part['source']}"
    return "\n".join([title, "", *table, *([""] if notes else []), *notes, "", f"  {counts}"])


_WORDS = {_HOLDS: "hold", _FAILS: "fail", _DEPARTS: "known departures", _OPEN: "not checked"}
COMMANDS = {"check": Command(_execute, (_NAME, SET, JSON))}
