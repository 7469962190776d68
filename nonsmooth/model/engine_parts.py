"""What an engine says that it works with, looked through before it is laid out: names, lengths, numbers."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from numbers import Real

from nonsmooth.engine.memory.arrays.arrays import Arrays
from nonsmooth.engine.memory.memory import NOTHING
from nonsmooth.engine.memory.tables import ARRAYS_OF, CONSTANT_SCALARS, SCALARS, floats_of, integers_of
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine
from nonsmooth.interfaces.engine_report import FIRST_CODE

_SETTABLE = tuple(name for name in SCALARS.names or () if name not in CONSTANT_SCALARS)


def layers_of(engine: Engine) -> Collection[str]:
    """Return its layers.

    Raises
    ------
    UnknownName
        If there is none of that name.
    """
    return _known(engine, "layers", engine.layers, ARRAYS_OF)


def counts_of(engine: Engine, n_slots: int, free: Collection[str]) -> Mapping[str, int]:
    """Return the counts that it decides out of those that are free.

    Raises
    ------
    InvalidInput
        If another one is among them, or one is no length.
    """
    found = engine.counts(n_slots)
    for name in _known(engine, "counts", found, free):
        if not (isinstance(found[name], int) and found[name] >= 0):
            rule = "must be a whole number, not negative"
            raise InvalidInput(f"{_name(engine)}.counts: {name}", rule, found[name], "It is a length of arrays.")
    return found


def settings_of(engine: Engine, time_scale: float) -> Mapping[str, float]:
    """Return the scalars that it sets.

    Raises
    ------
    InvalidInput
        If there is none of that name, it is a count or the place of an array, or a value is no number.
    """
    found = engine.settings(time_scale)
    for name in _known(engine, "settings", found, (*_SETTABLE, *own_of(engine).scalars)):
        if not isinstance(found[name], Real):
            thing = f"{_name(engine)}.settings: {name}"
            raise InvalidInput(thing, "must be a number", found[name], "Return its value in SI units.")
    return found


def own_of(engine: Engine) -> Arrays:
    """Return what it has of its own."""
    return NOTHING if engine.own is None else engine.own


def laid_own(engine: Engine, counts: Mapping[str, int]) -> Arrays:
    """Return what it has of its own in a system of these counts.

    Raises
    ------
    InvalidInput
        If a name is taken, or a length none that the counts give.
    """
    own, taken = own_of(engine), [*(SCALARS.names or ())]
    arrays = floats_of([own]), integers_of([own])
    for name in (*own.scalars, *arrays[0], *arrays[1]):
        if name in taken or not name.isidentifier():
            rule = "must be names in Python that no scalar and no other array has"
            raise InvalidInput(f"{_name(engine)}.own", rule, name, "Begin them with the name of the engine.")
        taken.append(name)
    for name, size in (arrays[0] | arrays[1]).items():
        try:
            length = size(counts)
        except KeyError as error:
            raise UnknownName(f"{_name(engine)}.own: {name}: count", str(error.args[0]), counts) from error
        if not (isinstance(length, int) and length >= 0):
            rule = "must have a whole number for its length, not negative"
            raise InvalidInput(f"{_name(engine)}.own: {name}", rule, length, "Take per(...) or fixed(...).")
    return own


def check_report(engine: Engine) -> None:
    """Look whether an engine can report what it declares.

    Raises
    ------
    InvalidInput
        If a measure is no scalar of its own, a cause has a code that is taken, or the promised residual is no part.
    """
    _known(engine, "verdict", [one.name for one in engine.verdict], own_of(engine).scalars)
    codes = [cause.code for cause in engine.causes]
    if len({*codes}) < len(codes) or min(codes, default=FIRST_CODE) < FIRST_CODE:
        rule = f"must have codes of their own, {FIRST_CODE} or more"
        raise InvalidInput(f"{_name(engine)}.causes", rule, codes, "Number the causes anew.")
    promised = engine.promised_residual
    if promised is not None and not (isinstance(promised, Real) and math.isfinite(promised) and promised > 0.0):
        rule = "must be a positive finite number or None"
        raise InvalidInput(f"{_name(engine)}.promised_residual", rule, promised, "Give a part of the energy exchanged.")


def _known(engine: Engine, what: str, names: Iterable[str], known: Collection[str]) -> tuple[str, ...]:
    for name in (found := tuple(names)):
        if name not in known:
            raise UnknownName(f"{_name(engine)}.{what}", name, known)
    return found


def _name(engine: Engine) -> str:
    return type(engine).__name__
