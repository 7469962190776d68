"""``nonsmooth sweep``, which runs a study, and ``nonsmooth study``, which shows, continues, checks or draws one."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.cli.execute import outputs
from nonsmooth.cli.parse.options import Command, CommandGroup, Option
from nonsmooth.cli.parse.request import TRUST, check_stored
from nonsmooth.cli.parse.study import EXECUTOR, OPTIONS, RECORD_OPTION, STUDY_WORDS, executor_given, study_of, words_of
from nonsmooth.cli.report.messages import complain, say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies import Executor, Study, draw_study, open_study
from nonsmooth.studies.inputs import require, require_store
from nonsmooth.studies.status import summary
from nonsmooth.studies.study_folder import StudyFolder

if TYPE_CHECKING:
    import xarray

_MOST = 10
"""Reasons of failed runs that are printed."""
_STUDY = Option("study", "the folder that `--out` was given", metavar="STUDY.zarr", kind=Path)
_OUT = Option("--out", "STUDY.png by default", metavar="FILE", kind=Path)


def perform(
    study: Study, words: Mapping[str, Any], path: Path, executor: Executor, chunk: int | None = None
) -> xarray.Dataset:
    """Run or continue a study; store the words of its request with it, report and return its records."""
    try:
        with contextlib.redirect_stdout(sys.stderr):  # output of a plug-in
            found = study.run(path, executor=executor, chunk=chunk, request=words)
    except KeyboardInterrupt:
        tell(f"complete chunks stay: `nonsmooth study resume {path}` continues")
        raise
    say(summary(found))
    if texts := StudyFolder(path).texts():
        first = min(texts)
        tell(f"{len(texts)} runs have no records; the first is run {first}: {texts[first]}")
    tell(f"the study is in {path}")
    return found


def _sweep(arguments: argparse.Namespace) -> bool:
    record = [name for word in arguments.record for name in word.split(",")]
    words = words_of(arguments, record)
    study, path = study_of(words, trust=arguments.trust), Path(arguments.out)
    perform(study, words, path, executor_given(arguments), arguments.chunk)
    return True


def _store(arguments: argparse.Namespace) -> StudyFolder:
    require_store()
    return StudyFolder(arguments.study)


def _status(arguments: argparse.Namespace) -> bool:
    store = _store(arguments)
    texts = store.texts()
    lines = [summary(open_study(arguments.study)), f"{len(store.committed())} of {store.n_chunks} chunks are stored"]
    lines += [f"  run {run}: {text}" for run, text in sorted(texts.items())[:_MOST]]
    if len(texts) > _MOST:
        lines.append(f"  and {len(texts) - _MOST} more")
    say("\n".join(lines))
    return True


def _resume(arguments: argparse.Namespace) -> bool:
    words, path = json.loads(str(_store(arguments).attributes["request"])), arguments.study
    if not words:
        remedy = "Run the Python program again that began it: the study continues."
        raise InvalidInput(str(path), "must have been begun on the command line", "a study of a program", remedy)
    check_stored(str(path), words, STUDY_WORDS)
    perform(study_of(words, trust=arguments.trust, typed=False), words, path, executor_given(arguments))
    return True


def _verify(arguments: argparse.Namespace) -> bool:
    store = _store(arguments)
    damage = store.damage()
    for sentence in damage:
        complain(sentence)
    say(f"{len(store.committed())} of {store.n_chunks} chunks are stored, {len(damage)} files of them damaged")
    return not damage


def _draw(arguments: argparse.Namespace) -> bool:
    require("study draw", "matplotlib")
    path = arguments.out or arguments.study.with_suffix(".png")
    outputs.prepare_file(path, arguments.overwrite)
    draw_study(open_study(arguments.study)).savefig(path, dpi=150)
    tell(f"the picture is in {path}")
    return True


_PARTS = {
    "status": Command(_status, (_STUDY,), "number of stored runs, and how they ended"),
    "resume": Command(_resume, (_STUDY, *EXECUTOR, TRUST), "continue it"),
    "verify": Command(_verify, (_STUDY,), "read all chunks; exit status 1 if one is damaged"),
    "draw": Command(_draw, (_STUDY, _OUT, outputs.OVERWRITE), "draw its records"),
}
COMMANDS = {"sweep": Command(_sweep, (*OPTIONS, RECORD_OPTION)), "study": CommandGroup("actions", "ACTION", _PARTS)}
