"""The impact law by its installed name."""

from __future__ import annotations

from collections.abc import Mapping

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ImpactLaw
from nonsmooth.parameters import rules
from nonsmooth.plugins.file import find


def impact_law(name: str, offered: Mapping[str, float], given: set[str]) -> ImpactLaw:
    """Make an installed impact law.

    Parameters
    ----------
    name : str
        Its name in the registry, or FILE.py:CLASS.
    offered : mapping of str to float
        Parameters that the scenario has for it; those that the law declares are passed on.
    given : set of str
        Those among them that the user set, so that none may be ignored.

    Raises
    ------
    UnknownName
        If no impact law of that name is installed.
    InvalidInput
        If the law does not know a parameter that the user set.
    """
    owner = find("impact law", "laws", ImpactLaw, name)
    declared = rules(owner)
    for parameter in sorted(given - set(declared)):
        raise InvalidInput(
            f"DumbbellScenario.{parameter}",
            f"must not be given with impact={name}, which does not have it",
            offered[parameter],
            "Leave it out.",
        )
    law: ImpactLaw = owner(**{n: value for n, value in offered.items() if n in declared})
    return law
