"""From a file to a system."""

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
    _tables: TomlTable
    _gate: Gate

    def build(self) -> System:
        """The system, built anew."""
        return assembling.system(self._tables, self.path, self._gate)

    @property
    def numbers(self) -> Mapping[str, tuple[float, Rule]]:
        """All numbers of the file by dotted key, and what is known of each."""
        return numbers(self._tables, self._gate)

    def varied(self, changes: Mapping[str, Any]) -> Setup:
        """The same with some values changed, by dotted key.

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
    """TOML text of a file with some of its values changed, by dotted key ("bodies.ball.radius").

    Raises
    ------
    InvalidInput, PluginError
        As :func:`load_system`, or if a key to be changed leads nowhere.
    """
    gate = Gate(path.parent, trust)
    return _setup(path, parse(path), {key: value(text) for key, text in changes.items()}, gate)


def setup_of(system: System, t_end: float) -> Setup:
    """TOML text of a system that runs until an end time [s].

    Raises
    ------
    InvalidInput
        If a component cannot be written; it is named.
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
    """Engine of a table, the event-driven one where it says none; errors as :func:`load_system`."""
    is_default = isinstance(table, dict) and TYPE not in table
    made: Engine = component(thing, table, EventDriven if is_default else Engine, gate)
    return made


_GROUPS = {"contacts": "laws", "materials": "laws", "engine": "engines"}
"""Where classes of the components of a section are listed, if not under its own name."""
_UNITS = {"t_end": "s", "sample_interval": "s", "gravity": "m/s^2"}
_UNKNOWN = "SI"
"""Unit of what is no parameter of a class, as the words of a start: they are in SI units."""


def numbers(tables: TomlTable, gate: Gate) -> dict[str, tuple[float, Rule]]:
    """All numbers by dotted key, "bodies.ball.radius", each with its rule.

    Elements of arrays count from 0; the gate says what classes the names mean.
    """
    return dict(_numbers(tables, (), None, gate))


def _numbers(
    place: Any, way: tuple[str, ...], rule: Rule | None, gate: Gate, group: str = ""
) -> Iterator[tuple[str, tuple[float, Rule]]]:
    """Walk through tables; ``group`` lists the classes of the components that are looked for, "" where none are."""
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
    """Class that the table of a component names, None where it is no such table."""
    word = table.get(TYPE)
    if group not in registry.GROUPS or not isinstance(word, str):
        return None
    return gate.component(TYPE, group, Component, word)
