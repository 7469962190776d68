"""``nonsmooth sweep``: a scenario over parameters."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import study
from nonsmooth.cli.running.study import perform


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("sweep", help="run a scenario over parameters", allow_abbrev=False)
    study.add_to(command)
    command.add_argument(
        "--record",
        action="append",
        default=[],
        metavar="NAME",
        help="what is kept of each run, apart by commas, besides status and reason: q_end, u_end, a number of the "
        f"scenario's summary; {','.join(study.RECORD)} by default, with the attractor where the scenario has one",
    )
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Run the study; tell what came of it."""
    record = [name for word in arguments.record for name in word.split(",")]
    words = study.asked(arguments, record)
    perform(
        study.study_of(words, trust=arguments.trust),
        words,
        Path(arguments.out),
        study.executor_asked(arguments),
        arguments.chunk,
    )
    return True
