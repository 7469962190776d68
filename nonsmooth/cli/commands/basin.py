"""``nonsmooth basin``: which starts of a scenario lead to which attractor."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from nonsmooth.cli.commands.study import perform
from nonsmooth.cli.execute.outputs import OVERWRITE, Saver
from nonsmooth.cli.parse import study
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.parse.values import tolerance
from nonsmooth.cli.report.messages import say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies import Along, basin_fractions, basin_stability, features, recurrences, uncertainty_exponent
from nonsmooth.studies.attractors import pictures
from nonsmooth.studies.inputs import require
from nonsmooth.studies.study import Study

if TYPE_CHECKING:
    import xarray

_OPTIONS = (
    *study.OPTIONS,
    Option.of(recurrences, "tolerance"),
    Option.of(features, "tolerances", name="features", form="NAME=TOLERANCE,...", metavar="TOLERANCES"),
    Option.of(Along, "parameter", name="along", form="NAME, or NAME=TOLERANCE with --period or --features"),
    Option("--figures", "folder of the pictures; STUDY by default", metavar="DIR", kind=Path),
    OVERWRITE,
)


def _execute(arguments: argparse.Namespace) -> bool:
    """Run the study, find the attractors, print and draw their shares; return whether all could be saved."""
    require("basin", "matplotlib")
    tolerances = dict(tolerance("--features", part) for part in (arguments.features or "").split(",") if part)
    parameter, along = _along(arguments.along, followed=bool(tolerances) or arguments.period is not None)
    words, path = study.words_of(arguments, list(tolerances)), Path(arguments.out)
    job = study.study_of(words, trust=arguments.trust)
    _check(job, tolerances, arguments, parameter)
    folder = arguments.figures or path.with_suffix("" if path.suffix else ".figures")
    saver = Saver.of_pictures(folder, arguments.overwrite)
    found = perform(job, words, path, study.executor_given(arguments), arguments.chunk)
    if tolerances:
        found = found.assign(features(found, tolerances, along))
    elif arguments.period is not None:
        found = found.assign(recurrences(found, arguments.tolerance, along))
    say(_shares(found.attractor))
    drawn = {"basins": pictures.basins(found), "shares": pictures.shares(found.attractor).figure}
    if found.attractor.ndim > 1:
        try:
            boundary = uncertainty_exponent(found.attractor)
        except InvalidInput as error:
            tell(f"no uncertainty exponent: {error}")
        else:
            say(f"uncertainty exponent of the boundary {boundary.exponent:.3f} ± {boundary.error:.3f}")
            drawn["uncertainty"] = pictures.uncertainty(boundary).figure
    if parameter:
        drawn["fractions"] = pictures.fractions(basin_fractions(found.attractor, parameter)).figure
    return saver.gallery(drawn)


def _check(job: Study, tolerances: dict[str, float], arguments: argparse.Namespace, parameter: str) -> None:
    """Check before the runs that there will be attractors."""
    if tolerances and arguments.period is not None:
        raise InvalidInput("--features", "must be left out with --period", arguments.features, "Take one of them.")
    if not (tolerances or arguments.period is not None or "attractor" in job.records):
        remedy = "Give --period and --within, or --features."
        raise InvalidInput(arguments.scenario, "must classify its runs for `basin`", list(job.records), remedy)
    varied = [word.partition("=")[0].strip() for word in arguments.over]
    if parameter and parameter not in varied:
        raise InvalidInput("--along", "must name a parameter of --over", parameter, f"Varied: {', '.join(varied)}.")


def _along(word: str | None, *, followed: bool) -> tuple[str, Along | None]:
    """Return the parameter of ``--along``, "" for none, and how attractors are matched along it."""
    name = (word or "").partition("=")[0]
    return name, Along(*tolerance("--along", word)) if word and followed else None


def _shares(attractor: xarray.DataArray) -> str:
    stability = basin_stability(attractor)
    named = pictures.largest(stability)
    lines = ["{}: basin stability {:.4f} ± {:.4f}".format(word, *stability[word]) for word in named]
    more = sum(share > 0.0 for share, _ in stability.values()) - len(named)
    if more:
        lines.append(f"and {more} more: a larger tolerance, or longer runs, may leave fewer")
    failed = int((attractor < 0).sum())
    if failed:
        lines.append(f"{failed} runs failed: see `nonsmooth study status`")
    return "\n".join(lines)


COMMANDS = {"basin": Command(_execute, _OPTIONS)}
