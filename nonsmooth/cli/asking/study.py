"""What the words of a request say of a study, and who does it."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Mapping
from typing import Any

from nonsmooth.cli.asking import engine, over, request
from nonsmooth.cli.asking.trust import add_to as add_trust_to
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.executors import Dask
from nonsmooth.studies.executors.executor import Executor
from nonsmooth.studies.records import Stroboscope
from nonsmooth.studies.records.recorders import Asked
from nonsmooth.studies.study import EXECUTORS, Study, check_chunk, executor_of

RECORD = ("t_end", "impacts", "events", "steps", "energy_residual")
"""What is kept where nothing is asked for, besides the attractor of a scenario that classifies its runs."""
_STROBOSCOPE = ("period", "within", "keep", "at", "phase")
_ASKED = ("scenario", "over", "sample", "seed", "set", "engine", "budget", *_STROBOSCOPE)


def add_to(command: argparse.ArgumentParser) -> None:
    """Add what says which runs, and what is kept of each, to the parser of a command."""
    command.add_argument("scenario", metavar="SCENARIO", help="a name of `nonsmooth list scenarios`, or FILE.py:CLASS")
    command.add_argument("--over", action="append", default=[], metavar="NAME=VALUES", help=over.HELP)
    command.add_argument(
        "--sample", metavar="KIND:N", help="draw N runs: random, sobol (N a power of two), latin_hypercube"
    )
    command.add_argument("--seed", type=int, default=0, help="of what is drawn; 0 by default")
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    command.add_argument("--period", type=float, metavar="SECONDS", help="keep where each run is once a period")
    command.add_argument("--within", metavar="NAMES", help="which coordinates and velocities, apart by commas (z,vz)")
    command.add_argument("--keep", type=int, default=32, metavar="N", help="how many periods, the last; 32 by default")
    command.add_argument("--at", type=float, default=0.0, metavar="SECONDS", help="when in each period; 0 by default")
    command.add_argument("--phase", metavar="NAME", help="parameter that is the phase at the start, where it is varied")
    command.add_argument("--budget", type=int, metavar="STEPS", help="give up a run after so many steps")
    command.add_argument("--chunk", type=int, metavar="N", help="store so many runs as one")
    add_executor_to(command)
    add_trust_to(command)
    command.add_argument(
        "--out", required=True, metavar="STUDY.zarr", help="save it there; it goes on if it was cut off"
    )


def add_executor_to(command: argparse.ArgumentParser) -> None:
    """Add what says who does it to the parser of a command."""
    command.add_argument("--executor", default="threads", metavar="|".join(EXECUTORS), help="threads by default")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of dask, as tcp://10.0.0.1:8786; implies dask")


def asked(arguments: argparse.Namespace, record: list[str]) -> dict[str, Any]:
    """Return the words of a request, from which its study can be made again.

    Raises
    ------
    InvalidInput
        If a word contradicts another one, or cannot be one of the store.
    """
    check_chunk(arguments.chunk)
    over.check_not_set(arguments.over, arguments.set)
    return {name: getattr(arguments, name) for name in _ASKED} | {"record": record}


def executor_asked(arguments: argparse.Namespace) -> Executor:
    """Return the executor of a request."""
    return Dask(arguments.scheduler) if arguments.scheduler else executor_of(arguments.executor)


def study_of(words: Mapping[str, Any], *, trust: bool, typed: bool = True) -> Study:
    """Return the study that was asked for in words, which are typed or stored; the stored ones may be trusted.

    Raises
    ------
    InvalidInput
        If it is not valid.
    """
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints
        job = request.job(words["scenario"], words["set"], (), words["engine"], trust=trust, typed=typed)
        sampling = over.sampling(words["over"], words["sample"], words["seed"])
        classes = [name for name in job.scenario.words if name == "attractor"]
        usual = [name for name in (*RECORD, *classes) if name not in sampling.points().columns]
        record: list[Asked] = [*(words["record"] or usual), *_stroboscope(words)]
        return Study(job.scenario, sampling, record, engine=job.engine, budget=words["budget"])


def _stroboscope(words: Mapping[str, Any]) -> list[Stroboscope]:
    if words["period"] is None and words["within"] is None:
        return []
    for name in "period", "within":
        if words[name] is None:
            remedy = "For example --period 0.04 --within z,vz."
            raise InvalidInput(f"--{name}", "must be given, as the other one is", None, remedy)
    within = tuple(word.strip() for word in words["within"].split(","))
    return [Stroboscope(words["period"], within, words["keep"], words["at"], words["phase"])]
