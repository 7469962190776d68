"""Scenario, laws and engine that a user requests on the command line, or that a folder's stored request names.

The command-line options for scenario, laws and engine are also defined here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nonsmooth.cli.parse import components
from nonsmooth.cli.parse.options import Option, flag
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.files.gate import Gate
from nonsmooth.files.reading import read
from nonsmooth.files.scenario import FileScenario
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.parameters import from_all_words, rules
from nonsmooth.plugins import file, registry
from nonsmooth.runs.simulate import simulate
from nonsmooth.system.replacing import with_laws
from nonsmooth.system.system import System

SCENARIO = Option(
    "scenario", "a name of `nonsmooth list scenarios`, a FILE.toml or FILE.yaml, or FILE.py:CLASS", metavar="SCENARIO"
)
SET = Option(
    "--set", "a parameter of `nonsmooth show SCENARIO`, in SI units; may come often", metavar="NAME=VALUE", repeats=True
)
LAW = Option(
    "--law",
    "a law for all contacts: ROLE=LAW or ROLE=LAW,NAME=VALUE,...; ROLE is normal, friction or impact, "
    "LAW a name of `nonsmooth list laws` or FILE.py:CLASS; may come once a role",
    metavar="ROLE=LAW",
    repeats=True,
)
ENGINE = Option.of(
    simulate,
    "engine",
    form="ENGINE or ENGINE,NAME=VALUE,...; ENGINE is a name of `nonsmooth list engines` or FILE.py:CLASS, NAME an "
    "option of `nonsmooth show ENGINE`",
    metavar="ENGINE",
)
TRUST = flag(
    "--trust",
    "load the Python files and functions that the file or folder names; without it only names of installed plug-ins "
    "are allowed, so that no code of another person's file runs",
)
JSON = flag("--json", "print one JSON object and nothing else")

RUN_WORDS = (SCENARIO, SET, LAW, ENGINE)
"""Options whose values are stored with a run, so that a later command, such as ``resume``, can rebuild the run."""


@dataclass(frozen=True)
class Job:
    """A scenario to run, with its engine and replaced laws.

    Attributes
    ----------
    scenario : Scenario
        The scenario.
    engine : Engine
        Engine that runs the scenario.
    laws : dict
        Laws, by role, that replace the laws of the scenario.
    """

    scenario: Scenario
    engine: Engine
    laws: dict[str, Any]

    @property
    def title(self) -> str:
        """Title of the scenario, or of its file."""
        return str(self.scenario.resolved().get("title", type(self.scenario).title))

    def build(self) -> System:
        """Return the system of the scenario, with the replaced laws."""
        system = self.scenario.build()
        return with_laws(system, **self.laws) if self.laws else system

    def head(self) -> dict[str, Any]:
        """Return parameters, laws and engine for the report, without the parameters of laws that are replaced."""
        declared, replaced = rules(type(self.scenario)), components.replacements(self.laws)
        resolved = {
            name: value
            for name, value in self.scenario.resolved().items()
            if name not in declared or declared[name][1].law not in replaced
        }
        laws = {role: components.described("law", made) for role, made in self.laws.items()}
        return {"parameters": resolved, "laws": laws, "engine": components.described("engine", self.engine)}


def job(
    name: str,
    words: Iterable[str],
    laws: Iterable[str] = (),
    engine: str | None = None,
    *,
    trust: bool,
    typed: bool = True,
) -> Job:
    """Return the job of a scenario, which is given by an installed name, a Python file or a scenario file.

    A request that the user types may name Python files.  A scenario file or a stored request may do so only if the user
    trusts it.

    Parameters
    ----------
    name : str
        Installed name, FILE.py:CLASS, or path of a scenario file.
    words, laws : iterable of str
        Values of ``--set`` and ``--law``.
    engine : str, optional
        Value of ``--engine``; by default the engine of the scenario file, or the event-driven engine.
    trust, typed : bool
        Whether the user trusts the file or folder, and whether the request is typed instead of stored.

    Raises
    ------
    InvalidInput
        If a name or a value is wrong, or a required value is missing.
    PluginError
        If the scenario or a law cannot be loaded.
    """
    values = assignments(words)
    gate = Gate(trusted=typed or trust)
    replaced = components.laws(laws, gate)
    other = None if engine is None else components.engine(engine, gate)
    if file.is_file(name) or name.endswith(".py"):
        if not gate.trusted:
            gate.component("scenario", "scenarios", Scenario, name)
        owner = file.load("scenario", (Scenario,), name)
    # a name with a suffix is a scenario file, even if its format is unknown
    elif Path(name).suffix and name not in registry.names("scenarios"):
        setup = read(Path(name), trust, values)
        return Job(FileScenario(setup), other or setup.engine, replaced)
    else:
        owner = registry.load("scenarios", name)
    components.check_not_ignored(owner, values, replaced)
    made: Scenario = from_all_words(owner, values, name, "--set {name}=VALUE")
    return Job(made, other or EventDriven(), replaced)


def assignments(words: Iterable[str]) -> dict[str, str]:
    """Return values by name from the values ``name=value`` of ``--set``.

    Raises
    ------
    InvalidInput
        If a value is malformed, or a name is given twice.
    """
    values: dict[str, str] = {}
    for word in words:
        name, equals, value = (part.strip() for part in word.partition("="))
        if not (name and equals and value):
            raise InvalidInput("--set", "must have the form name=value", word, "For example --set t_end=2.")
        if name in values:
            raise InvalidInput(f"--set {name}", "must come once", f"{values[name]} and {value}", "Leave one out.")
        values[name] = value
    return values


def check_stored(thing: str, words: Any, options: Iterable[Option]) -> None:
    """Raise InvalidInput if a stored request is damaged: a value of the options is missing or has a wrong type."""
    if not isinstance(words, dict):
        raise InvalidInput(f"{thing}: request", "must be a table", words, "It is damaged.")
    for option in options:
        value = words.get(option.place)
        fits = isinstance(value, option.stored_kinds) and not isinstance(value, bool)
        if not fits or (isinstance(value, list) and not all(isinstance(one, str) for one in value)):
            thing = f"{thing}: request: {option.place}"
            raise InvalidInput(thing, "must be as a command has written it", value, "It is damaged.")
