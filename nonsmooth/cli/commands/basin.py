"""``nonsmooth basin``: which starts of a scenario lead to which attractor."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.cli.asking import outputs, study
from nonsmooth.cli.running import results
from nonsmooth.cli.running.study import perform
from nonsmooth.cli.telling.messages import say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors import (
    Along,
    basin_fractions,
    basin_stability,
    features,
    pictures,
    recurrences,
    uncertainty_exponent,
)
from nonsmooth.studies.inputs import require
from nonsmooth.studies.study import Study

if TYPE_CHECKING:
    import xarray


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("basin", help="tell which starts lead to which attractor", allow_abbrev=False)
    study.add_to(command)
    command.add_argument(
        "--tolerance",
        type=float,
        default=1e-3,
        metavar="X",
        help="with --period: what counts as one point, in units of the size of bodies and of the speed of a fall "
        "through it; 1e-3 by default",
    )
    command.add_argument(
        "--features",
        metavar="NAME=TOLERANCE,...",
        help="tell attractors apart by these numbers of the scenario's summary, each with the difference that counts "
        "as none, in its unit",
    )
    command.add_argument(
        "--along",
        metavar="NAME[=TOLERANCE]",
        help="draw the shares along this parameter; attractors told apart by --period or --features are followed from "
        "value to value, no farther than the tolerance each",
    )
    command.add_argument("--figures", type=Path, metavar="DIR", help="where pictures go; STUDY by default")
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Run the study, tell the attractors apart, print their shares, draw them; tell whether all could be saved."""
    require("basin", "matplotlib")
    tolerances = _features(arguments.features)
    parameter, along = _along(arguments.along, followed=bool(tolerances) or arguments.period is not None)
    words, path = study.asked(arguments, list(tolerances)), Path(arguments.out)
    job = study.study_of(words, trust=arguments.trust)
    _check(job, tolerances, arguments, parameter)
    folder = arguments.figures or path.with_suffix("" if path.suffix else ".figures")
    outputs.prepare_folder(folder, arguments.overwrite)
    results.without_display()
    found = perform(job, words, path, study.executor_asked(arguments), arguments.chunk)
    if tolerances:
        found = found.assign(features(found, tolerances, along))
    elif arguments.period is not None:
        found = found.assign(recurrences(found, arguments.tolerance, along))
    _tell_shares(found.attractor)
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
    troubles: list[str] = []
    say("\n".join(map(str, results.save_figures(drawn, folder, troubles))))
    return not troubles


def _check(job: Study, tolerances: dict[str, float], arguments: argparse.Namespace, parameter: str) -> None:
    """Look whether there will be attractors."""
    if tolerances and arguments.period is not None:
        raise InvalidInput("--features", "must be left out with --period", arguments.features, "Take one of them.")
    if not (tolerances or arguments.period is not None or "attractor" in job.records):
        remedy = "Give --period and --within, or --features."
        raise InvalidInput(arguments.scenario, "must classify its runs for `basin`", list(job.records), remedy)
    varied = [word.partition("=")[0].strip() for word in arguments.over]
    if parameter and parameter not in varied:
        raise InvalidInput("--along", "must name a parameter of --over", parameter, f"Varied: {', '.join(varied)}.")


def _features(word: str | None) -> dict[str, float]:
    """Return the tolerance of each feature."""
    found: dict[str, float] = {}
    for part in word.split(",") if word else ():
        name, _, tolerance = part.partition("=")
        found[name.strip()] = _number("--features", tolerance, word, "For example --features last_flight=1e-3.")
    return found


def _along(word: str | None, *, followed: bool) -> tuple[str, Along | None]:
    """Return the parameter, "" for none, and how attractors are followed along it."""
    name, _, tolerance = (word or "").partition("=")
    if not (name and followed):
        return name, None
    return name, Along(name, _number("--along", tolerance, word, f"For example --along {name}=0.5."))


def _number(thing: str, number: str, word: str | None, remedy: str) -> float:
    try:
        return float(number)
    except ValueError:
        raise InvalidInput(thing, "must have the form NAME=TOLERANCE", word, remedy) from None


def _tell_shares(attractor: xarray.DataArray) -> None:
    stability = basin_stability(attractor)
    told = pictures.largest(stability)
    lines = ["{}: basin stability {:.4f} ± {:.4f}".format(word, *stability[word]) for word in told]
    more = sum(share > 0.0 for share, _ in stability.values()) - len(told)
    if more:
        lines.append(f"and {more} more: a larger tolerance, or longer runs, may leave fewer")
    failed = int((attractor < 0).sum())
    if failed:
        lines.append(f"{failed} runs failed: see `nonsmooth study status`")
    say("\n".join(lines))
