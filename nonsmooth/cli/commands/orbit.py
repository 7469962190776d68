"""``nonsmooth orbit`` and ``continue``: the orbit that a scenario comes to, and orbits along a parameter."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.checks import is_finite
from nonsmooth.cli.asking import extras, outputs, over, period, request, trust
from nonsmooth.cli.running import results
from nonsmooth.cli.telling.messages import say
from nonsmooth.errors import InvalidInput, UnknownName

if TYPE_CHECKING:
    from nonsmooth.studies.orbits import Branch, Orbit, PoincareSection, Spin


def add_to(commands: Any) -> None:
    """Add both commands to the parser."""
    for name, text, execute in (
        ("orbit", "find the orbit that a scenario comes to, and its multipliers", _execute_orbit),
        ("continue", "follow that orbit along a parameter", _execute_continue),
    ):
        command = commands.add_parser(name, help=text, allow_abbrev=False)
        command.add_argument("scenario", metavar="SCENARIO", help="as for `run`")
        command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
        trust.add_to(command)
        over_name = name == "continue"
        command.add_argument(
            "--period",
            type=str if over_name else float,
            metavar="SECONDS",
            help=period.HELP if over_name else "after which what drives it repeats",
        )
        command.add_argument(
            "--section",
            metavar="NAME=LEVEL",
            help="of a scenario that nothing drives: a period ends where this coordinate or velocity rises to a level, "
            "or falls with NAME=LEVEL:falling",
        )
        command.add_argument("--at", type=float, metavar="SECONDS", help="when in each period it is looked at")
        command.add_argument(
            "--settle", type=float, default=0.0, metavar="SECONDS", help="time to run before; none by default"
        )
        command.add_argument(
            "--within",
            metavar="NAMES",
            help="coordinates and velocities that repeat, apart by commas (z,ry,vz,wy); all by default",
        )
        command.add_argument(
            "--turn", action="store_true", help="a period may turn everything about the vertical through the origin"
        )
        command.add_argument(
            "--spin",
            action="append",
            default=[],
            metavar="BODY.AXIS",
            help="a period may turn this body about its own axis, x, y or z, about which it is symmetric",
        )
        if over_name:
            command.add_argument("--over", required=True, metavar="NAME=LOW:HIGH", help="the parameter and its range")
            command.add_argument("--show", metavar="NAME", help="coordinate of the picture; the first of --within")
        command.add_argument("--out", type=Path, metavar="DIR", help="save a picture and numbers there")
        outputs.add_to(command)
        command.set_defaults(execute=execute)


def _execute_orbit(arguments: argparse.Namespace) -> bool:
    found = _found(arguments, lambda _: arguments.period)
    say(str(found))
    if arguments.out is None:
        return True
    from nonsmooth.studies.orbits.pictures import multipliers

    return save(arguments.out, "multipliers", multipliers(found), "\n".join(map(str, found.multipliers)))


def _execute_continue(arguments: argparse.Namespace) -> bool:
    name, span = over.span(arguments.over)
    asked = None if arguments.period is None else period.period(arguments.period, name)
    found = _found(arguments, lambda values: asked(_value(values, name)) if callable(asked) else asked)
    from nonsmooth.studies.derivatives.coordinates import coordinate_number, unit
    from nonsmooth.studies.orbits import continuation

    if not found.map.chart.names:
        remedy = "Choose another --section or --at, or name more of what repeats by --within."
        raise InvalidInput("orbit", "must leave something free at the section", arguments.within, remedy)
    shown = arguments.show or found.map.chart.names[0]
    system = found.family.model().system
    number = coordinate_number(system, shown)

    branch = continuation(found, name, span, period=asked if callable(asked) else None)
    say(f"{len(branch.orbits)} orbits, {name} from {branch.values.min():.9g} to {branch.values.max():.9g}")
    say(f"ends by {branch.ending}")
    for one in branch.special:
        say(f"{one.kind} at {name} = {one.value:.12g}")
    if arguments.out is None:
        return True
    from nonsmooth.studies.orbits.pictures import branch as drawn

    label = f"{shown} [{unit(system, number)}]"
    axes = drawn(branch, lambda orbit: float(np.concatenate([orbit.state.q, orbit.state.u])[number]), label)
    return save(arguments.out, "branch", axes, _table(branch))


def prepare(arguments: argparse.Namespace) -> None:
    """Look at where pictures go, if any are asked for."""
    if arguments.out is not None:
        extras.require(extras.PICTURES)
        outputs.prepare_folder(arguments.out, arguments.overwrite)
        results.without_display()


def _found(arguments: argparse.Namespace, period_of: Callable[[Mapping[str, Any]], float | None]) -> Orbit:
    """Return the orbit that was asked for, whose period may follow from the values of the scenario."""
    prepare(arguments)
    job = request.job(arguments.scenario, arguments.set, trust=arguments.trust)
    # imported when asked for: the other commands start faster without it
    from nonsmooth.studies.orbits import Turn, orbit

    within = None if arguments.within is None else tuple(word.strip() for word in arguments.within.split(","))
    section = None if arguments.section is None else _section(arguments.section)
    turns = [Turn()] if arguments.turn else []
    return orbit(
        job.scenario,
        period_of(job.scenario.values),
        section=section,
        at=arguments.at,
        settle=arguments.settle,
        within=within,
        symmetries=(*turns, *map(_spin, arguments.spin)),
    )


def _value(values: Mapping[str, Any], name: str) -> float:
    """Return the value of a parameter of the scenario."""
    known = {word: float(value) for word, value in values.items() if is_finite(value)}
    if name not in known:
        raise UnknownName("parameter", name, known)
    return known[name]


def _spin(word: str) -> Spin:
    from nonsmooth.studies.orbits import Spin

    body, dot, axis = word.rpartition(".")
    if not dot:
        raise InvalidInput("--spin", "must have the form BODY.AXIS", word, "For example --spin dumbbell.x.")
    return Spin(body, axis)


def _section(word: str) -> PoincareSection:
    from nonsmooth.studies.orbits import PoincareSection

    name, equals, told = word.partition("=")
    level, colon, way = told.partition(":")
    try:
        if name and equals and (way == "falling" if colon else True):
            return PoincareSection(name.strip(), float(level), rising=not colon)
    except ValueError:
        pass
    remedy = "For example --section phi_m=0, or --section vz=0:falling."
    raise InvalidInput("--section", "must have the form NAME=LEVEL or NAME=LEVEL:falling", word, remedy)


def _table(branch: Branch) -> str:
    """Return the values, the largest multipliers, and whether orbits are stable, as CSV."""
    rows = [f"{branch.name},largest_multiplier,stable"]
    for value, orbit in zip(branch.values.tolist(), branch.orbits, strict=True):
        rows.append(f"{value!r},{float(np.max(np.abs(orbit.multipliers)))!r},{int(orbit.stable)}")
    return "\n".join(rows)


def save(folder: Path, name: str, axes: Any, text: str) -> bool:
    """Save a picture and its numbers under a name; tell whether both could be written."""
    troubles: list[str] = []
    paths = results.save_figures({name: axes.figure}, folder, troubles)
    results.save_text(text, folder / f"{name}.csv", troubles)
    say("\n".join(map(str, [*paths, folder / f"{name}.csv"])))
    return not troubles
