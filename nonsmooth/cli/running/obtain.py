"""The run that a command is about: one that is stored, or one that is computed first."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import final

from nonsmooth.cli.asking import engine, law, request, stored, trust
from nonsmooth.cli.running.perform import computed
from nonsmooth.cli.telling.messages import tell
from nonsmooth.errors import InvalidInput
from nonsmooth.files.scenario import FileScenario
from nonsmooth.interfaces import Scenario
from nonsmooth.plugins import file, registry
from nonsmooth.results.opening import open_solution, stored_setup
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution


@final
@dataclass(frozen=True, eq=False)
class Obtained:
    """A run.

    Attributes
    ----------
    title : str
        Its title.
    solution : Solution or None
        As far as there is one.
    whole : bool
        Whether it was stored, or came to its end.
    """

    title: str
    solution: Solution | None
    whole: bool


def add_to(command: argparse.ArgumentParser) -> None:
    """Add the words that say which run it is."""
    command.add_argument(
        "run", metavar="RESULT|SCENARIO", help="a folder that `run --out` was given, or a scenario as for `run`"
    )
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    command.add_argument("--law", action="append", default=[], metavar="ROLE=LAW", help=law.HELP)
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    trust.add_to(command)


def obtain(command: str, arguments: argparse.Namespace) -> Obtained:
    """Return the run that the words of a command ask for."""
    return _stored(command, arguments) if Path(arguments.run).is_dir() else _computed(arguments)


def title_of(scenario: Scenario) -> str:
    """Return the title of a scenario, or of the file that it comes from."""
    return str(scenario.resolved().get("title", type(scenario).title))


def job_of(output: Output, folder: SolutionFolder, is_trusted: bool) -> tuple[str, request.Job]:
    """Return what ran: a scenario by its name, all else by what the folder says of its system.

    Nothing but installed plug-ins is loaded because the folder names it, unless the user trusts it.
    """
    asked = folder.said("request")
    name = str(asked.get("scenario", output.folder))
    if asked:
        stored.check(f"{output.solution}", asked, stored.RUN)
    words = [("laws", str(word).partition("=")[2]) for word in asked.get("law", ())]
    words += [("engines", str(asked["engine"]))] if asked.get("engine") else []
    code = [first for group, word in words if (first := word.partition(",")[0].strip()) not in registry.names(group)]
    code += [name] if file.is_file(name) else []
    if (name in registry.names("scenarios") or file.is_file(name)) and (is_trusted or not code):
        again = request.job(name, asked["set"], asked["law"], asked.get("engine"), trust=is_trusted, typed=False)
        return name, again
    if code:
        tell(f"without {', '.join(map(repr, code))}, and so without what only they can say: see --trust")
    setup = stored_setup(output, folder, is_trusted)
    return name, request.Job(FileScenario(setup), setup.engine, {})


def _stored(command: str, arguments: argparse.Namespace) -> Obtained:
    if arguments.set or arguments.law or arguments.engine:
        raise InvalidInput(
            command, "takes --set, --law and --engine for a scenario only", arguments.run, "Leave them out."
        )
    output = Output(Path(arguments.run))
    folder = SolutionFolder.opened(output)
    name, job = job_of(output, folder, arguments.trust)
    solution = open_solution(output, system=job.build(), trust=arguments.trust)
    return Obtained(str(folder.attributes.get("title") or name), solution, True)


def _computed(arguments: argparse.Namespace) -> Obtained:
    job = request.job(arguments.run, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    model, scenario = assemble(job.build(), job.engine), job.scenario
    solution, status, _ = computed(
        lambda told: model.run(
            scenario.t_end,
            sample_interval=scenario.sample_interval,
            progress=lambda t, t_end: told(t, t_end, model.n_events),
        )
    )
    return Obtained(title_of(scenario), solution, status == "done")
