"""Options of commands: made from the parameters of Python functions, so that both have one name, default and help."""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import NoneType
from typing import Any, final

from nonsmooth.cli.docstrings import described_parameters

_KINDS: Mapping[str, tuple[Callable[[str], Any], str]] = {
    "float": (float, "X"),
    "int": (int, "N"),
    "str": (str, "NAME"),
}
"""Conversion and placeholder of a word by the annotation of the parameter."""
_SHAPE = re.compile(r",? shape \[[^]]*\]")
"""Shape of an array in a docstring: the command line has none."""


@final
@dataclass(frozen=True)
class Option:
    """An option of a command, or an argument by its place.

    Attributes
    ----------
    name : str
        "--at" of an option, "scenario" of an argument by its place.
    text : str
        Its help.
    default : object
        Its value if it is left out.
    metavar : str
        Placeholder of the value.
    kind : callable or None
        Conversion of the word by the parser; None for a flag.
    repeats, is_required : bool
        Whether it may come several times, and whether it must be given.
    choices : tuple of str
        Allowed words; empty for all.
    convert : callable, optional
        From the word to the argument of the function; it may raise InvalidInput.
    source : tuple, optional
        The function and its parameter.
    """

    name: str
    text: str
    default: Any = None
    metavar: str = ""
    kind: Callable[[str], Any] | None = str
    repeats: bool = False
    is_required: bool = False
    choices: tuple[str, ...] = ()
    convert: Callable[[Any], Any] | None = None
    source: tuple[Callable[..., Any], str] | None = None

    @classmethod
    def of(cls, function: Callable[..., Any], parameter: str, *, name: str = "", form: str = "", **more: Any) -> Option:
        """Return the option of a parameter of a function: type and default of its signature, help of its docstring.

        Parameters
        ----------
        function : callable
            A function or class with a numpy docstring.
        parameter : str
            Name of the parameter.
        name : str
            Name of the option, if it is another one.
        form : str
            Form of the word, if it is not a plain value.
        **more
            Further attributes: metavar, repeats, is_required, convert.
        """
        known = inspect.signature(function).parameters[parameter]
        default = None if known.default is known.empty else known.default
        kind, placeholder = _KINDS.get(str(known.annotation).partition(" |")[0], (str, "WORD"))
        text = _SHAPE.sub("", described_parameters(function)[parameter]).rstrip(".")
        parts = [text[:1].lower() + text[1:], form, "" if default is None else f"{_word(default)} by default"]
        named, text = f"--{(name or parameter).replace('_', '-')}", "; ".join(filter(None, parts))
        more = {"metavar": placeholder, "kind": str if form else kind, "source": (function, parameter)} | more
        return cls(named, text, default, **more)

    @property
    def place(self) -> str:
        """Name of its value in the parsed request."""
        return self.name.removeprefix("--").replace("-", "_")

    @property
    def stored_kinds(self) -> tuple[type, ...]:
        """Types of its value in a request that was stored."""
        if self.repeats:
            return (list,)
        number = {float: (int, float), int: (int,)}.get(self.kind, (str,)) if isinstance(self.kind, type) else (str,)
        return number if self.is_required or self.default is not None else (*number, NoneType)

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add it to a parser."""
        more: dict[str, Any] = {"help": self.text.replace("%", "%%")}
        if not self.name.startswith("--"):
            more |= {"nargs": "?"} if self.choices and not self.is_required else {}
        else:
            more["required"] = self.is_required
        if self.kind is None:
            more["action"] = "store_true"
        else:
            more |= {"type": self.kind, "default": [] if self.repeats else self.default}
            more |= {"action": "append"} if self.repeats else {}
            more |= {"choices": self.choices} if self.choices else {"metavar": self.metavar or None}
        parser.add_argument(self.name, **more)


def flag(name: str, text: str) -> Option:
    """Return an option without a value."""
    return Option(name, text, False, kind=None)


def given(function: Callable[..., Any], options: Iterable[Option], arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of a function that a request gives, by parameter.

    Raises
    ------
    InvalidInput
        If a word has another form than its option says.
    """
    found = dict[str, Any]()
    for option in options:
        if option.source is not None and option.source[0] is function:
            value = getattr(arguments, option.place)
            convert = option.convert
            found[option.source[1]] = value if convert is None or value is None else convert(value)
    return found


@final
@dataclass(frozen=True)
class Command:
    """A command: its options, and the function that executes a request and returns whether all went well."""

    execute: Callable[[argparse.Namespace], bool]
    options: tuple[Option, ...]
    text: str = ""

    def fill(self, parser: argparse.ArgumentParser) -> None:
        """Add its options to a parser."""
        for option in self.options:
            option.add_to(parser)
        parser.set_defaults(execute=self.execute)


@final
@dataclass(frozen=True)
class CommandGroup:
    """A command that consists of others, such as ``study status``."""

    title: str
    metavar: str
    parts: Mapping[str, Command]

    def fill(self, parser: argparse.ArgumentParser) -> None:
        """Add the parts to a parser."""
        parts = parser.add_subparsers(title=self.title, required=True, metavar=self.metavar)
        for name, part in self.parts.items():
            part.fill(parts.add_parser(name, help=part.text, allow_abbrev=False))


def names(word: str) -> tuple[str, ...]:
    """Return the names of a word, which commas separate."""
    return tuple(part.strip() for part in word.split(","))


def _word(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
