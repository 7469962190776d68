"""From the words of a request to a scenario."""

from __future__ import annotations

from collections.abc import Iterable

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Scenario
from nonsmooth.parameters import from_words, rules
from nonsmooth.plugins import registry


def assignments(words: Iterable[str]) -> dict[str, str]:
    """Cut ``name=value`` words.

    Raises
    ------
    InvalidInput
        If a word has another form, or a name comes twice.
    """
    values: dict[str, str] = {}
    for word in words:
        name, equals, value = (part.strip() for part in word.partition("="))
        if not (name and equals and value):
            raise InvalidInput("--set", "must have the form name=value", word, "For example --set t_end=2.")
        if name in values:
            raise InvalidInput(f"--set {name}", "must come once", f"{values[name]} and {value}", "Leave one out.")
        values[name] = value
    return values


def scenario(name: str, words: Iterable[str]) -> Scenario:
    """Return the scenario of that name with the parameters set.

    Raises
    ------
    InvalidInput
        If a name or a value is wrong, or a value is missing.
    PluginError
        If the scenario cannot be loaded.
    """
    owner = registry.load("scenarios", name)
    values = from_words(owner, assignments(words), name)
    for parameter, (field, rule) in rules(owner).items():
        if field.default is field.default_factory and parameter not in values:  # both MISSING
            raise InvalidInput(
                f"{name}.{parameter}", "must be given", None, f"Add --set {parameter}=VALUE, in [{rule.unit}]."
            )
    made: Scenario = owner(**values)
    return made
