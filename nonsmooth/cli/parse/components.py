"""Engines and laws from one argument of the command line, ``NAME,PARAMETER=VALUE,...``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files.gate import Gate
from nonsmooth.interfaces import CompliantNormalLaw, Engine, ImpactLaw, NormalLaw, TangentialLaw
from nonsmooth.parameters import from_all_words, rules

ROLES: dict[str, type] = {"normal": NormalLaw, "friction": TangentialLaw, "impact": ImpactLaw}
"""Role of a law of a contact, as ``--law`` names it -> interface that the law must implement."""
_LAW = "must have the form ROLE=LAW or ROLE=LAW,NAME=VALUE,..."
_LAW_EXAMPLE = "For example --law friction=./my_law.py:MyLaw,coefficient=0.2."
_ENGINE = "must have the form ENGINE or ENGINE,NAME=VALUE,..."
_ENGINE_EXAMPLE = "For example --engine event_driven,tolerance=1e-10."


def engine(word: str, gate: Gate) -> Engine:
    """Return the engine that a value of ``--engine`` describes.

    Raises
    ------
    InvalidInput
        If the value is malformed, or an option of the engine is wrong or missing.
    PluginError
        If the engine cannot be loaded.
    """
    made: Engine = _component("--engine", "engines", Engine, word, _ENGINE, _ENGINE_EXAMPLE, gate)
    return made


def laws(words: Iterable[str], gate: Gate) -> dict[str, Any]:
    """Return the laws that values of ``--law`` describe, by role.

    Raises
    ------
    InvalidInput
        If a value is malformed, a role is given twice, or a parameter is wrong or missing.
    PluginError
        If a law cannot be loaded.
    """
    made: dict[str, Any] = {}
    for word in words:
        role, _, rest = (part.strip() for part in word.partition("="))
        if not (role and rest):
            raise InvalidInput("--law", _LAW, word, _LAW_EXAMPLE)
        if role not in ROLES:
            raise UnknownName("--law role", role, ROLES)
        if role in made:
            raise InvalidInput(f"--law {role}", "must come once", word, "Leave one out.")
        made[role] = _component(f"--law {role}", "laws", ROLES[role], rest, _LAW, _LAW_EXAMPLE, gate)
    return made


def _component(option: str, group: str, base: type, word: str, form: str, example: str, gate: Gate) -> Any:
    """Return the component of ``word``: an installed name, or FILE.py:CLASS if the gate allows it, with parameters."""
    name, *settings = (part.strip() for part in word.split(","))
    if not name:
        raise InvalidInput(option, form, word, example)
    owner = gate.component(option, group, base, name)
    values: dict[str, str] = {}
    for setting in settings:
        parameter, _, value = (part.strip() for part in setting.partition("="))
        if not (parameter and value) or parameter in values:
            raise InvalidInput(option, f"{form}, each NAME once", word, example)
        values[parameter] = value
    return from_all_words(owner, values, owner.__name__, f"{{name}}=VALUE to {option} {name}")


def described(kind: str, made: Any) -> dict[str, Any]:
    """Return the entries of a component for the report: its class under the key ``kind``, and its parameters."""
    return {kind: type(made).__name__} | {name: getattr(made, name) for name in rules(type(made))}


def replacements(laws: Mapping[str, Any]) -> dict[str, str]:
    """Map the role of each replaced law to the role of the law that replaces it, "normal", "friction" or "impact".

    A new law replaces the law with its own role. A compliant normal law also replaces the impact law.
    """
    replaced = {role: role for role in laws}
    if isinstance(laws.get("normal"), CompliantNormalLaw):
        replaced["impact"] = "normal"
    return replaced


def check_not_ignored(owner: type, given: Iterable[str], laws: Mapping[str, Any]) -> None:
    """Raise InvalidInput if the user gives a parameter of the scenario that belongs to a replaced law."""
    replaced, known = replacements(laws), rules(owner)
    for name in given:
        if name in known and known[name][1].law in replaced:
            role = replaced[known[name][1].law]
            rule = f"must not be given with --law {role}, which replaces the law that it belongs to"
            remedy = f"Leave it out; give the new law its parameters as in --law {role}=LAW,NAME=VALUE."
            raise InvalidInput(f"--set {name}", rule, name, remedy)
