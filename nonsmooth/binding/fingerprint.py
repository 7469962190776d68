"""Key of the machine code of a plain function on disk: a digest of everything that the code depends on."""

from __future__ import annotations

import hashlib
import inspect
import math
import sys
from collections.abc import Callable
from types import CodeType
from typing import Any

import numpy as np

from nonsmooth.engine.native import kernel
from nonsmooth.engine.native.kernel import unshared

_MODULES = (math, np)
_ENGINE = "nonsmooth.engine."


def fingerprint(function: Callable[..., Any], context: str) -> str:
    """Digest of a function's bytecode, of the constants and functions that it names, and of a context.

    The digest describes the loaded code, not the files, which may be newer.  The function may name numbers, strings,
    tuples of them, classes of named tuples, functions at module level, functions of the engine, :mod:`math`,
    :mod:`numpy` and their members.  A function that names anything else has no digest.  A closure has no digest either:
    a program may make any number of closures, and the files of code would grow without limit.

    Parameters
    ----------
    function : callable
        The function.
    context : str
        All else that the machine code depends on.

    Returns
    -------
    str
        The digest; "" for a function without digest.
    """
    parts = [context]
    reached = [unshared(function)]
    for one in reached:  # grows as functions name further ones
        if not inspect.isfunction(one) or one.__closure__ is not None:
            return ""
        # no digest for a module that was not imported, such as one made by exec: its content may change at any time
        if one.__module__ not in sys.modules:
            return ""
        constants = (one.__code__.co_consts, one.__defaults__, *sorted((one.__kwdefaults__ or {}).items()))
        if not _is_constant(constants):
            return ""
        parts.append(repr((one.__module__, one.__qualname__, *_shape(one.__code__), constants)))
        for name, value in sorted(inspect.getclosurevars(one).globals.items()):
            named = unshared(value)
            if _is_constant(value) or any(value is module for module in _MODULES):
                parts.append(f"{name} = {value!r}")
            elif theirs := _place_in_modules(value) or _place_in_engine(value) or _fields(value):
                parts.append(f"{name} = {theirs}")
            elif inspect.isfunction(named):
                reached += [] if named in reached else [named]
                parts.append(f"{name} = function {reached.index(named)}")
            else:
                return ""
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:32]


def _place_in_engine(value: Any) -> str:
    """Qualified name of a function of the engine; "" for other values.

    The name suffices for the digest, because the code of the engine is part of the name of the folder of compiled code.
    """
    if found := next((name for name, one in vars(kernel).items() if one is value and callable(one)), ""):
        return f"{kernel.__name__}:{found}"
    module, name = (str(getattr(value, attribute, "<none>")) for attribute in ("__module__", "__qualname__"))
    return f"{module}:{name}" if module.startswith(_ENGINE) and "<" not in name else ""


def _shape(code: CodeType) -> tuple[Any, ...]:
    """Arguments, bytecode and names of a code object. They and its constants determine what the code does."""
    arguments = (code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags)
    return *arguments, code.co_code, code.co_exceptiontable, code.co_names, code.co_varnames


def _place_in_modules(value: Any) -> str:
    """Qualified name of a member of :mod:`math` or :mod:`numpy`; "" for other values.

    The name suffices for the digest, because the versions of Python and numpy are part of the name of the folder of
    compiled code.
    """
    found = (f"{module.__name__}.{name}" for module in _MODULES for name, one in vars(module).items() if one is value)
    return next(found, "")


def _fields(value: Any) -> str:
    """Fields of a class of named tuples; "" for anything else."""
    if not isinstance(value, type) or value.__bases__ != (tuple,):
        return ""
    fields, defaults = (vars(value).get(name) for name in ("_fields", "_field_defaults"))
    return f"fields {fields!r}" if fields and not defaults else ""


def _is_constant(value: Any) -> bool:
    """True if a value is a number, string or tuple, so that its ``repr`` determines it and can enter the digest."""
    if type(value) is tuple:
        return all(_is_constant(item) for item in value)
    return value is None or type(value) in (bool, int, float, str)
