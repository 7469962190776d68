"""Conformance checks of everything that has parameters, and copies of components with other parameters."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from nonsmooth.errors import InvalidInput, NonsmoothError, PluginError
from nonsmooth.files import components as files
from nonsmooth.files.formats import text_of as toml_text
from nonsmooth.files.gate import TRUSTED
from nonsmooth.parameters import Rule, UnusualValue, from_words, rules
from nonsmooth.testing.outcome import Broken, NotChecked, Row, name_of, says_of, words_of

_FAR = 3.0
"""Checks also try each parameter at this multiple of its given value, and at the given value divided by it."""
_JUST = 1e-9
"""Distance of a value past a bound of its range, relative to the bound, at which a component must refuse the value."""


def remade(component: Any, **values: Any) -> Any:
    """Return a copy of the component with other parameters, without the warning about unusual values.

    Raises
    ------
    InvalidInput
        The component refuses the parameters.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        return dataclasses.replace(component, **values)


def accepted(component: Any, **values: Any) -> Any:
    """Return a copy of the component with other parameters; None if the component refuses them."""
    try:
        return remade(component, **values)
    except InvalidInput:
        return None


def numbers_of(component: Any) -> dict[str, tuple[Any, Rule]]:
    """Return the parameters that are numbers: name -> value and rule."""
    found = {name: (getattr(component, name), rule) for name, (field, rule) in rules(type(component)).items()}
    return {name: (value, rule) for name, (value, rule) in found.items() if rule.unit != ""}


def variants(component: Any) -> list[Any]:
    """Return the component, and copies of it; in each copy a single parameter has another value within its range."""
    found = [component]
    for name, (value, rule) in numbers_of(component).items():
        for other in _inside(value, rule):
            made = accepted(component, **{name: other}) if value is not None and other != value else None
            if made is not None:
                found.append(made)
    return found


def component_rows(component: Any) -> list[Row]:
    """Return the properties that every component has."""
    checks = _declared_bounds, _round_trip, _immutable
    return [Row(name_of(check), says_of(check), functools.partial(check, component)) for check in checks]


def _declared_bounds(component: Any) -> None:
    """A parameter outside of its declared range, or not a finite number, raises InvalidInput.

    A value inside of the range is accepted, at least together with some values of the other parameters.
    """
    owner = type(component)
    for name, (field, rule) in rules(owner).items():
        wrong: tuple[Any, ...] = _outside(rule) if rule.unit != "" else ()
        if rule.choices:
            wrong += ("no such word",)
        for value in wrong:
            if field.init and accepted(component, **{name: value}) is not None:
                raise Broken(f"a value outside of its range ({rule.describe()}) is accepted", name, repr(value))
    for name, (value, rule) in numbers_of(component).items():
        for one in _inside(value, rule):
            if not _acceptable(component, name, one, rule):
                raise Broken(f"a value inside of its range ({rule.describe()}) is refused", name, repr(one))


def _acceptable(component: Any, name: str, value: float, rule: Rule) -> bool:
    """True if the component accepts a value of a parameter with some values of the other parameters.

    A component may accept integers only, so the value rounded to an integer is tried, too. A component may refuse a
    bound of the range, so a value near this bound is tried, too, if ``value`` is a bound.
    """
    low, high = max(rule.minimum, rule.above), rule.maximum
    near = [value, float(round(value))]
    if value in (low, high):
        step = 0.01 * (high - low if math.isfinite(high - low) else 1.0 + abs(value))
        near.append(value + step if value == low else value - step)
    return any(
        accepted(component, **{name: one}, **others) is not None
        for one in near
        if low <= one <= high
        for others in _others(component, name)
    )


def _others(component: Any, name: str) -> Iterator[dict[str, Any]]:
    """Yield changes of the other parameters with which a value of ``name`` may be accepted.

    In this order: no change; one parameter left out; one at another value; all at their lowest value; all at their
    highest value; all components of a vector zero; all components zero but one.
    """
    yield {}
    for other, (field, _) in rules(type(component)).items():
        if field.default is None and other != name:
            yield {other: None}
    ranges = {
        other: _inside(value, rule) + ((rule.usual[1],) if math.isfinite(rule.usual[1]) else ())
        for other, (value, rule) in numbers_of(component).items()
        if other != name
    }
    for other, values in ranges.items():
        for value in values:
            yield {other: value}
    for pick in (min, max):
        yield {other: pick(values) for other, values in ranges.items() if values}
    # parameters that may be zero or negative can be the components of a unit vector. So all of them are zero at first,
    # then all except a single one
    low = {other: max(rule.minimum, rule.above) for other, (_, rule) in numbers_of(component).items()}
    zero = {other: 0.0 for other in ranges if low[other] < 0.0}
    yield zero
    for other in zero:
        yield zero | {other: max(ranges[other])}


