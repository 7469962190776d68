"""Opening of a folder of results: the solution, its system and its engine."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files.gate import Gate
from nonsmooth.files.reading import Setup, engine_of, load_system
from nonsmooth.interfaces import Engine, Measure
from nonsmooth.results.description import named_elsewhere
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder, naming_damage
from nonsmooth.solution.end import Counters, End
from nonsmooth.solution.recorded import Recorded
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from nonsmooth.engine.memory.memory import Memory


@final
@dataclass(frozen=True)
class Unavailable(Engine):
    """Takes the place of an engine that is not installed: samples and events are known, the run cannot continue.

    Attributes
    ----------
    described : dict
        Class and options of the engine, as the folder has them.
    recorded_contacts : bool
        True if the events hold modes and impulses.
    """

    described: Mapping[str, Any] = field(hash=False)
    recorded_contacts: bool

    @property
    def records_contacts(self) -> bool:
        """As the engine that ran."""
        return self.recorded_contacts

    def check(self, system: System) -> None:
        """Accept any system, because nothing runs."""

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """None, because nothing runs."""
        return {}

    def settings(self, time_scale: float) -> Mapping[str, float]:
        """None, because nothing runs."""
        return {}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> NoReturn:
        """Raise InvalidInput, because a run needs its engine."""
        raise InvalidInput("engine", "must be there to go on", dict(self.described), "Give the one that ran.")


_NONE: dict[str, Any] = {"limits": {}}
"""Counters of a run that is unfinished, where 0 is none."""


def open_solution(
    output: Output | Path | str,
    *,
    system: System | None = None,
    engine: Engine | None = None,
    trust: bool = False,
) -> Solution:
    """Solution in a folder of results, also one that is unfinished.

    Parameters
    ----------
    output : Output, Path or str
        The folder.
    system : System, optional
        What ran; by default it is built from what the folder says of it.  A class that is not installed, such as a law
        of a script, is beyond what a folder can say.
    engine : Engine, optional
        What integrated it; by default that which the folder names.  Where that is not installed, the run is known at
        its samples and events only.
    trust : bool, optional
        Whether the folder may name code that is no installed plug-in, as for :func:`nonsmooth.load_system`.

    Returns
    -------
    Solution
        Its status is "unfinished" where the run goes on or was cut off.

    Raises
    ------
    InvalidInput
        If there is no solution, or it cannot say how its system is built.
    PluginError
        If a class that the system needs cannot be loaded.
    """
    where = Output.to(output)
    folder = SolutionFolder.opened(where)
    said = folder.said("counters") if "counters" in folder.attributes else {}
    counters = {field.name: said.get(field.name, _NONE.get(field.name, 0)) for field in fields(Counters)}
    message, cause = str(folder.attributes.get("message")), str(folder.attributes.get("cause", ""))
    measures = folder.said("verdict", list) if "verdict" in folder.attributes else []
    with naming_damage(f"{where.solution}: verdict"):
        verdict = {Measure(one["name"], one["unit"], one["meaning"]): float(one["value"]) for one in measures}
    end = End(folder.state(), Counters(**counters), folder.status, message, cause, verdict)
    made = system or stored_setup(where, folder, trust).system
    recorded = Recorded.of(folder.events(), folder.rows(), engine or _engine_or_its_name(where, folder, trust))
    return Solution(made, recorded, end)


def stored_setup(output: Output, folder: SolutionFolder, trust: bool) -> Setup:
    """System of a folder of results, built from what it says of it.

    Raises
    ------
    InvalidInput
        If it does not say it, or names code and is not trusted.
    PluginError
        If a class that it names cannot be loaded.
    """
    text = folder.system_text()
    if not text:
        raise InvalidInput(
            f"{output.folder}: the system that ran",
            "must be given",
            None,
            f"The folder cannot tell it: {folder.attributes.get('system_missing')}. A script that builds it opens the "
            f"run by nonsmooth.open_solution({str(output.folder)!r}, system=system), and goes on with one that was cut "
            "off by nonsmooth.resume, likewise.",
        )
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "system.toml"
        path.write_text(text, encoding="utf-8")
        return load_system(path, trust=trust)


def _engine_or_its_name(output: Output, folder: SolutionFolder, trust: bool) -> Engine:
    table = folder.said("engine")
    recorded = bool(folder.attributes.get("records_contacts", 0))
    return Unavailable(table, recorded) if named_elsewhere(table) else stored_engine(output, folder, trust)


def stored_engine(output: Output, folder: SolutionFolder, trust: bool) -> Engine:
    """Engine that ran, as the folder says it.

    Raises
    ------
    InvalidInput
        If it does not say it, or names code and is not trusted.
    PluginError
        If its class cannot be loaded.
    """
    thing, table = f"{output.solution}: engine", folder.said("engine")
    if named_elsewhere(table):
        raise InvalidInput(thing, "must be one that is installed", table, "Give it as engine=...")
    return engine_of(thing, table, Gate(output.folder, trust))
