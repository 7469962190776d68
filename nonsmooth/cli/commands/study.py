"""``nonsmooth sweep`` and ``basin``, which run a study, and ``study``, which shows, continues, checks or draws one."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth import studies
from nonsmooth.cli.execute import outputs
from nonsmooth.cli.parse.options import Command, CommandGroup, Option
from nonsmooth.cli.parse.request import TRUST, check_stored
from nonsmooth.cli.parse.study import EXECUTOR, OPTIONS, RECORD_OPTION, STUDY_WORDS, executor_given, study_of, words_of
from nonsmooth.cli.parse.values import tolerance
from nonsmooth.cli.report.messages import complain, say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors import pictures
from nonsmooth.studies.inputs import require
from nonsmooth.studies.status import summary
from nonsmooth.studies.study_folder import StudyFolder

if TYPE_CHECKING:
    import xarray

_MOST = 10
"""Largest number of failed runs whose reasons ``study status`` prints."""
_STUDY = Option("study", "the folder that `--out` was given", metavar="STUDY.zarr", kind=Path)
_OUT = Option("--out", "STUDY.png by default", metavar="FILE", kind=Path)


_BASIN = (
    *OPTIONS,
    Option.of(studies.recurrences, "tolerance"),
    Option.of(studies.features, "tolerances", name="features", form="NAME=TOLERANCE,...", metavar="TOLERANCES"),
    Option.of(studies.Along, "parameter", name="along", form="NAME, or NAME=TOLERANCE with --period or --features"),
    Option("--figures", "folder of the pictures; STUDY by default", metavar="DIR", kind=Path),
    outputs.OVERWRITE,
)


def _performed(
    study: studies.Study, words: Mapping[str, Any], path: Path, executor: studies.Executor, chunk: int | None = None
) -> xarray.Dataset:
    """Run or continue a study, store its request with it, print a summary, and return its records."""
    try:
        # prints of a plug-in go to standard error, because standard output is for the result only
        with contextlib.redirect_stdout(sys.stderr):
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
    _performed(study, words, path, executor_given(arguments), arguments.chunk)
    return True


def _basin(arguments: argparse.Namespace) -> bool:
    """Run a study, find attractors, print and draw their basin stabilities; return whether all could be saved."""
    require("basin", "matplotlib")
    tolerances = dict(tolerance("--features", part) for part in (arguments.features or "").split(",") if part)
    parameter, along = _along(arguments.along, followed=bool(tolerances) or arguments.period is not None)
    words, path = words_of(arguments, list(tolerances)), Path(arguments.out)
    job = study_of(words, trust=arguments.trust)
    _check_attractors(job, tolerances, arguments, parameter)
    folder = arguments.figures or path.with_suffix("" if path.suffix else ".figures")
    saver = outputs.Saver.of_pictures(folder, arguments.overwrite)
    found = _performed(job, words, path, executor_given(arguments), arguments.chunk)
    if tolerances:
        found = found.assign(studies.features(found, tolerances, along))
    elif arguments.period is not None:
        found = found.assign(studies.recurrences(found, arguments.tolerance, along))
    say(_shares(found.attractor))
    drawn = {"basins": pictures.basins(found), "shares": pictures.shares(found.attractor).figure}
    if found.attractor.ndim > 1:
        try:
            boundary = studies.uncertainty_exponent(found.attractor)
        except InvalidInput as error:
            tell(f"no uncertainty exponent: {error}")
        else:
            say(f"uncertainty exponent of the boundary {boundary.exponent:.3f} ± {boundary.error:.3f}")
            drawn["uncertainty"] = pictures.uncertainty(boundary).figure
    if parameter:
        drawn["fractions"] = pictures.fractions(studies.basin_fractions(found.attractor, parameter)).figure
    return saver.gallery(drawn)


def _check_attractors(
    job: studies.Study, tolerances: dict[str, float], arguments: argparse.Namespace, parameter: str
) -> None:
    """Check before the runs that the request defines attractors, and that ``--along`` names a varied parameter."""
    if tolerances and arguments.period is not None:
        raise InvalidInput("--features", "must be left out with --period", arguments.features, "Take one of them.")
    if not (tolerances or arguments.period is not None or "attractor" in job.records):
        remedy = "Give --period and --within, or --features."
        raise InvalidInput(arguments.scenario, "must classify its runs for `basin`", list(job.records), remedy)
    varied = [word.partition("=")[0].strip() for word in arguments.over]
    if parameter and parameter not in varied:
        raise InvalidInput("--along", "must name a parameter of --over", parameter, f"Varied: {', '.join(varied)}.")


def _along(word: str | None, *, followed: bool) -> tuple[str, studies.Along | None]:
    """Return the parameter of ``--along`` ("" if left out), and the rule that matches attractors along it, or None."""
    name = (word or "").partition("=")[0]
    return name, studies.Along(*tolerance("--along", word)) if word and followed else None


def _shares(attractor: xarray.DataArray) -> str:
    stability = studies.basin_stability(attractor)
    named = pictures.largest(stability)
    lines = ["{}: basin stability {:.4f} ± {:.4f}".format(word, *stability[word]) for word in named]
    more = sum(share > 0.0 for share, _ in stability.values()) - len(named)
    if more:
        lines.append(f"and {more} more: a larger tolerance, or longer runs, may leave fewer")
    failed = int((attractor < 0).sum())
    if failed:
        lines.append(f"{failed} runs failed: see `nonsmooth study status`")
    return "\n".join(lines)


def _store(arguments: argparse.Namespace) -> StudyFolder:
    require("a study", "xarray")
    return StudyFolder(arguments.study)


def _status(arguments: argparse.Namespace) -> bool:
    store = _store(arguments)
    texts = store.texts()
    lines = [
        summary(studies.open_study(arguments.study)),
        f"{len(store.committed())} of {store.n_chunks} chunks are stored",
    ]
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
    _performed(study_of(words, trust=arguments.trust, typed=False), words, path, executor_given(arguments))
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
    studies.draw_study(studies.open_study(arguments.study)).savefig(path, dpi=150)
    tell(f"the picture is in {path}")
    return True


_PARTS = {
    "status": Command(_status, (_STUDY,), "number of stored runs, and how they ended"),
    "resume": Command(_resume, (_STUDY, *EXECUTOR, TRUST), "continue it"),
    "verify": Command(_verify, (_STUDY,), "read all chunks; exit status 1 if one is damaged"),
    "draw": Command(_draw, (_STUDY, _OUT, outputs.OVERWRITE), "draw its records"),
}
COMMANDS = {
    "sweep": Command(_sweep, (*OPTIONS, RECORD_OPTION)),
    "basin": Command(_basin, _BASIN),
    "study": CommandGroup("actions", "ACTION", _PARTS),
}
