"""Make a component of a class with parameters that a user might give."""

from __future__ import annotations

import dataclasses
import math
import warnings
from collections.abc import Mapping
from typing import Any

from nonsmooth.errors import InvalidInput, NonsmoothError, PluginError
from nonsmooth.parameters import Rule, UnusualValue, from_words, rules
from nonsmooth.testing.places import told


def make(owner: Any, name: str, words: Mapping[str, str]) -> Any:
    """Return a component with the parameters given, those of its example, and some value for others without default.

    Raises
    ------
    InvalidInput
        If a value is wrong, or a field without default is no declared number and not in the example.
    PluginError
        If the class raises anything else.
    """
    values = {**owner.example(), **from_words(owner, words, name)}
    for field in dataclasses.fields(owner):
        if field.name in values or not field.init or field.default is not field.default_factory:
            continue
        rule = rules(owner)[field.name][1] if field.name in rules(owner) else Rule("", "")
        if rule.unit == "" and not rule.choices:
            raise InvalidInput(
                f"{name}.{field.name}",
                "must have a value to be looked at with",
                None,
                f"Let {owner.__name__}.example return one, or pass an object to the function of nonsmooth.testing.",
            )
        values[field.name] = rule.choices[0] if rule.choices else _typical(rule)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        try:
            return owner(**values)
        except NonsmoothError:
            raise
        except Exception as error:
            raise PluginError(f"{name} cannot be made with {values}: {told(error)}.") from error


def _typical(rule: Rule) -> float:
    low, high = max(rule.minimum, rule.above), rule.maximum
    if math.isfinite(low) and math.isfinite(high):
        return 0.5 * (low + high)
    if rule.usual[0] > 0.0 and math.isfinite(rule.usual[1]):
        return math.sqrt(rule.usual[0] * rule.usual[1])
    return low + 1.0 if math.isfinite(low) else high - 1.0 if math.isfinite(high) else 1.0
