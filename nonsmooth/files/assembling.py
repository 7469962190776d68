"""Building of a system from the tables of a file, in the order in which a user would declare it in Python."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files.components import TomlTable, component, naming
from nonsmooth.files.gate import Gate
from nonsmooth.files.parsing import check_keys, number, tables_in, words
from nonsmooth.interfaces import Body, Guard, ImpactLaw, Joint, Load, NormalLaw, TangentialLaw
from nonsmooth.placing import starts
from nonsmooth.plugins import file, registry
from nonsmooth.system.materials import ContactLaws, Materials
from nonsmooth.system.system import System

_ROLES: dict[str, type] = {"normal": NormalLaw, "friction": TangentialLaw, "impact": ImpactLaw}
_PLACES = ("touching", "at_height", "resting")


def system(tables: TomlTable, path: Path, gate: Gate) -> System:
    """System from the tables of a file; the gate decides which classes and functions the names may mean.

    Raises
    ------
    InvalidInput
        The tables break a rule.
    """
    reader = _Reader(path, gate, tables.get("laws", {}), {})
    starts = {}
    bodies = tables["bodies"]
    if not (isinstance(bodies, dict) and bodies and all(isinstance(one, dict) for one in bodies.values())):
        raise InvalidInput(f"{path}: bodies", "must be tables by name", bodies, "Write [bodies.ball] above each.")
    made_of: dict[str, list[Body]] = {}
    for name, table in bodies.items():
        own = dict(table)
        starts[name] = own.pop("start", {})
        material = own.pop("material", None)
        made = reader.bodies[name] = component(f"{path}: bodies.{name}", own, Body, gate)
        if not (material is None or isinstance(material, str)):
            raise InvalidInput(f"{path}: bodies.{name}.material", "must be one name", material, 'Write "steel".')
        if material is not None:
            made_of.setdefault(material, []).append(made)
    with naming(f"{path}"):
        made_system = System(list(reader.bodies.values()), tables.get("gravity", 9.81))
    for name, body in reader.bodies.items():
        with naming(f"{path}: bodies"):
            made_system.name(body, name)
    for i, table in enumerate(tables_in(f"{path}: joints", tables.get("joints", []))):
        reader.tie(made_system.joint, table, f"{path}: joints[{i}]", Joint)
    for i, table in enumerate(tables_in(f"{path}: contacts", tables.get("contacts", []))):
        reader.contact(made_system, table, f"{path}: contacts[{i}]")
    for one, other in reader.excluded(tables, f"{path}: exclude"):
        with naming(f"{path}: exclude"):
            made_system.exclude(one, other)
    if "materials" in tables:
        reader.materials(made_system, tables["materials"], made_of, f"{path}: materials")
    elif made_of:
        raise InvalidInput(
            f"{path}: materials", "must be given where bodies have one", sorted(made_of), "Add the table."
        )
    for i, table in enumerate(tables_in(f"{path}: loads", tables.get("loads", []))):
        reader.tie(made_system.load, table, f"{path}: loads[{i}]", Load)
    for i, table in enumerate(tables_in(f"{path}: guards", tables.get("guards", []))):
        own = dict(table)
        name = own.pop("name", "")
        made_guard = component(f"{path}: guards[{i}]", own, Guard, gate)
        with naming(f"{path}: guards[{i}]"):
            made_system.guard(made_guard, name=name)
    for later in (False, True):  # a start with "place" puts a body onto others, so the others are placed first
        for name, start in starts.items():
            if not isinstance(start, dict):
                raise InvalidInput(f"{path}: bodies.{name}.start", "must be a table", start, "See Body.state.")
            if start and ("place" in start) == later:
                with naming(f"{path}: bodies.{name}.start"):
                    _start(made_system, reader.bodies[name], dict(start))
    return made_system


def _start(made: System, body: Body, start: TomlTable) -> None:
    place = start.pop("place", None)
    if place is None and {"q", "u"} & set(start):
        check_keys("start by q and u", start, ("q", "u"), required=("q", "u"))
        made.set_start(body, start["q"], start["u"])
    elif place is None:
        made.place(body, **start)
    elif place == "touching":
        starts.touching(made, body, **start)
    elif place == "resting":
        starts.resting(made, body, **start)
    elif place == "at_height":
        height = number("height", start.pop("height", None), "m")
        starts.at_height(made, body, height, **start)
    else:
        raise UnknownName("place", str(place), _PLACES)


@dataclass(frozen=True)
class _Reader:
    path: Path
    gate: Gate
    laws: TomlTable
    bodies: dict[str, Body]

    def body(self, name: str, thing: str) -> Body:
        if name not in self.bodies:
            raise UnknownName(f"{thing}: body", name, self.bodies)
        return self.bodies[name]

    def between(self, table: TomlTable, thing: str) -> tuple[Body, Body]:
        one, two = words(f"{thing}.between", table.get("between"), 2)
        return self.body(one, thing), self.body(two, thing)

    def excluded(self, table: TomlTable, thing: str) -> list[tuple[Body, Body]]:
        left_out = table.get("exclude", [])
        if not isinstance(left_out, list):
            raise InvalidInput(thing, "must be a list of pairs", left_out, 'For example [["a", "b"]].')
        return [self.between({"between": pair}, thing) for pair in left_out]

    def law(self, value: Any, thing: str, base: type) -> Any:
        if isinstance(value, str) and value in self.laws:
            return component(f"{self.path}: laws.{value}", self.laws[value], base, self.gate)
        if isinstance(value, str) and value not in registry.names("laws") and not file.is_file(value):
            raise UnknownName(f"{thing}: law", value, [*self.laws, *registry.names("laws")])
        return component(thing, value, base, self.gate)

    def contact_laws(self, table: TomlTable, thing: str) -> ContactLaws:
        for role in ("normal", "friction"):
            if role not in table:
                remedy = "Write a name of [laws], an installed name, or a table with its type."
                raise InvalidInput(f"{thing}.{role}", "must be given", None, remedy)
        laws = {role: self.law(table[role], f"{thing}.{role}", base) for role, base in _ROLES.items() if role in table}
        with naming(thing):
            return ContactLaws(**laws)

    def tie(self, add: Callable[..., None], table: TomlTable, thing: str, base: type) -> None:
        own = dict(table)
        first, second = self.between(own, thing)
        name, frames = own.pop("name", ""), own.pop("frames", [0, 0])
        del own["between"]
        if not (isinstance(frames, list) and len(frames) == 2):
            raise InvalidInput(f"{thing}.frames", "must be two numbers", frames, "For example [0, 1].")
        made = component(thing, own, base, self.gate)
        with naming(thing):
            add(made, first, second, frames=tuple(frames), name=name)

    def contact(self, made: System, table: TomlTable, thing: str) -> None:
        check_keys(thing, table, ("name", "between", "shapes", *_ROLES), required=("between",))
        first, second = self.between(table, thing)
        shapes = table.get("shapes", ["all", "all"])
        if isinstance(shapes, list):
            shapes = [None if one == "all" else one for one in shapes]
        laws, name = self.contact_laws(table, thing), table.get("name", "")
        n, f, i = laws.normal, laws.friction, laws.impact
        with naming(thing):
            made.contact(first, second, normal=n, friction=f, impact=i, shapes=shapes, name=name)

    def materials(self, made: System, table: TomlTable, of: dict[str, list[Body]], thing: str) -> None:
        check_keys(thing, table, ("pairs", "default", "exclude"))
        pairs: dict[tuple[str, str], ContactLaws] = {}
        for i, pair in enumerate(tables_in(f"{thing}.pairs", table.get("pairs", []))):
            where = f"{thing}.pairs[{i}]"
            check_keys(where, pair, ("between", *_ROLES), required=("between",))
            one, two = words(f"{where}.between", pair["between"], 2)
            if (one, two) in pairs:
                raise InvalidInput(where, "must name a pair once", [one, two], "Take one of the two out.")
            pairs[one, two] = self.contact_laws(pair, where)
        default = None
        if "default" in table:
            check_keys(f"{thing}.default", table["default"], tuple(_ROLES))
            default = self.contact_laws(table["default"], f"{thing}.default")
        exclude = self.excluded(table, f"{thing}.exclude")
        with naming(thing):
            made.contact_all(Materials(pairs, default), of, exclude=exclude)
