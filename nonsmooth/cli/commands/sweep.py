"""``nonsmooth sweep``: a scenario over parameters."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import engine, over, request
from nonsmooth.cli.telling.messages import say, tell
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.executors import Dask
from nonsmooth.studies.executors.executor import Executor
from nonsmooth.studies.study import EXECUTORS, Study, executor_of
from nonsmooth.studies.summary import summary

_ASKED = ("scenario", "over", "sample", "seed", "set", "engine", "record", "budget")
_RECORD = ("t_end", "impacts", "events", "steps", "energy_residual")


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("sweep", help="run a scenario over parameters", allow_abbrev=False)
    command.add_argument("scenario", metavar="SCENARIO", help="a name of `nonsmooth list scenarios`, or FILE.py:CLASS")
    command.add_argument("--over", action="append", default=[], metavar="NAME=VALUES", help=over.HELP)
    command.add_argument(
        "--sample", metavar="KIND:N", help="draw N runs: random, sobol (N a power of two), latin_hypercube"
    )
    command.add_argument("--seed", type=int, default=0, help="of what is drawn; 0 by default")
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    command.add_argument(
        "--record",
        action="append",
        default=[],
        metavar="NAME",
        help="what is kept of each run, apart by commas, besides status and reason: q_end, u_end, a number of the "
        f"scenario's summary; {','.join(_RECORD)} by default, with the attractor where the scenario has one",
    )
    command.add_argument("--budget", type=int, metavar="STEPS", help="give up a run after so many steps")
    command.add_argument("--chunk", type=int, metavar="N", help="store so many runs as one")
    add_executor_to(command)
    command.add_argument(
        "--out", required=True, metavar="STUDY.zarr", help="save it there; it goes on if it was cut off"
    )
    command.set_defaults(execute=execute)


def add_executor_to(command: argparse.ArgumentParser) -> None:
    """Add what says who does it to the parser of a command."""
    command.add_argument("--executor", default="threads", metavar="|".join(EXECUTORS), help="threads by default")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of dask, as tcp://10.0.0.1:8786; implies dask")


def execute(arguments: argparse.Namespace) -> bool:
    """Run the study; tell what came of it."""
    return perform(
        {name: getattr(arguments, name) for name in _ASKED},
        Path(arguments.out),
        executor_asked(arguments),
        arguments.chunk,
    )


def executor_asked(arguments: argparse.Namespace) -> Executor:
    """Return the executor of a request."""
    return Dask(arguments.scheduler) if arguments.scheduler else executor_of(arguments.executor)


def perform(asked: Mapping[str, Any], path: Path, executor: Executor, chunk: int | None = None) -> bool:
    """Run, or go on with, what was asked for in words."""
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints
        job = request.job(asked["scenario"], asked["set"], (), asked["engine"])
        sampling = over.sampling(asked["over"], asked["sample"], asked["seed"])
        names = [name for word in asked["record"] for name in word.split(",")]
        classes = [name for name in job.scenario.words if name == "attractor"]
        study = Study(job.scenario, sampling, names or [*_RECORD, *classes], engine=job.engine, budget=asked["budget"])
        found = study.run(path, executor=executor, chunk=chunk, request=asked)
    say(summary(found))
    tell(f"the study is in {path}")
    return True


def resumed(words: Mapping[str, Any], path: Path, executor: Executor) -> bool:
    """Go on with a study.

    Raises
    ------
    InvalidInput
        If it was not begun on the command line.
    """
    if not words:
        remedy = "Run the Python program again that began it: it goes on."
        raise InvalidInput(str(path), "must have been begun by `nonsmooth sweep`", "a study of a program", remedy)
    return perform(words, path, executor)
