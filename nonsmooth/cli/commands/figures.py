"""``nonsmooth figures``: the published figures of a scenario."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial
from typing import Any

from nonsmooth.cli.asking import extras, outputs
from nonsmooth.cli.running import results
from nonsmooth.cli.running.interrupt import Interrupt
from nonsmooth.cli.telling.messages import complain, say
from nonsmooth.plugins import registry
from nonsmooth.progress import Pace, TimeReached, on_standard_error
from nonsmooth.results.output import Output
from nonsmooth.runs.simulate import run_scenario


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("figures", help="draw all figures of a scenario", allow_abbrev=False)
    command.add_argument("scenario", metavar="SCENARIO", help="see `nonsmooth list scenarios`")
    command.add_argument("--out", metavar="DIR", required=True, help="save them there, in an empty or new folder")
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Draw and save the figures; print their paths; tell whether all went well."""
    owner = registry.load("scenarios", arguments.scenario)
    extras.require(extras.PICTURES)
    folder = Output.to(arguments.out).folder
    outputs.prepare_folder(folder, arguments.overwrite)
    results.without_display()
    drawn = _draw(owner)
    if drawn is None:
        complain("interrupted: no figure was saved")
        return False
    troubles: list[str] = []
    paths = results.save_figures(drawn, folder, troubles)
    say("\n".join(map(str, paths)))
    return not troubles


def _draw(owner: Any) -> Mapping[str, Any] | None:
    """Return the figures by name, None after Ctrl-C: figures of half a run would be wrong ones."""

    def after_steps(t: float, t_end: float) -> None:
        progress(t, t_end)
        if t < t_end:
            interrupt.check()

    with Pace(on_standard_error()) as pace, Interrupt() as interrupt:
        progress = TimeReached(pace)
        try:
            drawn: Mapping[str, Any] = owner.gallery(partial(run_scenario, progress=after_steps))
        except (Exception, KeyboardInterrupt):
            if not interrupt.asked:
                raise
    return None if interrupt.asked else drawn
