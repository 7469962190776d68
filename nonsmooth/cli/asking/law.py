"""``--law ROLE=LAW,NAME=VALUE,...``: another law in all contacts of a scenario."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from nonsmooth.cli.asking import component
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files.gate import Gate
from nonsmooth.interfaces import CompliantNormalLaw, ImpactLaw, NormalLaw, TangentialLaw
from nonsmooth.parameters import rules

ROLES: dict[str, type] = {"normal": NormalLaw, "friction": TangentialLaw, "impact": ImpactLaw}
"""The laws of a contact, by the name that the option has for them."""

HELP = (
    "a law for all contacts: ROLE=LAW or ROLE=LAW,NAME=VALUE,...; ROLE is normal, friction or impact, "
    "LAW a name of `nonsmooth list laws` or FILE.py:CLASS; may come once a role"
)
_FORM = "must have the form ROLE=LAW or ROLE=LAW,NAME=VALUE,..."
_EXAMPLE = "For example --law friction=./my_law.py:MyLaw,coefficient=0.2."


def laws(words: Iterable[str], gate: Gate) -> dict[str, Any]:
    """Return the laws asked for, by role, whose names a gate lets pass.

    Raises
    ------
    InvalidInput
        If a word has another form, a role comes twice, a parameter is wrong or missing.
    PluginError
        If a law cannot be loaded.
    """
    made: dict[str, Any] = {}
    for word in words:
        role, _, rest = (part.strip() for part in word.partition("="))
        if not (role and rest):
            raise InvalidInput("--law", _FORM, word, _EXAMPLE)
        if role not in ROLES:
            raise UnknownName("--law role", role, ROLES)
        if role in made:
            raise InvalidInput(f"--law {role}", "must come once", word, "Leave one out.")
        made[role] = component.made(f"--law {role}", "laws", ROLES[role], rest, _FORM, _EXAMPLE, gate)
    return made


def replacements(laws: Mapping[str, Any]) -> dict[str, str]:
    """Return the roles whose laws are replaced, each with the role of the law that does it."""
    replaced = {role: role for role in laws}
    if isinstance(laws.get("normal"), CompliantNormalLaw):
        replaced["impact"] = "normal"
    return replaced


def described(law: Any) -> dict[str, Any]:
    """Return the class of a law and its parameters, for the report."""
    return {"law": type(law).__name__} | {name: getattr(law, name) for name in rules(type(law))}


def check_not_ignored(owner: type, given: Iterable[str], laws: Mapping[str, Any]) -> None:
    """Raise InvalidInput if a parameter of a scenario was given whose law one of ``laws`` replaces."""
    replaced, known = replacements(laws), rules(owner)
    for name in given:
        if name in known and known[name][1].law in replaced:
            role = replaced[known[name][1].law]
            raise InvalidInput(
                f"--set {name}",
                f"must not be given with --law {role}, which replaces the law that it belongs to",
                name,
                f"Leave it out; give the new law its parameters as in --law {role}=LAW,NAME=VALUE.",
            )
