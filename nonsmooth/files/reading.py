"""From a file to a system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, final

from nonsmooth.checks import path_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.files import assembling
from nonsmooth.files.components import TYPE, Table, component
from nonsmooth.files.gate import TRUSTED, Gate
from nonsmooth.files.keys import check_keys, number
from nonsmooth.files.parsing import changed, parse, value
from nonsmooth.files.varying import numbers
from nonsmooth.files.writing import tables_of
from nonsmooth.interfaces import Engine
from nonsmooth.parameters import Rule
from nonsmooth.system.system import System

_NO_CHANGES: Mapping[str, str] = {}
_KEYS = (
    "title",
    "t_end",
    "sample_interval",
    "gravity",
    "engine",
    "laws",
    "bodies",
    "contacts",
    "exclude",
    "materials",
    "joints",
    "loads",
    "guards",
)


@final
@dataclass(frozen=True)
class Setup:
    """What a scenario file says.

    Attributes
    ----------
    path : Path
        The file.
    title : str
        One line that says what it is.
    t_end, sample_interval : float or None
        End time and time between samples [s], as far as the file says them.
    engine : Engine
        What is to run it.
    system : System
        Bodies, contacts, starts.
    changes : mapping of str
        What was changed of the file, by key.
    """

    path: Path
    title: str
    t_end: float | None
    sample_interval: float | None
    engine: Engine
    system: System = field(repr=False)
    changes: Mapping[str, Any]
    _tables: Table
    _gate: Gate

    def build(self) -> System:
        """Return the system anew."""
        return assembling.system(self._tables, self.path, self._gate)

    @property
    def numbers(self) -> Mapping[str, tuple[float, Rule]]:
        """All numbers of the file by dotted key, and what is known of each."""
        return numbers(self._tables, self._gate)

    def varied(self, changes: Mapping[str, Any]) -> Setup:
        """Return the same with some values changed, by dotted key.

        Raises
        ------
        InvalidInput, PluginError
            As :func:`load_system`, or if a key leads nowhere.
        """
        return _setup(self.path, self._tables, {**self.changes, **changes}, self._gate)


def load_system(path: str | Path, *, trust: bool = False) -> Setup:
    """Read a system that :func:`save_system` or a user wrote.

    Parameters
    ----------
    path : str or Path
        The file.
    trust : bool, optional
        Whether the file may name code that is no installed plug-in: classes of Python files, functions and classes of
        any module that can be imported.  They run with the rights of the user.

    Returns
    -------
    Setup
        With ``system``, ``t_end``, ``sample_interval`` and ``engine``, as :func:`simulate` takes them.

    Raises
    ------
    InvalidInput
        If there is no such file, it is no TOML or YAML, or anything in it breaks a rule: file, key, rule, value and
        remedy are named.
    PluginError
        If a class that it names cannot be loaded.
    """
    return read(path_of("load_system: path", path), trust)


def read(path: Path, trust: bool, changes: Mapping[str, str] = _NO_CHANGES) -> Setup:
    """Return what a file says, with some of its values changed, by dotted key ("bodies.ball.radius"), as TOML text.

    Raises
    ------
    InvalidInput, PluginError
        As :func:`load_system`, or if a key to be changed leads nowhere.
    """
    gate = Gate(path.parent, trust)
    return _setup(path, parse(path), {key: value(text) for key, text in changes.items()}, gate)


def setup_of(system: System, t_end: float) -> Setup:
    """Return what a file of a system would say that runs for so long [s].

    Raises
    ------
    InvalidInput
        If a component cannot be written; it is named.
    """
    return _setup(Path("system"), tables_of(system, t_end=t_end), {}, TRUSTED)


def _setup(path: Path, said: Table, changes: Mapping[str, Any], gate: Gate) -> Setup:
    tables = changed(said, changes, path)
    check_keys(f"{path}", tables, _KEYS, required=("bodies",))
    title = tables.get("title", "")
    if not isinstance(title, str):
        raise InvalidInput(f"{path}: title", "must be a text", title, "Put it in quotation marks.")
    t_end, interval = (
        number(f"{path}: {key}", tables[key], "s", positive=True) if key in tables else None
        for key in ("t_end", "sample_interval")
    )
    engine = engine_of(f"{path}: engine", tables.get("engine", {}), gate)
    made = assembling.system(tables, path, gate)
    return Setup(path, title, t_end, interval, engine, made, dict(changes), tables, gate)


def engine_of(thing: str, table: Any, gate: Gate) -> Engine:
    """Return the engine of a table, the event-driven one where it says none; errors as :func:`load_system`."""
    is_default = isinstance(table, dict) and TYPE not in table
    made: Engine = component(thing, table, EventDriven if is_default else Engine, gate)
    return made
