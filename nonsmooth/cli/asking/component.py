"""``NAME,PARAMETER=VALUE,...``: a component in one word of the command line."""

from __future__ import annotations

from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.files.gate import Gate
from nonsmooth.parameters import from_all_words


def made(option: str, group: str, base: type, word: str, form: str, example: str, gate: Gate) -> Any:
    """Return the component that a word means: an installed name or FILE.py:CLASS, and its parameters.

    Parameters
    ----------
    option : str
        What asks for it, for messages ("--law friction").
    group : str
        Group of the installed names.
    base : type
        The interface that it must implement.
    word : str
        The word.
    form, example : str
        What a message says of the form.
    gate : Gate
        What the name may mean.

    Raises
    ------
    InvalidInput
        If the word has another form, a name is unknown, a parameter is wrong or missing.
    PluginError
        If it cannot be loaded.
    """
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
