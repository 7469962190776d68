"""The run that ``view`` and ``export`` show: read from a folder of results, or computed from a scenario."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import final

from nonsmooth.cli.execute.perform import Compute, Progress, computed
from nonsmooth.cli.parse.options import Option
from nonsmooth.cli.parse.request import ENGINE, LAW, RUN_WORDS, SET, TRUST, Job, check_stored, job
from nonsmooth.cli.report.messages import tell
from nonsmooth.errors import InvalidInput, UnknownRun
from nonsmooth.files.scenario import FileScenario
from nonsmooth.plugins import file, registry
from nonsmooth.results.opening import open_solution, stored_setup
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution

OPTIONS = (
    Option("run", "a folder that `run --out` was given, or a scenario as for `run`", metavar="RESULT|SCENARIO"),
    SET,
    LAW,
    ENGINE,
    TRUST,
)
"""Options of ``view`` and ``export`` that name a stored run, or a scenario to run."""


@final
@dataclass(frozen=True, eq=False)
class Obtained:
    """A run to show or to write.

    Attributes
    ----------
    title : str
        Title of the run.
    solution : Solution or None
        Results up to the time reached; None if there are none.
    is_complete : bool
        True if the run was read from a folder, or was computed to its end.
    """

    title: str
    solution: Solution | None
    is_complete: bool


def obtain(command: str, arguments: argparse.Namespace) -> Obtained:
    """Return the run of a request: read from its folder, or computed from its scenario.

    Raises
    ------
    UnknownRun
        If there is no folder and no scenario of this name.
    """
    _check_known(arguments.run)
    return _stored(command, arguments) if Path(arguments.run).is_dir() else _computed(arguments)


def _check_known(word: str) -> None:
    """Raise UnknownRun unless the user's word for a run is a path or the name of an installed component.

    A word is a path if the file or folder exists, or if it ends like a file name (".py").
    """
    is_path = Path(word).exists() or Path(word).suffix
    # a component of another kind gets a message that names its kind
    if not is_path and word not in registry.names("scenarios") and not registry.kinds_named(word):
        raise UnknownRun(word, registry.names("scenarios"))


def job_of(output: Output, folder: SolutionFolder, is_trusted: bool) -> tuple[str, Job]:
    """Return the scenario's name and the job of a stored run, from its stored request or from its stored system.

    Unless the user trusts the folder, the stored request may name installed plug-ins only. If it names other code, the
    job comes from the stored system.
    """
    words = folder.said("request")
    name = str(words.get("scenario", output.folder))
    if words:
        check_stored(f"{output.solution}", words, RUN_WORDS)
    named = [("laws", str(word).partition("=")[2]) for word in words.get("law", ())]
    named += [("engines", str(words["engine"]))] if words.get("engine") else []
    code = [first for group, word in named if (first := word.partition(",")[0].strip()) not in registry.names(group)]
    code += [name] if file.is_file(name) else []
    if (name in registry.names("scenarios") or file.is_file(name)) and (is_trusted or not code):
        return name, job(name, words["set"], words["law"], words.get("engine"), trust=is_trusted, typed=False)
    if code:
        tell(f"without {', '.join(map(repr, code))}, and so without what only they can say: see --trust")
    setup = stored_setup(output, folder, is_trusted)
    return name, Job(FileScenario(setup), setup.engine, {})


def computation(made: Job, output: Output | None = None) -> Compute:
    """Return the function that runs a job and writes to an output folder, if given. This call builds the system."""
    scenario, system = made.scenario, made.build()

    def compute(progress: Progress) -> Solution:
        model = assemble(system, made.engine)
        return model.run(
            scenario.t_end,
            sample_interval=scenario.sample_interval,
            progress=lambda t, t_end: progress(t, t_end, model.n_events),
            output=output,
        )

    return compute


def _stored(command: str, arguments: argparse.Namespace) -> Obtained:
    if arguments.set or arguments.law or arguments.engine:
        rule = "takes --set, --law and --engine for a scenario only"
        raise InvalidInput(command, rule, arguments.run, "Leave them out.")
    output = Output(Path(arguments.run))
    folder = SolutionFolder.opened(output)
    name, made = job_of(output, folder, arguments.trust)
    solution = open_solution(output, system=made.build(), trust=arguments.trust)
    return Obtained(str(folder.attributes.get("title") or name), solution, True)


def _computed(arguments: argparse.Namespace) -> Obtained:
    made = job(arguments.run, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    solution, status, _ = computed(computation(made))
    return Obtained(made.title, solution, status == "done")
