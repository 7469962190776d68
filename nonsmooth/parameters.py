"""Typed, unit-carrying parameters of components: declared once, checked, described, printed."""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, final, get_origin, get_type_hints
from weakref import WeakKeyDictionary

import numpy as np

from nonsmooth.errors import InvalidInput, MissingArgument, NonsmoothWarning, UnknownName
from nonsmooth.notices import warn
from nonsmooth.readable import Readable


class UnusualValue(NonsmoothWarning):
    """A parameter that is allowed, but of an order of magnitude that suggests a wrong unit."""


@dataclass(frozen=True)
class Rule:
    """Description, unit and range of one parameter.

    Attributes
    ----------
    doc : str
        Description of the parameter in one line.
    unit : str
        SI unit, "1" for a pure number, "" for a name.
    minimum, maximum : float
        Bounds of the allowed range, which belong to it.
    above : float
        Lower bound of the allowed range, which does not belong to it.
    usual : tuple of float
        Range outside of which a warning asks whether the unit is right.
    choices : tuple of str
        Allowed words.
    assumed : bool
        True if the source does not give the value, so that we chose it.
    law : str
        "normal", "friction" or "impact" if a scenario's parameter is only passed on to that law.  It would be ignored
        if a user puts another law in its place.
    integer : bool
        True if the number must be an integer.  The component gets a Python int, also from 3.0.
    """

    doc: str
    unit: str = "1"
    minimum: float = -math.inf
    maximum: float = math.inf
    above: float = -math.inf
    usual: tuple[float, float] = (0.0, math.inf)
    choices: tuple[str, ...] = ()
    assumed: bool = False
    law: str = ""
    integer: bool = False

    def describe(self) -> str:
        """Allowed range in words."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        parts = []
        if self.above > -math.inf:
            parts.append(f"> {self.above:g}")
        if self.minimum > -math.inf:
            parts.append(f">= {self.minimum:g}")
        if self.maximum < math.inf:
            parts.append(f"<= {self.maximum:g}")
        bounds = " and ".join(parts)
        if self.integer:
            return f"an integer {bounds}".rstrip()
        return bounds or "any finite number"


def parameter(default: Any = dataclasses.MISSING, *, doc: str, unit: str = "1", **rule: Any) -> Any:
    """Declare a dataclass field as a parameter; see :class:`Rule` for the keywords."""
    return dataclasses.field(default=default, metadata={"rule": Rule(doc, unit, **rule)})


Rules: TypeAlias = Mapping[str, tuple[dataclasses.Field[Any], Rule]]
_known: WeakKeyDictionary[type, Rules] = WeakKeyDictionary()


def rules(owner: type) -> Rules:
    """Declared parameters of a component class by name."""
    # the rules of a class are stored, because each new object of the class is checked by them
    if owner not in _known:
        if not dataclasses.is_dataclass(owner):
            raise _undecorated(owner)
        found = {f.name: (f, f.metadata["rule"]) for f in dataclasses.fields(owner) if "rule" in f.metadata}
        _known[owner] = MappingProxyType(found)
    return _known[owner]


def _undecorated(owner: type) -> InvalidInput:
    """Error for a class of components that is not a dataclass."""
    remedy = f"Write @dataclass(frozen=True) above class {owner.__name__}."
    return InvalidInput(f"class {owner.__name__}", "must be a dataclass", "an ordinary class", remedy)


def not_offered(asking: str, name: str, offered: Iterable[str]) -> UnknownName:
    """Return the error for a component's function with an argument ``name`` that is not a parameter of the component.

    The usual cause is a field of the component that is declared without ``parameter(...)``. ``asking`` names the
    function at the beginning of the message; ``offered`` are the parameters that the function can have as arguments.
    """
    declared = f'{name}: float = parameter(0.2, doc="what it is")'
    remedy = f"A field of the class is a parameter if it is declared as one: {declared}."
    return UnknownName(f"{asking} asks for: parameter", name, offered, remedy=remedy)


def check_number(thing: str, value: Any, rule: Rule) -> None:
    """Raise InvalidInput unless ``value`` is a finite number within the rule; warn if it is unusual."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        remedy = f"Give it in [{rule.unit}]."
        if _is_quoted(value):
            remedy = f"It is text: take off the quotes. {remedy}"
        raise InvalidInput(thing, "must be a finite number", value, remedy)
    if value < rule.minimum or value > rule.maximum or value <= rule.above:
        raise InvalidInput(thing, f"must be {rule.describe()} [{rule.unit}]", value, f"It is the {rule.doc}.")
    if rule.integer and value != int(value):
        raise InvalidInput(thing, "must be an integer", value, f"It is the {rule.doc}.")
    low, high = rule.usual
    if value != 0.0 and not low <= abs(value) <= high:
        warn(
            f"{thing} = {value:g} [{rule.unit}] is outside the usual range {low:g} to {high:g}. "
            "Units are SI: is the order of magnitude meant?",
            UnusualValue,
        )


