"""``nonsmooth bifurcation``: where a scenario is once a period, over a parameter."""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.cli.asking import outputs, over, period, request, trust
from nonsmooth.cli.commands.orbit import prepare, save
from nonsmooth.cli.telling.messages import say, tell

if TYPE_CHECKING:
    from nonsmooth.studies.orbits import Diagram, Hysteresis


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "bifurcation", help="look once a period where a scenario is, over a parameter", allow_abbrev=False
    )
    command.add_argument("scenario", metavar="SCENARIO", help="as for `run`")
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    trust.add_to(command)
    command.add_argument("--over", required=True, metavar="NAME=LOW:HIGH:N", help="the parameter and its values")
    command.add_argument("--period", required=True, metavar="SECONDS", help=period.HELP)
    command.add_argument("--show", required=True, metavar="NAME", help="which coordinate or velocity, as vz")
    command.add_argument("--at", type=float, default=0.0, metavar="SECONDS", help="when in each period; 0 by default")
    command.add_argument("--settle", type=int, default=200, metavar="N", help="periods left out; 200 by default")
    command.add_argument("--keep", type=int, default=64, metavar="N", help="periods kept; 64 by default")
    command.add_argument(
        "--follow",
        action="store_true",
        help="start each value where the one before has come to, upwards and downwards, so that hysteresis shows",
    )
    command.add_argument("--out", type=Path, metavar="DIR", help="save a picture and numbers there")
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Run all, print how many repeat after how many periods, save; tell whether all went well."""
    over.check_not_set([arguments.over], arguments.set)
    name, values = over.axis(arguments.over)
    prepare(arguments)
    job = request.job(arguments.scenario, arguments.set, trust=arguments.trust)
    # imported when asked for: the other commands start faster without it
    from nonsmooth.studies.orbits import bifurcation, hysteresis

    given = job.scenario, name, values, period.period(arguments.period, name), arguments.show
    asked = {word: getattr(arguments, word) for word in ("at", "settle", "keep")}
    ways: dict[str, Diagram]
    found: Diagram | Hysteresis
    if arguments.follow:
        found = hysteresis(*given, **asked)
        ways = {"up": found.up, "down": found.down}
        say(f"{found.apart.sum()} of {len(values)} values have two motions")
    else:
        found = bifurcation(*given, **asked)
        ways = {"": found}
    for way, diagram in ways.items():
        for after, count in sorted(Counter(diagram.periods.tolist()).items()):
            words = {-1: "failed", 0: "do not repeat"}.get(after, f"repeat after {after} periods")
            say(f"{f'{way}: ' if way else ''}{count} {words}")
        if count := int(diagram.settling.sum()):
            say(f"{f'{way}: ' if way else ''}{count} still settle: take a larger --settle")
    failed = [text for diagram in ways.values() for text in diagram.failures if text]
    for text in failed[:3]:
        tell(f"failed: {text}")
    if arguments.out is None:
        return not failed
    looks = ",".join(f"{arguments.show}_{i + 1}" for i in range(arguments.keep))
    rows = [f"way,{name},{looks}" if arguments.follow else f"{name},{looks}"]
    for way, diagram in ways.items():
        for value, row in zip(diagram.values.tolist(), diagram.points.tolist(), strict=True):
            rows.append(",".join([*([way] if way else []), repr(value), *map(repr, row)]))
    return save(arguments.out, "bifurcation", found.draw(), "\n".join(rows)) and not failed
