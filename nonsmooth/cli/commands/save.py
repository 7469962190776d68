"""``nonsmooth save``: a scenario, as it would run, as a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import engine, law, outputs, request, trust
from nonsmooth.cli.running import obtain
from nonsmooth.cli.telling.messages import tell
from nonsmooth.files import formats
from nonsmooth.files.writing import save_system


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("save", help="write a scenario to a file that `run` reads", allow_abbrev=False)
    command.add_argument("scenario", metavar="SCENARIO", help="see `nonsmooth list scenarios`")
    command.add_argument("file", type=Path, metavar="FILE", help="the file to write, .toml or .yaml")
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    command.add_argument("--law", action="append", default=[], metavar="ROLE=LAW", help=law.HELP)
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    trust.add_to(command)
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Write the file; tell where it is."""
    job = request.job(arguments.scenario, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    scenario = job.scenario
    formats.of(arguments.file)
    outputs.prepare_file(arguments.file, arguments.overwrite)
    save_system(
        job.build(),
        arguments.file,
        t_end=scenario.t_end,
        sample_interval=scenario.sample_interval,
        engine=job.engine,
        title=obtain.title_of(scenario),
    )
    tell(f"the system is in {arguments.file}")
    return True
