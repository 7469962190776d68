"""``nonsmooth orbit`` and ``continue``: a periodic orbit of a scenario, and its branch along a parameter."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from nonsmooth.checks import is_finite
from nonsmooth.cli.docstrings import first_line
from nonsmooth.cli.execute.outputs import OVERWRITE, Saver
from nonsmooth.cli.parse import values
from nonsmooth.cli.parse.options import Command, Option, flag, given, names
from nonsmooth.cli.parse.request import SCENARIO, SET, TRUST, job
from nonsmooth.cli.report.messages import say
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.derivatives.coordinates import coordinate_number, unit, values_of
from nonsmooth.studies.orbits import Branch, Orbit, PoincareSection, Spin, Turn, continuation, orbit, pictures


def _section(word: str) -> PoincareSection:
    name, equals, rest = word.partition("=")
    level, colon, way = rest.partition(":")
    try:
        if name and equals and (way == "falling" if colon else True):
            return PoincareSection(name.strip(), float(level), rising=not colon)
    except ValueError:
        pass
    remedy = "For example --section phi_m=0, or --section vz=0:falling."
    raise InvalidInput("--section", "must have the form NAME=LEVEL or NAME=LEVEL:falling", word, remedy)


def _spin(word: str) -> Spin:
    body, dot, axis = word.rpartition(".")
    if not dot:
        raise InvalidInput("--spin", "must have the form BODY.AXIS", word, "For example --spin dumbbell.x.")
    return Spin(body, axis)


PICTURE = Option("--out", "folder of a picture and its numbers", metavar="DIR", kind=Path)
_SECTION = "NAME=LEVEL where it rises to the level, NAME=LEVEL:falling where it falls"
_ORBIT = (
    Option.of(orbit, "section", form=_SECTION, metavar="NAME=LEVEL", convert=_section),
    Option.of(orbit, "at", metavar="SECONDS"),
    Option.of(orbit, "settle", metavar="SECONDS"),
    Option.of(orbit, "within", form="NAME,NAME,...", metavar="NAMES", convert=names),
    flag("--turn", f"symmetry: {first_line(Turn)}"),
    Option("--spin", f"symmetry: {first_line(Spin)}", metavar="BODY.AXIS", repeats=True),
    PICTURE,
    OVERWRITE,
)
_PERIOD = Option.of(orbit, "period", metavar="SECONDS")
_BRANCH = (
    Option.of(continuation, "period", form=values.PERIOD, metavar="SECONDS"),
    Option.of(
        continuation, "span", name="over", form="the parameter and its ends", metavar="NAME=LOW:HIGH", is_required=True
    ),
    Option("--show", "coordinate of the picture; the first of --within by default", metavar="NAME"),
)


def _orbit(arguments: argparse.Namespace) -> bool:
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    found = _found(arguments, lambda _: arguments.period)
    say(str(found))
    numbers = "\n".join(map(str, found.multipliers))
    return saver.diagram("multipliers", lambda: pictures.multipliers(found), numbers)


def _continue(arguments: argparse.Namespace) -> bool:
    name, span = values.span(arguments.over)
    period = None if arguments.period is None else values.period(arguments.period, name)
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    found = _found(arguments, lambda known: period(_value(known, name)) if callable(period) else period)
    if not found.map.chart.names:
        remedy = "Choose another --section or --at, or name more of what repeats by --within."
        raise InvalidInput("orbit", "must leave something free at the section", arguments.within, remedy)
    shown, system = arguments.show or found.map.chart.names[0], found.family.model().system
    number = coordinate_number(system, shown)
    branch = continuation(found, name, span, period=period if callable(period) else None)
    say(f"{len(branch.orbits)} orbits, {name} from {branch.values.min():.9g} to {branch.values.max():.9g}")
    say(f"ends by {branch.ending}")
    for one in branch.special:
        say(f"{one.kind} at {name} = {one.value:.12g}")
    label = f"{shown} [{unit(system, number)}]"
    return saver.diagram(
        "branch",
        lambda: pictures.branch(branch, lambda orbit: float(values_of(orbit.state)[number]), label),
        _table(branch),
    )


def _found(arguments: argparse.Namespace, period_of: Callable[[Mapping[str, Any]], float | None]) -> Orbit:
    """Return the orbit of a request; its period may follow from the values of the scenario."""
    scenario = job(arguments.scenario, arguments.set, trust=arguments.trust).scenario
    symmetries = (*([Turn()] if arguments.turn else []), *map(_spin, arguments.spin))
    return orbit(scenario, period_of(scenario.values), **given(orbit, _ORBIT, arguments), symmetries=symmetries)


def _value(known: Mapping[str, Any], name: str) -> float:
    """Return the value of a parameter of the scenario."""
    numbers = {word: float(value) for word, value in known.items() if is_finite(value)}
    if name not in numbers:
        raise UnknownName("parameter", name, numbers)
    return numbers[name]


def _table(branch: Branch) -> str:
    """Return values, largest multipliers and stability of a branch as CSV."""
    rows = [f"{branch.name},largest_multiplier,stable"]
    for value, one in zip(branch.values.tolist(), branch.orbits, strict=True):
        rows.append(f"{value!r},{float(np.max(np.abs(one.multipliers)))!r},{int(one.stable)}")
    return "\n".join(rows)


COMMANDS = {
    "orbit": Command(_orbit, (SCENARIO, SET, TRUST, _PERIOD, *_ORBIT)),
    "continue": Command(_continue, (SCENARIO, SET, TRUST, *_BRANCH, *_ORBIT)),
}
