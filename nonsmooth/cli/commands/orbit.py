"""``nonsmooth orbit``, ``continue`` and ``bifurcation``: periodic orbits, and motions along a parameter."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from nonsmooth.cli.docstrings import first_line
from nonsmooth.cli.execute.outputs import OVERWRITE, Saver
from nonsmooth.cli.parse import values
from nonsmooth.cli.parse.options import Command, Option, flag, given, names
from nonsmooth.cli.parse.request import SCENARIO, SET, TRUST, job
from nonsmooth.cli.report import orbit_report
from nonsmooth.cli.report.messages import say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Scenario
from nonsmooth.studies import Family, orbits
from nonsmooth.studies.derivatives.coordinates import coordinate_number, unit, values_of
from nonsmooth.studies.orbits.scan import drive_periods


def _section(word: str) -> orbits.PoincareSection:
    name, equals, rest = word.partition("=")
    level, colon, way = rest.partition(":")
    try:
        if name and equals and (way == "falling" if colon else True):
            return orbits.PoincareSection(name.strip(), float(level), rising=not colon)
    except ValueError:
        pass
    remedy = "For example --section phi_m=0, or --section vz=0:falling."
    raise InvalidInput("--section", "must have the form NAME=LEVEL or NAME=LEVEL:falling", word, remedy)


def _spin(word: str) -> orbits.Spin:
    body, dot, axis = word.rpartition(".")
    if not dot:
        raise InvalidInput("--spin", "must have the form BODY.AXIS", word, "For example --spin dumbbell.x.")
    return orbits.Spin(body, axis)


_required = partial(Option.of, is_required=True)
_N_VALUES = "the parameter and N values from LOW to HIGH"
_PICTURE = Option("--out", "folder of a picture and its numbers", metavar="DIR", kind=Path)
_SECTION = "NAME=LEVEL where it rises to the level, NAME=LEVEL:falling where it falls"
_ORBIT = (
    Option.of(orbits.orbit, "section", form=_SECTION, metavar="NAME=LEVEL", convert=_section),
    Option.of(orbits.orbit, "at", metavar="SECONDS"),
    Option.of(orbits.orbit, "settle", metavar="SECONDS"),
    Option.of(orbits.orbit, "within", form="NAME,NAME,...", metavar="NAMES", convert=names),
    flag("--turn", f"symmetry: {first_line(orbits.Turn)}"),
    Option("--spin", f"symmetry: {first_line(orbits.Spin)}", metavar="BODY.AXIS", repeats=True),
    _PICTURE,
    OVERWRITE,
)
_PERIOD = Option.of(orbits.orbit, "period", form="that of the driven bodies by default", metavar="SECONDS", kind=float)
_PERIOD_ALONG = f"{values.PERIOD}; that of the driven bodies by default"
_BRANCH = (
    Option.of(orbits.continuation, "period", form=_PERIOD_ALONG, metavar="SECONDS"),
    _required(orbits.continuation, "span", name="over", form="the parameter and its ends", metavar="NAME=LOW:HIGH"),
    Option("--show", "coordinate of the picture; the first of --within by default", metavar="NAME"),
)


_SAMPLES = (
    _required(orbits.bifurcation, "coordinate", name="show"),
    Option.of(orbits.bifurcation, "at", metavar="SECONDS"),
    Option.of(orbits.bifurcation, "settle"),
    Option.of(orbits.bifurcation, "keep"),
)
_BIFURCATION = (
    SCENARIO,
    SET,
    TRUST,
    _required(orbits.bifurcation, "values", name="over", form=_N_VALUES, metavar="NAME=LOW:HIGH:N"),
    Option.of(orbits.bifurcation, "period", form=_PERIOD_ALONG, metavar="SECONDS"),
    *_SAMPLES,
    flag("--follow", f"hysteresis: {first_line(orbits.hysteresis)}"),
    _PICTURE,
    OVERWRITE,
)


def _orbit(arguments: argparse.Namespace) -> bool:
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    scenario = job(arguments.scenario, arguments.set, trust=arguments.trust).scenario
    found = _found(arguments, scenario, _period(arguments, scenario))
    say(orbit_report.as_text(found))
    numbers = "\n".join(map(str, found.multipliers))
    return saver.diagram("multipliers", lambda: orbits.pictures.multipliers(found), numbers)


def _period(arguments: argparse.Namespace, scenario: Scenario) -> float | None:
    """Return the period of a request [s], by default that of the driven bodies; None if a section is given."""
    if arguments.period is not None or arguments.section is not None:
        given_period: float | None = arguments.period
        return given_period
    return _drive_period(scenario)


def _period_along(arguments: argparse.Namespace, name: str, scenario: Scenario) -> Callable[[float], float] | float:
    """Return the period of the option --period [s], as a number or as a function of the varied parameter ``name``.

    Without the option, it is a function that computes the period of the driven bodies.
    """
    if arguments.period is not None:
        return values.period(arguments.period, name)
    return lambda value: _drive_period(scenario.varied(**{name: value}))


def _drive_period(scenario: Scenario) -> float:
    """Return the period of the driven bodies of a scenario [s].

    Raises
    ------
    InvalidInput
        If no body is driven periodically, or driven bodies have different periods.
    """
    periods = drive_periods(scenario.build())
    if len(periods) != 1:
        rule = "must be given, or a section in its place"
        many = ", ".join(f"{period:.9g} s" for period in sorted(periods))
        why = f"Its driven bodies have different periods: {many}." if many else "No body of it is driven periodically."
        raise InvalidInput("orbit: period", rule, None, f"{why} Add --period SECONDS, or --section NAME=LEVEL.")
    return periods.pop()


def _continue(arguments: argparse.Namespace) -> bool:
    name, span = values.span(arguments.over)
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    scenario = job(arguments.scenario, arguments.set, trust=arguments.trust).scenario
    start = Family.of(scenario)[name]
    period = None if arguments.section is not None else _period_along(arguments, name, scenario)
    found = _found(arguments, scenario, period(start) if callable(period) else period)
    if not found.map.chart.names:
        remedy = "Choose another --section or --at, or name more of what repeats by --within."
        raise InvalidInput("orbit", "must leave something free at the section", arguments.within, remedy)
    shown, system = arguments.show or found.map.chart.names[0], found.family.model().system
    number = coordinate_number(system, shown)
    branch = orbits.continuation(found, name, span, period=period if callable(period) else None)
    say(f"{len(branch.orbits)} orbits, {name} from {branch.values.min():.9g} to {branch.values.max():.9g}")
    say(f"ends by {branch.ending}")
    for one in branch.special:
        say(f"{one.kind} at {name} = {one.value:.12g}")
    label = f"{shown} [{unit(system, number)}]"
    return saver.diagram(
        "branch",
        lambda: orbits.pictures.branch(branch, lambda orbit: float(values_of(orbit.state)[number]), label),
        _table(branch),
    )


def _found(arguments: argparse.Namespace, scenario: Scenario, period: float | None) -> orbits.Orbit:
    """Find the periodic orbit that the command line requests.

    ``period`` is the orbit's period [s]. It is None if a Poincare section defines the orbit instead.
    """
    symmetries = (*([orbits.Turn()] if arguments.turn else []), *map(_spin, arguments.spin))
    words = given(orbits.orbit, _ORBIT, arguments)
    return orbits.orbit(scenario, period, **words, symmetries=symmetries)


def _table(branch: orbits.Branch) -> str:
    """Return a branch as CSV, a row per orbit: parameter, largest magnitude of a multiplier, 1 if stable else 0."""
    rows = [f"{branch.name},largest_multiplier,stable"]
    for value, one in zip(branch.values.tolist(), branch.orbits, strict=True):
        rows.append(f"{value!r},{float(np.max(np.abs(one.multipliers)))!r},{int(one.stable)}")
    return "\n".join(rows)


def _bifurcation(arguments: argparse.Namespace) -> bool:
    """Sample the motion at each value of the parameter, print how many values have which period, and save the diagram.

    Return True if all runs and files succeeded.
    """
    values.check_not_set([arguments.over], arguments.set)
    name, row = values.axis(arguments.over)
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    scenario = job(arguments.scenario, arguments.set, trust=arguments.trust).scenario
    period, samples = _period_along(arguments, name, scenario), given(orbits.bifurcation, _SAMPLES, arguments)
    ways: dict[str, orbits.Diagram]
    found: orbits.Diagram | orbits.Hysteresis
    if arguments.follow:
        found = orbits.hysteresis(scenario, name, row, period, **samples)
        ways = {"up": found.up, "down": found.down}
        say(f"{found.apart.sum()} of {len(row)} values have two motions")
    else:
        found = orbits.bifurcation(scenario, name, row, period, **samples)
        ways = {"": found}
    for way, diagram in ways.items():
        head = f"{way}: " if way else ""
        for after, count in sorted(Counter(diagram.periods.tolist()).items()):
            words = {-1: "failed", 0: "do not repeat"}.get(after, f"repeat after {after} periods")
            say(f"{head}{count} {words}")
        if count := int(diagram.settling.sum()):
            say(f"{head}{count} still settle: take a larger --settle")
    failed = [text for diagram in ways.values() for text in diagram.failures if text]
    for text in failed[:3]:
        tell(f"failed: {text}")
    return saver.diagram("bifurcation", found.draw, _samples_table(name, arguments.show, ways)) and not failed


def _samples_table(name: str, coordinate: str, ways: dict[str, orbits.Diagram]) -> str:
    """Return the samples of a coordinate as CSV: a row for each value of the parameter and each of ``ways``.

    A way is a direction in which the parameter was varied, "up" or "down". The key "" means a single, unnamed way.
    """
    is_single = list(ways) == [""]
    keep = next(iter(ways.values())).points.shape[1]
    samples = ",".join(f"{coordinate}_{i + 1}" for i in range(keep))
    rows = [f"{'' if is_single else 'way,'}{name},{samples}"]
    for way, diagram in ways.items():
        for value, row in zip(diagram.values.tolist(), diagram.points.tolist(), strict=True):
            rows.append(",".join([*([] if is_single else [way]), repr(value), *map(repr, row)]))
    return "\n".join(rows)


COMMANDS = {
    "orbit": Command(_orbit, (SCENARIO, SET, TRUST, _PERIOD, *_ORBIT)),
    "continue": Command(_continue, (SCENARIO, SET, TRUST, *_BRANCH, *_ORBIT)),
    "bifurcation": Command(_bifurcation, _BIFURCATION),
}
