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
from nonsmooth.interfaces import Engine, Measure, Scales
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
    """Placeholder for an engine that is not installed: samples and events are known, but the run cannot continue.

    Attributes
    ----------
    described : dict
        Class and options of the engine, as the folder stores them.
    recorded_contacts : bool
        True if the events hold modes and impulses.
    """

    described: Mapping[str, Any] = field(hash=False)
    recorded_contacts: bool

    @property
    def records_contacts(self) -> bool:
        """True if the engine that ran recorded contacts."""
        return self.recorded_contacts

    def check(self, system: System) -> None:
        """Accept any system, because this engine never runs."""

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """No counts, because this engine never runs."""
        return {}

    def settings(self, scales: Scales) -> Mapping[str, float]:
        """No settings, because this engine never runs."""
        return {}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> NoReturn:
        """Raise InvalidInput, because the run can continue only with the engine that began it."""
        raise InvalidInput("engine", "must be there to go on", dict(self.described), "Give the one that ran.")


_NONE: dict[str, Any] = {"limits": {}}
"""Default values of those :class:`Counters` that are not numbers, for an unfinished run; all other defaults are 0.

``limits``, the number of steps by the reason that limited their length, is empty.
"""


def open_solution(
    output: Output | Path | str,
    *,
    system: System | None = None,
    engine: Engine | None = None,
    trust: bool = False,
) -> Solution:
    """Open the solution in a folder of results, of a finished or an unfinished run.

    Parameters
    ----------
    output : Output, Path or str
        The folder.
    system : System, optional
        System that ran; by default it is built from the scenario file in the folder.  That file is missing if a class
        of the system is not installed, such as a law of a script.
    engine : Engine, optional
        Engine that ran; by default the engine that the folder names.  If that is not installed, the run is known at its
        samples and events only.
    trust : bool, optional
        True if the folder may name code other than installed plug-ins, as for :func:`nonsmooth.load_system`.

    Returns
    -------
    Solution
        Its status is "unfinished" if the run is under way or was cut off.

    Raises
    ------
    InvalidInput
        The folder has no solution, or it has no scenario file and `system` was not given.
    PluginError
        A class that the system needs cannot be loaded.
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
    """Setup of a run, built from the scenario file in its folder of results.

    Raises
    ------
    InvalidInput
        The folder has no scenario file, or the file names code and is not trusted.
    PluginError
        A class that the file names cannot be loaded.
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
    """Engine that ran. If the folder names a class of Python code that is not installed, the result is a placeholder.

    The placeholder (:class:`Unavailable`) loads no code and cannot continue the run.
    """
    table = folder.said("engine")
    recorded = bool(folder.attributes.get("records_contacts", 0))
    return Unavailable(table, recorded) if named_elsewhere(table) else stored_engine(output, folder, trust)


def stored_engine(output: Output, folder: SolutionFolder, trust: bool) -> Engine:
    """Engine that ran, built from its table in the folder.

    Raises
    ------
    InvalidInput
        The folder does not describe the engine, or names code that is not trusted.
    PluginError
        The class of the engine cannot be loaded.
    """
    thing, table = f"{output.solution}: engine", folder.said("engine")
    if named_elsewhere(table):
        raise InvalidInput(thing, "must be one that is installed", table, "Give it as engine=...")
    return engine_of(thing, table, Gate(output.folder, trust))
