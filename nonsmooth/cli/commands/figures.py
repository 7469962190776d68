"""``nonsmooth figures``: the published figures of a scenario."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial
from typing import Any

from nonsmooth.cli.execute import saving
from nonsmooth.cli.execute.interrupt import Interrupt
from nonsmooth.cli.parse import outputs
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.report.messages import complain, say
from nonsmooth.plugins import registry
from nonsmooth.progress import ProgressMeter, TimeReached, on_standard_error
from nonsmooth.results.output import Output
from nonsmooth.runs.simulate import run_scenario

_OPTIONS = (
    Option("scenario", "a name of `nonsmooth list scenarios`", metavar="SCENARIO"),
    Option("--out", "folder of the figures, empty or new", metavar="DIR", is_required=True),
    outputs.OVERWRITE,
)


def _execute(arguments: argparse.Namespace) -> bool:
    """Draw and save the figures; print their paths; return whether all could be saved."""
    owner = registry.load("scenarios", arguments.scenario)
    outputs.require_matplotlib()
    folder = Output.to(arguments.out).folder
    outputs.prepare_folder(folder, arguments.overwrite)
    saving.without_display()
    drawn = _draw(owner)
    if drawn is None:
        complain("interrupted: no figure was saved")
        return False
    troubles: list[str] = []
    say("\n".join(map(str, saving.save_figures(drawn, folder, troubles))))
    return not troubles


def _draw(owner: Any) -> Mapping[str, Any] | None:
    """Return the figures by name, None after Ctrl-C: figures of half a run would be wrong ones."""

    def after_steps(t: float, t_end: float) -> None:
        progress(t, t_end)
        if t < t_end:
            interrupt.check()

    with ProgressMeter(on_standard_error()) as meter, Interrupt() as interrupt:
        progress = TimeReached(meter)
        try:
            drawn: Mapping[str, Any] = owner.gallery(partial(run_scenario, progress=after_steps))
        except (Exception, KeyboardInterrupt):
            if not interrupt.asked:
                raise
    return None if interrupt.asked else drawn


COMMANDS = {"figures": Command(_execute, _OPTIONS)}
