"""From the words of a request to what is to be run."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import engine, law
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.files.gate import Gate
from nonsmooth.files.reading import read
from nonsmooth.files.scenario import FileScenario
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.parameters import from_all_words, rules
from nonsmooth.plugins import file, registry
from nonsmooth.system.replacing import with_laws
from nonsmooth.system.system import System


def assignments(words: Iterable[str]) -> dict[str, str]:
    """Cut ``name=value`` words.

    Raises
    ------
    InvalidInput
        If a word has another form, or a name comes twice.
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


@dataclass(frozen=True)
class Job:
    """What a request asks to run.

    Attributes
    ----------
    scenario : Scenario
        The scenario.
    engine : Engine
        What runs it.
    laws : dict
        Laws by role that replace those of the scenario.
    """

    scenario: Scenario
    engine: Engine
    laws: dict[str, Any]

    def build(self) -> System:
        """Return the system, with the laws that were asked for."""
        system = self.scenario.build()
        return with_laws(system, **self.laws) if self.laws else system

    def head(self) -> dict[str, Any]:
        """Return parameters, laws and engine for the report, without the parameters of laws that are replaced."""
        declared = rules(type(self.scenario))
        resolved = {
            name: value
            for name, value in self.scenario.resolved().items()
            if name not in declared or declared[name][1].law not in law.replacements(self.laws)
        }
        laws = {role: law.described(made) for role, made in self.laws.items()}
        return {"parameters": resolved, "laws": laws, "engine": engine.described(self.engine)}


def job(
    name: str,
    words: Iterable[str],
    laws: Iterable[str] = (),
    asked: str | None = None,
    *,
    trust: bool,
    typed: bool = True,
) -> Job:
    """Return what is to be run, with parameters and laws set: a scenario by its name, of a Python file, or a file.

    ``asked`` is the word for another engine than the event-driven one or that of the file.  What the user has typed may
    name Python files; what a file says, and words that are not typed but stored, only if they are trusted.

    Raises
    ------
    InvalidInput
        If a name or a value is wrong, or a value is missing.
    PluginError
        If the scenario or a law cannot be loaded.
    """
    values = assignments(words)
    gate = Gate(trusted=typed or trust)
    replaced = law.laws(laws, gate)
    other = None if asked is None else engine.engine(asked, gate)
    if file.is_file(name) or name.endswith(".py"):
        if not gate.trusted:
            gate.component("scenario", "scenarios", Scenario, name)
        owner = file.load("scenario", (Scenario,), name)
    # what looks like a file is one, of a known format or not
    elif Path(name).suffix and name not in registry.names("scenarios"):
        setup = read(Path(name), trust, values)
        return Job(FileScenario(setup), other or setup.engine, replaced)
    else:
        owner = registry.load("scenarios", name)
    law.check_not_ignored(owner, values, replaced)
    made: Scenario = from_all_words(owner, values, name, "--set {name}=VALUE")
    return Job(made, other or EventDriven(), replaced)
