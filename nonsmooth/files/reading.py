"""Reading of scenario files: a file becomes a system, with its engine and times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, final

from nonsmooth.checks import path_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.files import assembling
from nonsmooth.files.components import TYPE, TomlTable, component, group_of, hints_of
from nonsmooth.files.gate import TRUSTED, Gate
from nonsmooth.files.parsing import changed, check_keys, number, parse, value
from nonsmooth.files.writing import tables_of
from nonsmooth.interfaces import Engine
from nonsmooth.parameters import Component, Rule, rules
from nonsmooth.plugins import registry
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
    """Content of a scenario file.

    Attributes
    ----------
    path : Path
        The file.
    title : str
        Title, one line.
    t_end, sample_interval : float or None
        End time and time between samples [s], None if the file does not give them.
    engine : Engine
        Engine for the run.
    system : System
        The system, with its starts.
    changes : mapping of str
        Values that were changed after the file was read, by dotted key.
    """

    path: Path
    title: str
    t_end: float | None
    sample_interval: float | None
    engine: Engine
    system: System = field(repr=False)
    changes: Mapping[str, Any]
    _tables: TomlTable
    _gate: Gate

    def build(self) -> System:
        """Build the system of the file anew."""
        return assembling.system(self._tables, self.path, self._gate)

    @property
    def numbers(self) -> Mapping[str, tuple[float, Rule]]:
        """All numbers of the file by dotted key ("bodies.ball.radius"), each with its rule (unit and allowed range)."""
        return numbers(self._tables, self._gate)

    def varied(self, changes: Mapping[str, Any]) -> Setup:
        """Setup of the same file with some values changed, by dotted key.

        Raises
        ------
        InvalidInput, PluginError
            As of :func:`load_system`.  Also: a key leads to a table or an element that does not exist.
        """
        return _setup(self.path, self._tables, {**self.changes, **changes}, self._gate)


def load_system(path: str | Path, *, trust: bool = False) -> Setup:
    """Read a system that :func:`save_system` or a user wrote.

    Parameters
    ----------
    path : str or Path
        The file.
    trust : bool, optional
        True if the file may name code other than installed plug-ins: classes of Python files, functions and classes of
        any module that can be imported.  They run with the rights of the user.

    Returns
    -------
    Setup
        With ``system``, ``t_end``, ``sample_interval`` and ``engine``, as :func:`simulate` takes them.

    Raises
    ------
    InvalidInput
        The file does not exist, is not TOML or YAML, or breaks a rule.  The message names file, key, rule, value and
        remedy.
    PluginError
        A class that the file names cannot be loaded.
    """
    return read(path_of("load_system: path", path), trust)


def read(path: Path, trust: bool, changes: Mapping[str, str] = _NO_CHANGES) -> Setup:
    """Setup of a file with some of its values changed, by dotted key ("bodies.ball.radius"); new values are TOML text.

    Raises
    ------
    InvalidInput, PluginError
        As of :func:`load_system`.  Also: a key leads to a table or an element that does not exist.
    """
    gate = Gate(path.parent, trust)
    return _setup(path, parse(path), {key: value(text) for key, text in changes.items()}, gate)


def setup_of(system: System, t_end: float) -> Setup:
    """Setup of a system that runs until an end time [s], as if it was read from a file.

    Raises
    ------
    InvalidInput
        A component cannot be written to a file; the message names it.
    """
    return _setup(Path("system"), tables_of(system, t_end=t_end), {}, TRUSTED)


def _setup(path: Path, said: TomlTable, changes: Mapping[str, Any], gate: Gate) -> Setup:
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
    """Engine from a table, the event-driven engine if the table names no class; errors as of :func:`load_system`."""
    is_default = isinstance(table, dict) and TYPE not in table
    made: Engine = component(thing, table, EventDriven if is_default else Engine, gate)
    return made


_GROUPS = {"contacts": "laws", "materials": "laws", "engine": "engines"}
"""Section of a file -> group of its installed names. All other sections have the name of their group."""
_UNITS = {"t_end": "s", "sample_interval": "s", "gravity": "m/s^2"}
_UNKNOWN = "SI"
"""Unit of a number that is not a parameter of a class, such as a number of a start."""


def numbers(tables: TomlTable, gate: Gate) -> dict[str, tuple[float, Rule]]:
    """All numbers in tables by dotted key ("bodies.ball.radius"), each with its rule (unit and allowed range).

    Elements of arrays count from 0. ``gate`` decides which classes the tables may name.
    """
    return dict(_numbers(tables, (), None, gate))


def _numbers(
    place: Any, way: tuple[str, ...], rule: Rule | None, gate: Gate, group: str = ""
) -> Iterator[tuple[str, tuple[float, Rule]]]:
    """Numbers in a table, list or value and everything below it: dotted key, number, rule (unit and allowed range).

    Parameters
    ----------
    place : object
        The table, list or value.
    way : tuple of str
        Keys from the top of the file to `place`.
    rule : Rule or None
        Rule of the numbers in `place` if it is the value of a parameter, else None.
    gate : Gate
        Decides which classes the tables may name.
    group : str
        Group of installed names ("laws") of the components in `place`; "" if `place` has no components.
    """
    if isinstance(place, dict):
        owner = _class(place, group, gate)
        declared: Mapping[str, Any] = {} if owner is None else rules(owner)
        hints: Mapping[str, Any] = {} if owner is None else hints_of(owner)
        for name, one in place.items():
            section = group if way else _GROUPS.get(str(name), str(name))
            inner = section if owner is None else group_of(hints.get(name))
            known = declared[name][1] if name in declared else None
            yield from _numbers(one, (*way, name), known, gate, inner)
    elif isinstance(place, list):
        for i, one in enumerate(place):
            yield from _numbers(one, (*way, str(i)), rule, gate, group)
    elif isinstance(place, (int, float)) and not isinstance(place, bool):
        key = ".".join(way)
        yield key, (place, rule or Rule(key, _UNITS.get(way[0], _UNKNOWN)))


def _class(table: TomlTable, group: str, gate: Gate) -> Any:
    """Class of the component that a table describes; None if the table does not describe a component."""
    word = table.get(TYPE)
    if group not in registry.GROUPS or not isinstance(word, str):
        return None
    return gate.component(TYPE, group, Component, word)
