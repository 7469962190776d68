"""Tables as YAML text and back, with the numbers and truth values of YAML 1.2: 1e-3 is a number and "no" a word."""

from __future__ import annotations

import functools
import importlib
import re
from collections.abc import Mapping
from typing import Any

from nonsmooth.errors import MissingPackagesError

_PLAIN = {
    "bool": (r"true|True|TRUE|false|False|FALSE", "tTfF"),
    "int": (r"[-+]?(?:0|[1-9][0-9]*)", "-+0123456789"),
    "float": (
        r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)",
        "-+.0123456789",
    ),
    "null": (r"null|Null|NULL|~|", ["n", "N", "~", ""]),
}
"""Pattern and first letters of values that YAML reads as other than words if they have no quotation marks, by kind."""


@functools.cache
def _yaml() -> Any:
    try:
        return importlib.import_module("yaml")
    except ImportError as error:
        raise MissingPackagesError('YAML files need PyYAML: pip install "nonsmooth[yaml]"') from error


@functools.cache
def _classes() -> tuple[Any, Any]:
    """Classes of the reader and the writer, with the plain values of YAML 1.2."""
    yaml = _yaml()
    safe_loader: Any = yaml.SafeLoader
    safe_dumper: Any = yaml.SafeDumper

    class Loader(safe_loader):  # type: ignore[misc]
        yaml_implicit_resolvers: dict[str, Any] = {}  # noqa: RUF012

        def construct_mapping(self, node: Any, deep: bool = False) -> Any:
            keys = [self.construct_object(key) for key, _ in node.value]
            for i, key in enumerate(keys):
                if not isinstance(key, str) or key in keys[:i]:
                    problem = "a key twice" if isinstance(key, str) else "a key that is no word"
                    raise yaml.constructor.ConstructorError(
                        None, None, f"{problem}: {key}", node.value[i][0].start_mark
                    )
            return super().construct_mapping(node, deep)

    class Dumper(safe_dumper):  # type: ignore[misc]
        def ignore_aliases(self, data: Any) -> bool:
            return True

    for name, (pattern, first) in _PLAIN.items():
        resolver = f"tag:yaml.org,2002:{name}", re.compile(f"(?:{pattern})$"), list(first)
        Loader.add_implicit_resolver(*resolver)
        # add to the resolvers of YAML 1.1, so that readers of both versions read each word as a word
        Dumper.add_implicit_resolver(*resolver)
    Dumper.add_representer(str, _represent)
    return Loader, Dumper


def _represent(dumper: Any, word: str) -> Any:
    # only double quotation marks escape these line breaks; in others, the reader would fold them
    style = '"' if any(letter in word for letter in "\x85\u2028\u2029") else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", word, style=style)


def tables_of(text: str) -> dict[str, Any]:
    """Tables of a text.

    Raises
    ------
    ValueError
        The text is not YAML, has a key twice, or is not a table.
    MissingPackagesError
        PyYAML is not installed.
    """
    yaml = _yaml()
    try:
        found = yaml.load(text, _classes()[0])
    except yaml.YAMLError as error:
        raise ValueError(" ".join(str(error).split())) from error
    if not isinstance(found, dict):
        raise ValueError("it is no table: write `key: value` lines")
    return found


def text_of(tables: Mapping[str, Any]) -> str:
    """YAML text from which floats are read to the last bit.

    Raises
    ------
    MissingPackagesError
        PyYAML is not installed.
    """
    text = _yaml().dump(
        dict(tables), Dumper=_classes()[1], sort_keys=False, allow_unicode=True, default_flow_style=None, width=120
    )
    return str(text)
