"""Writing of systems to scenario files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nonsmooth.checks import check_kind, is_finite, path_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput
from nonsmooth.files import formats
from nonsmooth.files.components import TYPE, TomlTable, table_of
from nonsmooth.interfaces import Body, Engine
from nonsmooth.storage.files import replacing
from nonsmooth.system.contact import ContactDeclaration, Tie, Watched
from nonsmooth.system.system import System


def save_system(
    system: System,
    path: str | Path,
    *,
    t_end: float | None = None,
    sample_interval: float | None = None,
    engine: Engine | None = None,
    title: str = "",
) -> None:
    """Write a system to a TOML or YAML file that :func:`load_system` and ``nonsmooth run`` read.

    Numbers are read back to the last bit, so that a run from the file is the same run.

    Parameters
    ----------
    system : System
        All of its components must be of installed classes, and its functions importable by name.
    path : str or Path
        The file, ending in .toml, .yaml or .yml.
    t_end, sample_interval : float, optional
        End time and time between samples [s].
    engine : Engine, optional
        Engine for the run; its defaults are not written.
    title : str
        Title, one line.

    Raises
    ------
    InvalidInput
        The name has another suffix, or a component cannot be written; the message names it, and no file is written.
    MissingPackagesError
        The file is YAML, and PyYAML is not installed.
    FileError
        The file cannot be written.
    """
    file = path_of("save_system: path", path)
    form = formats.of(file)
    check_kind("save_system: system", system, System, "Make it by nonsmooth.System([...]).")
    check_kind("save_system: title", title, str, 'For example "Two balls".')
    tables = tables_of(system, t_end=t_end, sample_interval=sample_interval, engine=engine, title=title)
    with replacing(file) as part:
        part.write_text(form.write(tables), encoding="utf-8")


def text_of_system(system: System, *, t_end: float, engine: Engine | None, title: str) -> str:
    """The TOML text of a system, as :func:`save_system` writes it.

    Raises
    ------
    InvalidInput
        A component cannot be written; the message names it.
    """
    return formats.of(Path("system.toml")).write(tables_of(system, t_end=t_end, engine=engine, title=title))


def tables_of(
    system: System,
    *,
    t_end: float | None = None,
    sample_interval: float | None = None,
    engine: Engine | None = None,
    title: str = "",
) -> TomlTable:
    """Tables of a system, as :func:`save_system` writes them.

    Raises
    ------
    InvalidInput
        A component cannot be written, or a time is not finite; the message names it.
    """
    tables: TomlTable = {"title": title} if title else {}
    times = {"t_end": t_end, "sample_interval": sample_interval}
    for name, value in times.items():
        if value is not None:
            if not is_finite(value):
                raise InvalidInput(f"save_system: {name}", "must be a finite number", value, "Give it in [s].")
            tables[name] = float(value)
    x, y, z = system.gravity
    tables["gravity"] = 0.0 - z if x == y == 0.0 and z <= 0.0 else [x, y, z]
    if engine is not None and engine != EventDriven():
        tables["engine"] = table_of(engine, "engine", EventDriven)
    if system.given_contacts:
        given, remedy = system.given_contacts[0], "A file has the contacts of System.contact and System.contact_all."
        raise InvalidInput("save_system", "cannot write a contact of System.add_contact", str(given), remedy)
    known = dict(zip(map(id, system.bodies), system.names.bodies, strict=True))
    laws = _Laws()
    contacts = [_contact(declared, known, laws, f"contacts[{i}]") for i, declared in enumerate(system.declarations)]
    tables["laws"] = laws.tables
    tables["bodies"] = {known[id(body)]: _body(system, body, f"bodies.{known[id(body)]}") for body in system.bodies}
    tables["contacts"] = contacts
    tables["exclude"] = [[known[id(one)], known[id(other)]] for one, other in system.excluded]
    for kind, ties in (("joints", system.joints), ("loads", system.loads)):
        tables[kind] = [_tie(tie, known, f"{kind}[{i}]") for i, tie in enumerate(ties)]
    tables["guards"] = [_name_of(one) | table_of(one.guard, f"guards[{i}]") for i, one in enumerate(system.watched)]
    return {name: value for name, value in tables.items() if value not in ([], {})}


class _Laws:
    """Tables of the laws of a system so far; equal laws are written once, under a name."""

    def __init__(self) -> None:
        self.tables: TomlTable = {}
        self._met: list[tuple[Any, str]] = []

    def name(self, law: Any, thing: str) -> str:
        for other, name in self._met:
            if type(other) is type(law) and other == law:
                return name
        table = table_of(law, thing)
        name = str(table[TYPE])
        # a law with parameters gets a table with a free name; a law without is written as its installed name alone
        if len(table) > 1:
            name = _free(name, self.tables)
            self.tables[name] = table
        self._met.append((law, name))
        return name


def _free(name: str, taken: TomlTable) -> str:
    number, free = 1, name
    while free in taken:
        number += 1
        free = f"{name}_{number}"
    return free


def _body(system: System, body: Body, thing: str) -> TomlTable:
    table = table_of(body, thing)
    if body.n_q:
        q, u = system.start(body)
        table["start"] = {"q": q.tolist(), "u": u.tolist()}
    return table


def _contact(declared: ContactDeclaration, known: dict[int, str], laws: _Laws, thing: str) -> TomlTable:
    table: TomlTable = {"between": [known[id(declared.first)], known[id(declared.second)]]}
    if declared.name:
        table["name"] = declared.name
    if declared.shapes != (None, None):
        table["shapes"] = ["all" if chosen is None else list(chosen) for chosen in declared.shapes]
    for role in ("normal", "friction", "impact"):
        law = getattr(declared.laws, role)
        if law is not None:
            table[role] = laws.name(law, f"{thing}.{role}")
    return table


def _name_of(declared: Tie | Watched) -> TomlTable:
    return {"name": declared.name} if declared.chosen else {}


def _tie(tie: Tie, known: dict[int, str], thing: str) -> TomlTable:
    head: TomlTable = {"between": [known[id(tie.first)], known[id(tie.second)]]}
    head |= _name_of(tie)
    if tie.frames != (0, 0):
        head["frames"] = list(tie.frames)
    return head | table_of(tie.component, thing)