def _is_quoted(value: Any) -> bool:
    """True if a value is the text of a finite number, as of a number in quotes in a file."""
    try:
        return isinstance(value, str) and math.isfinite(float(value))
    except ValueError:
        return False


@final
class SharedNumbers(Sequence[float]):
    """Many numbers, of which the engine has one copy for all contacts with the same object.

    Parameters
    ----------
    numbers : array_like
        The numbers; a copy of them is kept.
    """

    def __init__(self, numbers: Any) -> None:
        self.numbers = np.array(numbers, dtype=float)
        self.numbers.flags.writeable = False

    def __len__(self) -> int:
        return len(self.numbers)

    def __getitem__(self, place: Any) -> Any:
        found = self.numbers[place]
        return found if isinstance(place, slice) else float(found)

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, SharedNumbers) and np.array_equal(self.numbers, other.numbers))

    def __hash__(self) -> int:
        return hash((len(self), self.numbers[:8].tobytes()))

    def __repr__(self) -> str:
        return f"SharedNumbers({len(self)} numbers, checksum {zlib.crc32(self.numbers.tobytes()):08x})"


Value: TypeAlias = float | tuple[float, ...] | SharedNumbers
"""A parameter of a compiled function."""


class _Checked(Readable):
    """Metaclass of components: a missing or unknown argument raises an error of nonsmooth that names the argument.

    The error is UnknownName or MissingArgument instead of Python's TypeError.
    """

    # editors and type checkers are to see the arguments of the constructor
    if not TYPE_CHECKING:

        def __call__(cls, *given: Any, **named: Any) -> Any:  # noqa: N805 -- the object is a class
            # the decorator replaces the fields by their defaults, so a field that is left shows that it is missing
            if "__dataclass_fields__" not in vars(cls) and any(
                isinstance(one, dataclasses.Field) for one in vars(cls).values()
            ):
                raise _undecorated(cls)
            try:
                return super().__call__(*given, **named)
            except TypeError:
                _check_arguments(cls, given, named)
                raise


_DESCRIBED = re.compile(r"^([\w, ]+) : ", re.MULTILINE)
"""Line of a docstring that begins the description of one or several fields."""


def _documented(owner: type) -> str | None:
    """Docstring of a component class, extended by a section on the declared parameters that the docstring omits."""
    text = inspect.cleandoc(owner.__doc__ or "")
    described = {name for names in _DESCRIBED.findall(text) for name in names.split(", ")}
    fields = {name: value.metadata for name, value in vars(owner).items() if isinstance(value, dataclasses.Field)}
    lines = [
        f"{name} : {owner.__annotations__[name]}\n    {_with_unit(metadata['rule'])}, {metadata['rule'].describe()}"
        for name, metadata in fields.items()
        if "rule" in metadata and name not in described
    ]
    return "\n".join([text, "", "Parameters", "----------", *lines]) if lines else owner.__doc__


def _check_static(owner: type) -> None:
    """Raise InvalidInput if a class defines a function that the engine calls as a method: it would get the object."""
    for name, value in vars(owner).items():
        if inspect.isfunction(value) and any(_returns_function(vars(base).get(name)) for base in owner.__mro__[1:]):
            signature = inspect.signature(value)
            also = (
                ", and remove `self`: parameters of the class are arguments" if "self" in signature.parameters else ""
            )
            remedy = f"Add @staticmethod above {name}{also}."
            written = f"def {name}({', '.join(signature.parameters)})"
            raise InvalidInput(f"{owner.__name__}.{name}", "must be a static method", written, remedy)


def _returns_function(declared: Any) -> bool:
    """True for a property of an interface whose value is a function, such as ``FrictionLaw.coefficient``."""
    return isinstance(declared, property) and "Callable" in str(declared.fget.__annotations__.get("return"))


def _with_unit(rule: Rule) -> str:
    """Description of a parameter, with the unit of a number."""
    return f"{rule.doc} [{rule.unit}]" if rule.unit else rule.doc


def _check_arguments(owner: type, given: Sequence[Any], named: Mapping[str, Any]) -> None:
    """Check the arguments of the constructor of the dataclass ``owner``; do nothing for other classes.

    Raises
    ------
    UnknownName
        A named argument is unknown to the constructor.
    MissingArgument
        A required argument is missing.
    """
    if not dataclasses.is_dataclass(owner):
        return
    fields = {field.name: field for field in dataclasses.fields(owner) if field.init}
    for name in named:
        if name not in fields:
            raise UnknownName(f"parameter of {owner.__name__}", name, fields)
    known = rules(owner)
    for name, field in list(fields.items())[len(given) :]:
        is_required = field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
        if is_required and name not in named:
            doc = f" It is the {_with_unit(known[name][1])}." if name in known else ""
            raise MissingArgument(f"{owner.__name__}.{name}", f"Write {owner.__name__}({name}=...).{doc}")


