"""Conversion of components to tables and back; a component is a frozen dataclass with an installed name."""

from __future__ import annotations

import collections.abc
import contextlib
import dataclasses
import functools
import inspect
import types
import typing
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files import named
from nonsmooth.files.gate import Gate
from nonsmooth.plugins import registry

_BASES = tuple(base for bases in registry.GROUPS.values() for base in bases)
TYPE = "type"
"""Key of the entry of a table that names the class of the component."""

TomlTable = dict[str, Any]


def table_of(component: Any, thing: str, declared: Any = None) -> TomlTable:
    """Component as a table of plain values.

    Parameters
    ----------
    component : object
        A dataclass.
    thing : str
        Name of the component in messages, such as "bodies.ball".
    declared : type, optional
        Class that a reader expects; the table leaves it out if it is the class of the component.

    Raises
    ------
    InvalidInput
        The class is not installed, or a value is a function that cannot be imported or another object that a file
        cannot contain.
    """
    owner: Any = type(component)
    table: TomlTable = {}
    if declared is not owner:
        # the classes of helpers have no installed names
        name = registry.name_of(owner) if issubclass(owner, _BASES) else named.name_of(thing, owner)
        if name is None:
            raise InvalidInput(
                thing,
                "must be of an installed class, so that a file can name it",
                owner.__name__,
                "Give it an entry point in a package, as a plug-in has.",
            )
        table[TYPE] = name
    if TYPE in {field.name for field in dataclasses.fields(owner)}:
        raise InvalidInput(
            f"{thing}.{TYPE}", "must not be a parameter", owner.__name__, "Files use this key for the class: rename it."
        )
    hints = hints_of(owner)
    for field in dataclasses.fields(owner):
        value = getattr(component, field.name)
        if not field.init or (value is None and field.default is None):
            continue
        table[field.name] = _plain(value, f"{thing}.{field.name}", hints[field.name])
    return table


@functools.cache
def hints_of(owner: Any) -> Mapping[str, Any]:
    """Type hints of a component's parameters."""
    # cached, because hints are compiled from text: without the cache, half of the time of reading a system
    return typing.get_type_hints(owner)


