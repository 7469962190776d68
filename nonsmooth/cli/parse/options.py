"""Options of commands, made from the parameters of Python functions, so that name, default and help are the same."""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from types import NoneType
from typing import Any, NoReturn, final

from nonsmooth.cli.docstrings import described_parameters

_KINDS: Mapping[str, tuple[Callable[[str], Any], str]] = {
    "float": (float, "X"),
    "int": (int, "N"),
    "str": (str, "NAME"),
}
"""Annotation of a parameter -> function that converts the text of a value, and placeholder of the value in the help."""
_SHAPE = re.compile(r",? shape \[[^]]*\]")
"""Shape of an array in a docstring. The help omits it, because a value on the command line has no shape."""


@final
@dataclass(frozen=True)
class Option:
    """An option of a command, or a positional argument.

    Attributes
    ----------
    name : str
        Name as in "--at" for an option, or "scenario" for a positional argument.
    text : str
        Help of the option.
    default : object
        Value if the user leaves the option out.
    metavar : str
        Placeholder of the value in the help.
    kind : callable or None
        Conversion of the value by the parser; None for a flag, which has no value.
    repeats, is_required : bool
        Whether the option may be given several times, and whether it must be given.
    choices : tuple of str
        Allowed values; empty if any value is allowed.
    convert : callable, optional
        Second conversion, from the parsed value to the argument of the function; it may raise InvalidInput.
    source : tuple, optional
        The function and the name of its parameter that the option sets.
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
        """Return the option for a parameter of a function: type and default of its signature, help of its docstring.

        Parameters
        ----------
        function : callable
            A function or class with a numpy docstring.
        parameter : str
            Name of the parameter.
        name : str
            Name of the option; by default the name of the parameter.
        form : str
            Form of the value, for the help, if the user does not give a plain number or text.
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
        """Name of the attribute of the parsed arguments that holds the option's value: "t_end" for "--t-end"."""
        return self.name.removeprefix("--").replace("-", "_")

    @property
    def stored_kinds(self) -> tuple[type, ...]:
        """Types that the option's value may have in a request that is read from a folder of results."""
        if self.repeats:
            return (list,)
        number = {float: (int, float), int: (int,)}.get(self.kind, (str,)) if isinstance(self.kind, type) else (str,)
        return number if self.is_required or self.default is not None else (*number, NoneType)

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Add the option to a parser."""
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
    """Return a flag: an option without a value, false by default."""
    return Option(name, text, False, kind=None)


def given(function: Callable[..., Any], options: Iterable[Option], arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments for a function, by parameter, from those options of a parsed request that belong to it.

    Raises
    ------
    InvalidInput
        If the value of an option is malformed.
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
    """A command: its options, and the function that executes a request and returns True on success."""

    execute: Callable[[argparse.Namespace], bool]
    options: tuple[Option, ...]
    text: str = ""

    def fill(self, parser: argparse.ArgumentParser) -> None:
        """Add the options of the command, and the function that executes it, to a parser."""
        for option in self.options:
            option.add_to(parser)
        parser.set_defaults(execute=self.execute, refuse=partial(self._refuse, parser))

    def _refuse(self, parser: argparse.ArgumentParser, arguments: argparse.Namespace, word: str) -> NoReturn:
        """Exit with the usage of the command, because it does not understand a word of the request."""
        name = word.partition("=")[0]
        if name.startswith("-") and name.lstrip("-")[:1].isalpha():
            near = self._nearest(name)
            parser.error(f"Unknown option {name!r}." + (f" Did you mean {near!r}?" if near else ""))
        pairs = (option for option in self.options if "=" in option.metavar and option.repeats)
        halves = (
            f"{pair.name} {one}={word}" for pair in pairs for one in getattr(arguments, pair.place) if "=" not in one
        )
        meant = next((f" Did you mean '{half}'?" for half in halves), "")
        parser.error(f"Unexpected word {word!r}.{meant}")

    def _nearest(self, name: str) -> str:
        """Option that begins with ``name``, or is almost the same; "" if there is none."""
        # imported for a message only: most requests never need it
        from difflib import get_close_matches

        known = [option.name for option in self.options if option.name.startswith("--")]
        begun = [one for one in known if one.startswith(name)]
        # 0.85 finds one wrong letter of five; less finds '--count' for '--out'
        return next(iter(begun or get_close_matches(name, known, n=1, cutoff=0.85)), "")


@final
@dataclass(frozen=True)
class CommandGroup:
    """A command that has subcommands, such as ``study`` with ``study status``."""

    title: str
    metavar: str
    parts: Mapping[str, Command]

    def fill(self, parser: argparse.ArgumentParser) -> None:
        """Add the subcommands to a parser."""
        parts = parser.add_subparsers(title=self.title, required=True, metavar=self.metavar)
        for name, part in self.parts.items():
            part.fill(parts.add_parser(name, help=part.text, allow_abbrev=False))


def names(word: str) -> tuple[str, ...]:
    """Return the names of a list that is separated by commas."""
    return tuple(part.strip() for part in word.split(","))


def _word(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
