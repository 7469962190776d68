"""The words of a request that a folder holds: of the kinds that the command line writes."""

from __future__ import annotations

from collections.abc import Mapping
from types import NoneType
from typing import Any

from nonsmooth.errors import InvalidInput

Kinds = Mapping[str, tuple[type, ...]]

RUN: Kinds = {"scenario": (str,), "set": (list,), "law": (list,), "engine": (str, NoneType)}
"""Of a run."""
STUDY: Kinds = {
    "scenario": (str,),
    "over": (list,),
    "sample": (str, NoneType),
    "seed": (int,),
    "set": (list,),
    "engine": (str, NoneType),
    "budget": (int, NoneType),
    "period": (int, float, NoneType),
    "within": (str, NoneType),
    "keep": (int,),
    "at": (int, float),
    "phase": (str, NoneType),
    "record": (list,),
}
"""Of a study."""


def check(thing: str, words: Any, kinds: Kinds) -> None:
    """Refuse words that no command has written.

    Raises
    ------
    InvalidInput
        If one is missing, or of another kind.
    """
    if not isinstance(words, dict):
        raise InvalidInput(f"{thing}: request", "must be a table", words, "It is damaged.")
    for name, kind in kinds.items():
        value = words.get(name)
        fits = isinstance(value, kind) and not isinstance(value, bool)
        if not fits or (isinstance(value, list) and not all(isinstance(one, str) for one in value)):
            raise InvalidInput(
                f"{thing}: request: {name}", "must be as a command has written it", value, "It is damaged."
            )
