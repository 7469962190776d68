"""``--engine ENGINE,NAME=VALUE,...``: what integrates a scenario, with its options."""

from __future__ import annotations

from typing import Any

from nonsmooth.cli.asking import component
from nonsmooth.files.gate import Gate
from nonsmooth.interfaces import Engine
from nonsmooth.parameters import rules

HELP = (
    "what integrates it: ENGINE or ENGINE,NAME=VALUE,...; ENGINE is a name of `nonsmooth list engines` or "
    "FILE.py:CLASS, NAME an option of `nonsmooth show ENGINE`"
)
_FORM = "must have the form ENGINE or ENGINE,NAME=VALUE,..."
_EXAMPLE = "For example --engine event_driven,tolerance=1e-10."


def engine(word: str, gate: Gate) -> Engine:
    """Return the engine asked for, if a gate lets its name pass.

    Raises
    ------
    InvalidInput
        If the word has another form, or an option is wrong.
    PluginError
        If it cannot be loaded.
    """
    made: Engine = component.made("--engine", "engines", Engine, word, _FORM, _EXAMPLE, gate)
    return made


def described(made: Engine) -> dict[str, Any]:
    """Return the class of an engine and its options, for the report."""
    return {"engine": type(made).__name__} | {name: getattr(made, name) for name in rules(type(made))}