def _round_trip(component: Any) -> None:
    """A component made anew from text, JSON or a scenario file equals the original and offers the same parameters."""
    owner = type(component)
    declared = {name: getattr(component, name) for name, (field, _) in rules(owner).items() if field.init}
    fields = [field.name for field in dataclasses.fields(component) if field.init]
    rest = {name: getattr(component, name) for name in fields if name not in declared}
    # the route "words" passes numbers and strings as text, as the command line does. The route "JSON" makes tuples of
    # lists, because JSON has no tuples
    words = {name: str(value) for name, value in declared.items() if isinstance(value, (int, float, str))}
    others = rest | {name: value for name, value in declared.items() if name not in words}
    routes: dict[str, Callable[[], Any]] = {
        "JSON": lambda: owner(**{n: _as_tuple(v) for n, v in json.loads(json.dumps(declared)).items()}, **rest),
        "words": lambda: owner(**others, **from_words(owner, words, owner.__name__)),
        "a scenario file": lambda: _through_file(component),
    }
    for route, read in routes.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnusualValue)
            again = read()
        for name, value in declared.items():
            other = getattr(again, name)
            if other != value:
                raise Broken(f"made anew from {route}, it has another value", name, f"{value!r} -> {other!r}")
        if again != component or dict(again.parameters()) != dict(component.parameters()):
            raise Broken(f"made anew from {route}, it is not equal", "parameters()", dict(again.parameters()))


def _as_tuple(value: Any) -> Any:
    return tuple(map(_as_tuple, value)) if isinstance(value, list) else value


def _through_file(component: Any) -> Any:
    """Return a component after writing it to a scenario file and reading it.

    A component that no file can hold, such as a nameless function, is returned as it is.
    """
    owner = type(component)
    try:
        table = files.table_of(component, owner.__name__, owner)
    except InvalidInput:
        return component
    return files.component(owner.__name__, tomllib.loads(toml_text({"it": table}))["it"], owner, TRUSTED)


def _immutable(component: Any) -> None:
    """No parameter can be set after the component is made."""
    fields = dataclasses.fields(component)
    if not fields:
        raise NotChecked(f"{type(component).__name__}: it has no parameters")
    for field in fields:
        value = getattr(component, field.name)
        try:
            setattr(component, field.name, value)
        except dataclasses.FrozenInstanceError:
            continue
        raise Broken("it can be set: write @dataclass(frozen=True) above the class", field.name, repr(value))


def make(owner: Any, name: str, words: Mapping[str, str]) -> Any:
    """Return a component of a class with the parameters given as text.

    Parameters that are not given are taken from the example of the class. A parameter without example and default gets
    a value in the middle of its range, or its first choice.

    Raises
    ------
    InvalidInput
        A value is wrong, or a field without default and example is not a declared number.
    PluginError
        The class raises an exception of another kind.
    """
    values = {**owner.example(), **from_words(owner, words, name)}
    for field in dataclasses.fields(owner):
        if field.name in values or not field.init or field.default is not field.default_factory:
            continue
        rule = rules(owner)[field.name][1] if field.name in rules(owner) else Rule("", "")
        if rule.unit == "" and not rule.choices:
            remedy = f"Let {owner.__name__}.example return one, or pass an object to the function of nonsmooth.testing."
            raise InvalidInput(f"{name}.{field.name}", "must have a value to be checked with", None, remedy)
        values[field.name] = rule.choices[0] if rule.choices else _typical(rule)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        try:
            return owner(**values)
        except NonsmoothError:
            raise
        except Exception as error:
            raise PluginError(f"{name} cannot be made with {values}: {words_of(error)}.") from error


def _inside(value: float | None, rule: Rule) -> tuple[float, ...]:
    """Return values within the declared range of a parameter: bounds that belong to it and values between."""
    low, high = max(rule.minimum, rule.above), rule.maximum
    tried = [rule.minimum, rule.maximum]
    if value is not None:
        tried += [value, value / _FAR, value * _FAR]
    if low > -math.inf and high < math.inf:
        tried.append(0.5 * (low + high))
    return tuple(x for x in dict.fromkeys(tried) if math.isfinite(x) and low <= x <= high and x > rule.above)


def _outside(rule: Rule) -> tuple[float, ...]:
    """Return values outside of the declared range of a parameter, and those that are not finite."""
    found = [math.nan, math.inf, -math.inf]
    for bound, sign in ((rule.minimum, -1.0), (rule.maximum, 1.0)):
        if math.isfinite(bound):
            found += [bound + sign * (_JUST + _JUST * abs(bound)), bound + sign * (1.0 + abs(bound))]
    if math.isfinite(rule.above):
        found += [rule.above, rule.above - 1.0]
    return tuple(found)


def _typical(rule: Rule) -> float:
    """Return a value in the middle of the declared range of a parameter, or of its usual range."""
    low, high = max(rule.minimum, rule.above), rule.maximum
    if math.isfinite(low) and math.isfinite(high):
        return 0.5 * (low + high)
    if rule.usual[0] > 0.0 and math.isfinite(rule.usual[1]):
        return math.sqrt(rule.usual[0] * rule.usual[1])
    return low + 1.0 if math.isfinite(low) else high - 1.0 if math.isfinite(high) else 1.0