def _plain(value: Any, thing: str, hint: Any) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (tuple, list, range)):
        hints = _elements(hint, len(value))
        return [_plain(one, f"{thing}[{i}]", hints[i]) for i, one in enumerate(value)]
    if isinstance(value, Mapping) and all(isinstance(key, str) for key in value):
        return {key: _plain(one, f"{thing}.{key}", Any) for key, one in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return table_of(value, thing, _own_class(hint))
    if inspect.isfunction(value):
        return named.name_of(thing, value)
    raise InvalidInput(
        thing,
        "must be made of numbers, words, components and plain functions to be written to a file",
        repr(value),
        "A system with other objects lives in a Python scenario; write one, or a class with an entry point.",
    )


def component(thing: str, value: Any, base: type, gate: Gate) -> Any:
    """Component from its table, or from the name of a class whose parameters all have defaults.

    Parameters
    ----------
    thing : str
        Place in the file, for messages.
    value : dict or str
        The table, with the key ``type``; or the value of that key alone.
    base : type
        Interface that the component must implement.
    gate : Gate
        Decides which classes and functions the names may mean.

    Raises
    ------
    InvalidInput
        A class or a key is unknown, or a value is missing or breaks a rule.
    PluginError
        The class cannot be loaded.
    """
    table = {TYPE: value} if isinstance(value, str) else value
    if not isinstance(table, dict):
        raise InvalidInput(thing, "must be a table or a name", value, f'For example {{ {TYPE} = "..." }}.')
    if TYPE not in table and _concrete(base):
        return _made(thing, base, table, gate)
    if not issubclass(base, _BASES):
        return _helper(thing, base, table, gate)
    group = next(group for group, bases in registry.GROUPS.items() if issubclass(base, bases))
    if not isinstance(table.get(TYPE), str):
        raise InvalidInput(
            f"{thing}.{TYPE}",
            "must be a name",
            table.get(TYPE),
            f"Known: {', '.join(registry.names(group))}; or FILE.py:CLASS.",
        )
    with naming(f"{thing}.{TYPE}"):
        owner = gate.component(registry.KINDS[group], group, base, table[TYPE])
    return _made(thing, owner, {key: one for key, one in table.items() if key != TYPE}, gate)


def _helper(thing: str, base: type, table: TomlTable, gate: Gate) -> Any:
    """Component of a helper class, which has no installed name but a name in Python, ``module:Class``."""
    word = table.get(TYPE)
    if not named.is_name(word):
        raise InvalidInput(f"{thing}.{TYPE}", "must be the name of a class", word, 'For example "bodies:PointFrame".')
    owner = gate.helper(f"{thing}.{TYPE}", str(word))
    if not (isinstance(owner, type) and issubclass(owner, base) and _concrete(owner)):
        raise InvalidInput(f"{thing}.{TYPE}", f"must name a class of the kind {base.__name__}", word, "Take another.")
    return _made(thing, owner, {key: one for key, one in table.items() if key != TYPE}, gate)


def _made(thing: str, owner: Any, table: TomlTable, gate: Gate) -> Any:
    hints = hints_of(owner)
    fields = {field.name: field for field in dataclasses.fields(owner) if field.init}
    for key in table:
        if key not in fields:
            raise UnknownName(f"{thing}: parameter of {owner.__name__}", key, fields)
    for name, field in fields.items():
        if name not in table and field.default is field.default_factory:  # both MISSING
            rule = field.metadata.get("rule")
            raise InvalidInput(
                f"{thing}.{name}", "must be given", None, f"It is the {rule.doc} [{rule.unit}]." if rule else "Add it."
            )
    values = {key: _value(f"{thing}.{key}", one, hints[key], gate) for key, one in table.items()}
    with naming(thing):
        try:
            return owner(**values)
        except (TypeError, AttributeError) as error:
            raise InvalidInput(
                owner.__name__, "must be made of values of the right kinds", table, f"{error}."
            ) from error


def _value(thing: str, value: Any, hint: Any, gate: Gate) -> Any:
    base = _component_class(hint)
    if isinstance(value, list):
        hints = _elements(hint, len(value))
        return tuple(_value(f"{thing}[{i}]", one, hints[i], gate) for i, one in enumerate(value))
    if base is not None and isinstance(value, (dict, str)):
        return component(thing, value, base, gate)
    if isinstance(value, str) and any(typing.get_origin(one) is collections.abc.Callable for one in _options(hint)):
        return gate.function(thing, value)
    if isinstance(value, dict):
        return {key: _value(f"{thing}.{key}", one, Any, gate) for key, one in value.items()}
    return value


@contextlib.contextmanager
def naming(thing: str) -> Iterator[None]:
    """Put the place in a file, ``thing``, in front of the messages of errors."""
    try:
        yield
    except InvalidInput as error:
        raise error.within(thing) from error


def _options(hint: Any) -> tuple[Any, ...]:
    """Types that a type hint allows: the members of a union, or the type itself; without None."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return tuple(one for one in typing.get_args(hint) if one is not type(None))
    return (hint,)


def _elements(hint: Any, n: int) -> tuple[Any, ...]:
    """Type hints of the n elements of a sequence, from the type hint of the sequence."""
    for one in _options(hint):
        arguments = typing.get_args(one)
        if typing.get_origin(one) is tuple and len(arguments) == n and Ellipsis not in arguments:
            return arguments
        if typing.get_origin(one) in (tuple, list, collections.abc.Sequence) and arguments:
            return (arguments[0],) * n
    return (Any,) * n


def _concrete(owner: Any) -> bool:
    return isinstance(owner, type) and dataclasses.is_dataclass(owner) and not _abstract(owner)


def _abstract(owner: type) -> bool:
    return bool(getattr(owner, "__abstractmethods__", ()))


def _component_class(hint: Any) -> Any:
    """Class or interface of components in a type hint: the first if there are several; None without such a class."""
    for one in _options(hint):
        if isinstance(one, type) and (issubclass(one, _BASES) or dataclasses.is_dataclass(one)):
            return one
    return None


def _own_class(hint: Any) -> Any:
    """Class that a reader uses if the table of a component names no class; None if the hint allows several classes."""
    owner = _component_class(hint)
    return owner if _concrete(owner) else None


def group_of(hint: Any) -> str:
    """Group of installed components that a type hint or its elements allow; "" if they allow no component."""
    known = (*_options(hint), *(one for option in _options(hint) for one in typing.get_args(option)))
    base = next((one for one in known if isinstance(one, type) and issubclass(one, _BASES)), None)
    return "" if base is None else next(name for name, bases in registry.GROUPS.items() if issubclass(base, bases))
