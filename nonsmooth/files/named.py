"""Functions and classes of importable modules by name, ``module:qualified.name``, and back."""

from __future__ import annotations

import functools
import importlib
import inspect
import re
from importlib.machinery import PathFinder
from typing import Any

from nonsmooth.errors import InvalidInput, PluginError, UnknownName

_NAME = re.compile(r"(?P<module>\w+(?:\.\w+)*):(?P<name>\w+(?:\.\w+)*)")
_REMEDY = "Define it with a name of its own in a module of a package, not in a function, a script or a notebook."


def name_of(thing: str, value: Any) -> str:
    """Name by which a function or class can be imported, ``module:qualified.name``.

    Raises
    ------
    InvalidInput
        It is a lambda, defined in a function or in a script, or its module is not on the path.
    """
    module, name = value.__module__, value.__qualname__
    word = f"{module}:{name}"
    # a module that is loaded but is not on the path cannot be imported elsewhere: a script, or a file run by its path
    on_path = module != "__main__" and PathFinder.find_spec(module.partition(".")[0]) is not None
    if not (on_path and _NAME.fullmatch(word) and _found(module, name) is value):
        raise InvalidInput(thing, "must be importable by its name to be written to a file", word, _REMEDY)
    return word


def _found(module: str, name: str) -> Any:
    try:
        return functools.reduce(getattr, name.split("."), importlib.import_module(module))
    except (ImportError, AttributeError):
        return None


def is_name(word: Any) -> bool:
    """True if a word has the form ``module:qualified.name``."""
    return isinstance(word, str) and _NAME.fullmatch(word) is not None


def find(thing: str, word: str) -> Any:
    """Function or class of a name, ``module:qualified.name``.

    Raises
    ------
    InvalidInput
        The word has another form.
    PluginError
        The module cannot be imported.
    UnknownName
        The module has no such name.
    """
    match = _NAME.fullmatch(word)
    if match is None:
        raise InvalidInput(thing, "must have the form module:name", word, "For example my_package.my_module:force.")
    try:
        place: Any = importlib.import_module(match["module"])
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise PluginError(f"{thing}: the module of {word} cannot be imported: {reason}.") from error
    for part in match["name"].split("."):
        known = vars(place)
        if part not in known:
            raise UnknownName(f"{thing}: name in {match['module']}", part, known)
        place = known[part]
    return place


def function(thing: str, word: str) -> Any:
    """Plain Python function of a name; errors as :func:`find`, or InvalidInput for another object."""
    found = find(thing, word)
    if not inspect.isfunction(found):
        raise InvalidInput(thing, "must name a plain Python function", word, f"It is {found!r}.")
    return found
