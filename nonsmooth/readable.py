"""Readable: metaclass of classes whose ``help()``, ``dir()`` and signature show only what a user needs."""

from __future__ import annotations

import functools
import inspect
from abc import ABCMeta
from typing import Any

_SHOWN = (property, classmethod, staticmethod, functools.cached_property)


class Readable(ABCMeta):
    """Metaclass that hides the machinery of dataclasses and abstract classes from ``help()`` and completion.

    ``dir()`` of the class lists its public methods and properties, on which ``help()`` is built.  Default values of
    fields are missing there, because the signature shows them.
    """

    def __dir__(cls) -> list[str]:
        public = {name for owner in cls.__mro__ for name in vars(owner) if not name.startswith("_")}
        return sorted(name for name in public if _is_shown(inspect.getattr_static(cls, name)))

    @property
    def __signature__(cls) -> inspect.Signature:
        """Signature of the constructor, without the object itself."""
        signature = inspect.signature(inspect.getattr_static(cls, "__init__"))
        parameters = list(signature.parameters.values())[1:]
        return signature.replace(parameters=parameters, return_annotation=inspect.Signature.empty)


def _is_shown(attribute: Any) -> bool:
    """True if dir() of the class lists a public attribute: True for a method or property, False for a plain value."""
    return inspect.isroutine(attribute) or isinstance(attribute, _SHOWN)
