"""Checks of what an engine declares: counts, settings, its own part of the workspace, causes and measures.

An engine may be a plug-in. A wrong declaration is found before the memory is laid out, and the message names it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from numbers import Real
from typing import Any, get_type_hints

from nonsmooth.engine.memory.declare import Declaration, Singleton, declarations
from nonsmooth.engine.memory.tables import CONSTANT_SCALARS
from nonsmooth.engine.memory.workspace import Workspace
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Engine, Scales
from nonsmooth.interfaces.engine import FIRST_CODE


def counts_of(engine: Engine, n_slots: int, free: Collection[str]) -> Mapping[str, int]:
    """Lengths that the engine chooses for its arrays, by name, for at most ``n_slots`` active contacts; checked.

    ``free`` has the names of the lengths that the engine may choose. The system fixes all other lengths.

    Raises
    ------
    InvalidInput
        If the engine decides another count, or a count is negative or no integer.
    """
    found = engine.counts(n_slots)
    for name in _known(engine, "counts", found, free):
        if not (isinstance(found[name], int) and found[name] >= 0):
            rule = "must be an integer, not negative"
            raise InvalidInput(f"{_name(engine)}.counts: {name}", rule, found[name], "It is a length of arrays.")
    return found


def settings_of(engine: Engine, scales: Scales) -> Mapping[Any, float]:
    """Scalars of the workspace that the engine sets, such as tolerances, with their values, checked.

    Raises
    ------
    InvalidInput
        If a key is no scalar, is the size of an array, or a value is no number.
    """
    found = engine.settings(scales)
    for one, value in found.items():
        thing, rule = f"{_name(engine)}.settings", "must have scalars of the workspace for its keys"
        # a declaration of a Singleton without a size is a scalar
        if not (isinstance(one, Declaration) and issubclass(one.owner, Singleton) and one.size is None):
            raise InvalidInput(thing, rule, one, "Return for example {Tolerance.relative: 1e-9}.")
        if one.key in CONSTANT_SCALARS:
            raise InvalidInput(f"{thing}: {one.key}", "must not be the size of an array", one.key, "Leave it out.")
        if not isinstance(value, Real):
            raise InvalidInput(f"{thing}: {one.key}", "must be a number", value, "Return its value in SI units.")
    return found


def own_of(engine: Engine) -> tuple[type[Singleton], ...]:
    """The engine's own part of the workspace, a class of declarations, as a tuple; empty without one.

    Raises
    ------
    InvalidInput
        If ``engine.own`` is no class of declarations.
    """
    own = engine.own
    if own is None:
        return ()
    if not (isinstance(own, type) and issubclass(own, Singleton)):
        rule = "must be a class of declarations, a Singleton"
        raise InvalidInput(f"{_name(engine)}.own", rule, own, "Write class Own(Singleton, key=...).")
    return (own,)


def laid_own(engine: Engine, counts: Mapping[str, int]) -> tuple[type[Singleton], ...]:
    """The engine's own part of the workspace, as a tuple of one or none, checked before memory is allocated for it.

    ``counts`` are those of the system, from which arrays get their lengths.

    Raises
    ------
    InvalidInput
        If another owner has its key, or the counts do not give a length.
    """
    for own in own_of(engine):
        thing = f"{_name(engine)}.own"
        # the workspace has an attribute for each owner, named by its key
        taken = get_type_hints(Workspace)
        if own.key in taken or not own.key.isidentifier():
            rule = "must be a name in Python that no other owner has"
            raise InvalidInput(f"{thing}: key", rule, own.key, "Take the name of the engine.")
        for name, one in declarations(own).items():
            _check_length(f"{thing}: {name}", one, counts)
    return own_of(engine)


def _check_length(thing: str, declared: Declaration, counts: Mapping[str, int]) -> None:
    """Check that the counts of a system give an array its length. ``thing`` is the array in messages.

    The length is a function of the plug-in that takes the counts by name, so it may use an unknown name. A scalar
    has no length.
    """
    if declared.size is None:
        return
    try:
        length = declared.size(counts)
    except KeyError as error:
        raise UnknownName(f"{thing}: count", str(error.args[0]), counts) from error
    if not (isinstance(length, int) and length >= 0):
        rule = "must have an integer as its length, not negative"
        raise InvalidInput(thing, rule, length, "Take per(...) or fixed(...).")


def check_report(engine: Engine) -> None:
    """Check what an engine declares for its reports: measures, causes of an end, and promised residual.

    Measures are scalars of its own part that the user reads after a run. The residual decides which runs are suspect.

    Raises
    ------
    InvalidInput
        If a measure is no scalar of its own part, two causes have the same code or one has a code of a
        :class:`~nonsmooth.engine.memory.modes.Status`, or the residual is not positive.
    """
    scalars = [name for own in own_of(engine) for name, one in declarations(own).items() if one.size is None]
    _known(engine, "verdict", [one.name for one in engine.verdict], scalars)
    codes = [cause.code for cause in engine.causes]
    if len({*codes}) < len(codes) or min(codes, default=FIRST_CODE) < FIRST_CODE:
        rule = f"must have different codes, {FIRST_CODE} or more"
        raise InvalidInput(f"{_name(engine)}.causes", rule, codes, "Number the causes again.")
    promised = engine.promised_residual
    if promised is not None and not (isinstance(promised, Real) and math.isfinite(promised) and promised > 0.0):
        thing, rule = f"{_name(engine)}.promised_residual", "must be a positive finite number or None"
        raise InvalidInput(thing, rule, promised, "Give it relative to the energy exchanged.")


def _known(engine: Engine, what: str, names: Iterable[str], known: Collection[str]) -> tuple[str, ...]:
    """The names that an engine gives in its attribute ``what``, checked to be among the known ones.

    ``UnknownName`` proposes a known name for an unknown one.
    """
    for name in (found := tuple(names)):
        if name not in known:
            raise UnknownName(f"{_name(engine)}.{what}", name, known)
    return found


def _name(engine: Engine) -> str:
    """Name of the class of an engine, for messages."""
    return type(engine).__name__
