"""The study and the executor of a request, and the options that describe them."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Mapping
from typing import Any

from nonsmooth.cli.parse import values
from nonsmooth.cli.parse.options import Option, names
from nonsmooth.cli.parse.request import ENGINE, SCENARIO, SET, TRUST, job
from nonsmooth.errors import InvalidInput
from nonsmooth.studies import Dask, Stroboscope, Study, grid, random
from nonsmooth.studies.executors import Executor
from nonsmooth.studies.records import Requested
from nonsmooth.studies.study import EXECUTORS, check_chunk, executor_of

RECORD = ("t_end", "impacts", "events", "steps", "energy_residual")
"""Records of a study by default; a scenario that classifies its runs adds the record "attractor"."""
STROBOSCOPE = (
    Option.of(Stroboscope, "period", metavar="SECONDS"),
    Option.of(Stroboscope, "within", form="NAME,NAME,...", metavar="NAMES"),
    Option.of(Stroboscope, "keep"),
    Option.of(Stroboscope, "at", metavar="SECONDS"),
    Option.of(Stroboscope, "phase"),
)
EXECUTOR = (
    Option.of(Study.run, "executor", metavar="|".join(EXECUTORS)),
    Option.of(Dask, "scheduler", form="it implies dask", metavar="ADDRESS"),
)
OUT = Option.of(Study.run, "path", name="out", metavar="STUDY.zarr", is_required=True)
_DRAWN = (
    Option.of(grid, "axes", name="over", form=values.OVER, metavar="NAME=VALUES", repeats=True),
    Option.of(random, "n", name="sample", form="KIND:N with KIND random, sobol or latin_hypercube", metavar="KIND:N"),
    Option.of(random, "seed"),
)
_BUDGET = Option.of(Study, "budget", metavar="STEPS")
OPTIONS = (SCENARIO, *_DRAWN, SET, ENGINE, *STROBOSCOPE, _BUDGET, Option.of(Study.run, "chunk"), *EXECUTOR, TRUST, OUT)
"""Options of all commands that run a study."""
RECORD_OPTION = Option.of(
    Study,
    "record",
    form=f"NAME,NAME,...; {','.join(RECORD)} by default, with the attractor if the scenario has one",
    metavar="NAME",
    repeats=True,
)
"""Option of ``sweep`` that names the records; ``basin`` takes them from ``--features``."""
STUDY_WORDS = (SCENARIO, *_DRAWN, SET, ENGINE, *STROBOSCOPE, _BUDGET, RECORD_OPTION)
"""Options whose values are stored with a study, so that it can be made again."""


def words_of(arguments: argparse.Namespace, record: list[str]) -> dict[str, Any]:
    """Return {option: value} of all options that define the study; with them the study can be made again.

    Raises
    ------
    InvalidInput
        If a parameter is given by both ``--over`` and ``--set``, or the size of chunks is wrong.
    """
    check_chunk(arguments.chunk)
    values.check_not_set(arguments.over, arguments.set)
    return {one.place: getattr(arguments, one.place, None) for one in STUDY_WORDS} | {"record": record}


def executor_given(arguments: argparse.Namespace) -> Executor:
    """Return the executor of a request."""
    return Dask(arguments.scheduler) if arguments.scheduler else executor_of(arguments.executor)


def study_of(words: Mapping[str, Any], *, trust: bool, typed: bool = True) -> Study:
    """Return the study that the values of the options define.

    ``typed`` is True for values from the command line, False for values stored with a study. Stored values may name
    code that is not installed only if ``trust`` is True.

    Raises
    ------
    InvalidInput
        If a value of the request is wrong or missing.
    """
    with contextlib.redirect_stdout(sys.stderr):  # a plug-in may print, but standard output is for the result
        made = job(words["scenario"], words["set"], (), words["engine"], trust=trust, typed=typed)
        sampling = values.sampling(words["over"], words["sample"], words["seed"])
        classes = [name for name in made.scenario.words if name == "attractor"]
        usual = [name for name in (*RECORD, *classes) if name not in sampling.columns]
        record: list[Requested] = [*(words["record"] or usual), *_stroboscope(words)]
        return Study(made.scenario, sampling, record, engine=made.engine, budget=words["budget"])


def _stroboscope(words: Mapping[str, Any]) -> list[Stroboscope]:
    if words["period"] is None and words["within"] is None:
        return []
    for name in "period", "within":
        if words[name] is None:
            remedy = "For example --period 0.04 --within z,vz."
            raise InvalidInput(f"--{name}", "must be given, as the other one is", None, remedy)
    return [Stroboscope(words["period"], names(words["within"]), words["keep"], words["at"], words["phase"])]
