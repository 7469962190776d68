"""Components as data: bodies, shapes, motions, joints and laws, one within another."""

from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np

from tests.benchmarks.described.vocabulary import KINDS, WORDS

KIND = "kind"
"""The key that says of which class a component is."""


def data_of(value: Any) -> Any:
    """Return a component, a number, a word or a sequence of these as plain data.

    Raises
    ------
    TypeError
        If the vocabulary has no word for a class, or a value cannot be stored, as a function.
    """
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (tuple, list)):
        return [data_of(one) for one in value]
    if type(value) not in WORDS:
        raise TypeError(f"{value!r} has no word in tests/benchmarks/described/vocabulary.py")
    parameters = {field.name: data_of(getattr(value, field.name)) for field in _parameters(value)}
    defaults = {field.name: data_of(field.default) for field in _parameters(value) if _has_default(field)}
    return {KIND: WORDS[type(value)]} | {
        name: one for name, one in parameters.items() if name not in defaults or not _same(one, defaults[name])
    }


def component(data: Any) -> Any:
    """Return what :func:`data_of` described; sequences come back as tuples."""
    if isinstance(data, list):
        return tuple(component(one) for one in data)
    if not isinstance(data, dict):
        return data
    return KINDS[data[KIND]](**{name: component(one) for name, one in data.items() if name != KIND})


def _parameters(value: Any) -> list[dataclasses.Field[Any]]:
    return [field for field in dataclasses.fields(value) if field.init]


def _has_default(field: dataclasses.Field[Any]) -> bool:
    return field.default is not dataclasses.MISSING


def _same(one: Any, two: Any) -> bool:
    # as text: -0.0 is not 0.0, and 1 is not 1.0
    return json.dumps(one) == json.dumps(two)
