"""``nonsmooth figures``: the published figures of a scenario."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from nonsmooth.cli.execute import outputs
from nonsmooth.cli.execute.perform import Interrupt
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.parse.request import SET, assignments
from nonsmooth.cli.report.messages import complain
from nonsmooth.parameters import from_all_words, with_defaults
from nonsmooth.plugins import registry
from nonsmooth.progress import ProgressMeter, on_standard_error
from nonsmooth.results.output import Output
from nonsmooth.runs.simulate import run_scenario

_OPTIONS = (
    Option("scenario", "a name of `nonsmooth list scenarios`", metavar="SCENARIO"),
    replace(SET, text=f"{SET.text}; a figure that compares values of this parameter keeps its own values"),
    Option("--out", "folder of the figures, empty or new", metavar="DIR", is_required=True),
    outputs.OVERWRITE,
)


def _execute(arguments: argparse.Namespace) -> bool:
    """Draw and save the figures; print their paths; return whether all could be saved."""
    owner = registry.load("scenarios", arguments.scenario)
    if arguments.set:
        name, values = arguments.scenario, assignments(arguments.set)
        made = from_all_words(owner, values, name, "--set {name}=VALUE")
        owner = with_defaults(owner, {name: getattr(made, name) for name in values})
    saver = outputs.Saver.of_pictures(Output.to(arguments.out).folder, arguments.overwrite)
    drawn = _draw(owner)
    if drawn is None:
        complain("interrupted: no figure was saved")
        return False
    return saver.gallery(drawn)


def _draw(owner: Any) -> Mapping[str, Any] | None:
    """Return the figures by name, or None after Ctrl-C, because figures of an incomplete run would be wrong."""
    with ProgressMeter(on_standard_error()) as meter, Interrupt() as interrupt:
        try:
            drawn: Mapping[str, Any] = owner.gallery(partial(run_scenario, progress=interrupt.progress(meter)))
        except (Exception, KeyboardInterrupt):
            if not interrupt.asked:
                raise
    return None if interrupt.asked else drawn


COMMANDS = {"figures": Command(_execute, _OPTIONS)}