class Component(metaclass=_Checked):
    """Base of everything that has parameters: checks them when it is made.

    ``departures`` names properties of the conformance kit (:mod:`nonsmooth.testing`) that a class is known not to have,
    each with the reason.
    """

    departures: ClassVar[Mapping[str, str]] = MappingProxyType({})

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        _check_static(cls)
        cls.__doc__ = _documented(cls)

    def __post_init__(self) -> None:
        for name, (field, rule) in rules(type(self)).items():
            value = getattr(self, name)
            thing = f"{type(self).__name__}.{name}"
            if value is None and field.default is None:
                continue
            if rule.choices and value not in rule.choices:
                raise UnknownName(thing, str(value), rule.choices)
            if rule.unit != "":
                check_number(thing, value, rule)
            if rule.integer:
                # a study or a file gives an integer as 3.0, but _check() and the component get an int
                object.__setattr__(self, name, int(value))
        self._check()

    def _check(self) -> None:
        """Check rules that concern several parameters; by default there are no such rules."""

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Values of fields, by name, with which ``nonsmooth check`` makes an object of the class; empty by default.

        Give fields that are not numbers or words: shapes, tensors, functions.  Required numbers get a value of their
        allowed range automatically.
        """
        return {}

    def parameters(self) -> Mapping[str, Value]:
        """Parameters that the component's compiled functions may take, by name."""
        return self.numbers()

    def numbers(self) -> dict[str, float]:
        """Declared numbers by name."""
        numbers = {}
        for name, (_, rule) in rules(type(self)).items():
            if rule.unit != "" and getattr(self, name) is not None:
                numbers[name] = float(getattr(self, name))
        return numbers


_ROLES = ("normal", "friction", "impact")
"""Roles of the laws of a contact."""


def _as_law(role: str, word: str) -> str:
    """Hint for a word that may be the name of a law, but was given as the value of a parameter."""
    return f"For a law of that name, write --law {role}={word}."


def from_words(owner: type, words: Mapping[str, str], kind: str) -> dict[str, Any]:
    """Turn ``name=value`` words of the command line into parameters of ``owner``.

    Raises
    ------
    UnknownName
        If a name is not a parameter.
    InvalidInput
        If a value is not of the parameter's type.
    """
    known = rules(owner)
    hints = get_type_hints(owner)
    values: dict[str, Any] = {}
    for name, word in words.items():
        if name not in known:
            remedy = _as_law(name, word) if name in _ROLES else ""
            raise UnknownName(f"parameter of {kind}", name, known, remedy=remedy)
        rule = known[name][1]
        try:
            if get_origin(hints[name]) is tuple:
                values[name] = tuple(float(part) for part in word.split(":"))
            else:
                values[name] = word if rule.unit == "" or hints[name] is str else float(word)
        except ValueError:
            what, example = "a number", f"Give it in [{rule.unit}], for example {name}=1.0."
            if get_origin(hints[name]) is tuple:
                what, example = "numbers apart by colons", f"For example {name}=1:0:0."
            if rule.law and word.isidentifier():
                example = f"{example} {_as_law(rule.law, word)}"
            raise InvalidInput(f"{kind}.{name}", f"must be {what}", word, example) from None
    return values


def with_defaults(owner: type, values: Mapping[str, Any]) -> Any:
    """Subclass of a dataclass that has other default values for some of its fields, and the same name.

    Parameters
    ----------
    owner : type
        The dataclass. Its required fields must be in ``values`` for the subclass to be made without arguments.
    values : mapping
        New default values by the name of the field.
    """
    old = {field.name: field for field in dataclasses.fields(owner)}
    fields = {name: dataclasses.field(default=value, metadata=old[name].metadata) for name, value in values.items()}
    body = {name: getattr(owner, name) for name in ("__module__", "__qualname__", "__doc__")}
    types = {name: old[name].type for name in values}
    return dataclasses.dataclass(frozen=True)(
        type(owner)(owner.__name__, (owner,), body | {"__annotations__": types} | fields)
    )


def from_all_words(owner: type, words: Mapping[str, str], kind: str, option: str) -> Any:
    """Make an object of ``owner`` from ``name=value`` words, which must give each field that has no default.

    ``option`` shows in messages how to give a missing value, with {name} in place of the name.

    Raises
    ------
    UnknownName, InvalidInput
        As :func:`from_words`, or if a value is missing or breaks a rule of the class.
    """
    values = from_words(owner, words, kind)
    for field in dataclasses.fields(owner):
        if field.init and field.default is field.default_factory and field.name not in values:  # both MISSING
            rule = field.metadata.get("rule")
            remedy = f"Add {option.format(name=field.name)}, in [{rule.unit}]." if rule else "Only Python can give it."
            raise InvalidInput(f"{kind}.{field.name}", "must be given", None, remedy)
    return owner(**values)
