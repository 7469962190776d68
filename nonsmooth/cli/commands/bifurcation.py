"""``nonsmooth bifurcation``: a coordinate once a period, over a parameter."""

from __future__ import annotations

import argparse
from collections import Counter

from nonsmooth.cli.commands.orbit import PICTURE
from nonsmooth.cli.docstrings import first_line
from nonsmooth.cli.execute.outputs import OVERWRITE, Saver
from nonsmooth.cli.parse import values
from nonsmooth.cli.parse.options import Command, Option, flag, given
from nonsmooth.cli.parse.request import SCENARIO, SET, TRUST, job
from nonsmooth.cli.report.messages import say, tell
from nonsmooth.studies.orbits import Diagram, Hysteresis, bifurcation, hysteresis

_SAMPLES = (
    Option.of(bifurcation, "coordinate", name="show", is_required=True),
    Option.of(bifurcation, "at", metavar="SECONDS"),
    Option.of(bifurcation, "settle"),
    Option.of(bifurcation, "keep"),
)
_OPTIONS = (
    SCENARIO,
    SET,
    TRUST,
    Option.of(
        bifurcation,
        "values",
        name="over",
        form="the parameter and N values from LOW to HIGH",
        metavar="NAME=LOW:HIGH:N",
        is_required=True,
    ),
    Option.of(bifurcation, "period", form=values.PERIOD, metavar="SECONDS", is_required=True),
    *_SAMPLES,
    flag("--follow", f"hysteresis: {first_line(hysteresis)}"),
    PICTURE,
    OVERWRITE,
)


def _execute(arguments: argparse.Namespace) -> bool:
    """Run all values, print how many repeat after how many periods, save; return whether all succeeded."""
    values.check_not_set([arguments.over], arguments.set)
    name, row = values.axis(arguments.over)
    saver = Saver.of_pictures(arguments.out, arguments.overwrite)
    scenario = job(arguments.scenario, arguments.set, trust=arguments.trust).scenario
    period, samples = values.period(arguments.period, name), given(bifurcation, _SAMPLES, arguments)
    ways: dict[str, Diagram]
    found: Diagram | Hysteresis
    if arguments.follow:
        found = hysteresis(scenario, name, row, period, **samples)
        ways = {"up": found.up, "down": found.down}
        say(f"{found.apart.sum()} of {len(row)} values have two motions")
    else:
        found = bifurcation(scenario, name, row, period, **samples)
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
    return saver.diagram("bifurcation", found.draw, _table(name, arguments.show, ways)) and not failed


def _table(name: str, coordinate: str, ways: dict[str, Diagram]) -> str:
    """Return the samples as CSV, a row for each value."""
    is_single = list(ways) == [""]
    keep = next(iter(ways.values())).points.shape[1]
    samples = ",".join(f"{coordinate}_{i + 1}" for i in range(keep))
    rows = [f"{'' if is_single else 'way,'}{name},{samples}"]
    for way, diagram in ways.items():
        for value, row in zip(diagram.values.tolist(), diagram.points.tolist(), strict=True):
            rows.append(",".join([*([] if is_single else [way]), repr(value), *map(repr, row)]))
    return "\n".join(rows)


COMMANDS = {"bifurcation": Command(_execute, _OPTIONS)}
