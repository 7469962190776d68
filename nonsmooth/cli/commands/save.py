"""``nonsmooth save``: a scenario, as it would run, as a file."""

from __future__ import annotations

import argparse
from pathlib import Path

from nonsmooth.cli.execute.obtain import title_of
from nonsmooth.cli.parse import outputs
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.parse.request import ENGINE, LAW, SCENARIO, SET, TRUST, job
from nonsmooth.cli.report.messages import tell
from nonsmooth.files import formats
from nonsmooth.files.writing import save_system

_FILE = Option("file", "the file to write, .toml or .yaml", metavar="FILE", kind=Path)


def _execute(arguments: argparse.Namespace) -> bool:
    made = job(arguments.scenario, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    scenario = made.scenario
    formats.of(arguments.file)
    outputs.prepare_file(arguments.file, arguments.overwrite)
    save_system(
        made.build(),
        arguments.file,
        t_end=scenario.t_end,
        sample_interval=scenario.sample_interval,
        engine=made.engine,
        title=title_of(scenario),
    )
    tell(f"the system is in {arguments.file}")
    return True


COMMANDS = {"save": Command(_execute, (SCENARIO, _FILE, SET, LAW, ENGINE, TRUST, outputs.OVERWRITE))}
