"""``nonsmooth study``: looks at a study that was stored, goes on with it, draws it."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import outputs, stored
from nonsmooth.cli.asking.study import add_executor_to, executor_asked, study_of
from nonsmooth.cli.asking.trust import add_to as add_trust_to
from nonsmooth.cli.running.study import perform
from nonsmooth.cli.telling.messages import complain, say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.drawing import draw_study
from nonsmooth.studies.extras import require, require_store
from nonsmooth.studies.opening import open_study
from nonsmooth.studies.study_folder import StudyFolder
from nonsmooth.studies.summary import summary

_TOLD = 10
"""Sentences on runs without records that are told."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("study", help="look at a stored study, go on with it, draw it", allow_abbrev=False)
    parts = command.add_subparsers(title="what to do", required=True, metavar="WHAT")
    for name, execute, words in (
        ("status", status, "how far it is, and how its runs ended"),
        ("resume", resume, "go on with it"),
        ("verify", verify, "read all that is stored; exit status 1 if something is damaged"),
        ("draw", draw, "draw its records"),
    ):
        part = parts.add_parser(name, help=words, allow_abbrev=False)
        part.add_argument("study", type=Path, metavar="STUDY.zarr", help="what `--out` was given")
        part.set_defaults(execute=execute)
    add_executor_to(parts.choices["resume"])
    add_trust_to(parts.choices["resume"])
    parts.choices["draw"].add_argument("--out", type=Path, metavar="FILE", help="STUDY.png by default")
    outputs.add_to(parts.choices["draw"])


def _store(arguments: argparse.Namespace) -> StudyFolder:
    require_store()
    return StudyFolder(arguments.study)


def status(arguments: argparse.Namespace) -> bool:
    """Tell how far it is, and why runs have no records."""
    store = _store(arguments)
    texts = store.texts()
    lines = [summary(open_study(arguments.study)), f"{len(store.committed())} of {store.n_chunks} chunks are stored"]
    lines += [f"  run {run}: {text}" for run, text in sorted(texts.items())[:_TOLD]]
    if len(texts) > _TOLD:
        lines.append(f"  and {len(texts) - _TOLD} more")
    say("\n".join(lines))
    return True


def resume(arguments: argparse.Namespace) -> bool:
    """Go on with it.

    Raises
    ------
    InvalidInput
        If it was not begun on the command line.
    """
    words, path = json.loads(str(_store(arguments).attributes["request"])), arguments.study
    if not words:
        remedy = "Run the Python program again that began it: it goes on."
        raise InvalidInput(str(path), "must have been begun on the command line", "a study of a program", remedy)
    stored.check(str(path), words, stored.STUDY)
    perform(study_of(words, trust=arguments.trust, typed=False), words, path, executor_asked(arguments))
    return True


def verify(arguments: argparse.Namespace) -> bool:
    """Read all of it."""
    store = _store(arguments)
    damage = store.damage()
    for sentence in damage:
        complain(sentence)
    say(f"{len(store.committed())} of {store.n_chunks} chunks are stored, {len(damage)} files of them damaged")
    return not damage


def draw(arguments: argparse.Namespace) -> bool:
    """Draw it."""
    require("study draw", "matplotlib")
    path = arguments.out or arguments.study.with_suffix(".png")
    outputs.prepare_file(path, arguments.overwrite)
    draw_study(open_study(arguments.study)).savefig(path, dpi=150)
    tell(f"the picture is in {path}")
    return True
