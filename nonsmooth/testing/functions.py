"""What holds of every function that the engine calls: it comes back, with finite numbers, compiled as plain."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.parameters import not_offered
from nonsmooth.testing.budget import Call, OutOfTime, make_all, where
from nonsmooth.testing.examine import described
from nonsmooth.testing.property import Broken, NotChecked, Row

ROOM = 4
"""Numbers behind what a function is to write."""
OLD = 7.0e3
"""What stands there, and must stay."""
_SAME = 1e-9


@final
@dataclass(frozen=True)
class Function:
    """A function of a component with inputs to try.

    Attributes
    ----------
    owner : object
        The component.
    name : str
        What the interface calls it.
    function : callable
        The function.
    form : str
        Its form (:data:`nonsmooth.engine.native.forms.FORMS`).
    offered : mapping
        The parameters that it may ask for.
    plain, compiled : callable
        Take one of the inputs, return a number or an array; ``compiled`` is made first, from no arguments.
    inputs : sequence
        The inputs, each with words for it.
    """

    owner: Any
    name: str
    function: Callable[..., Any]
    form: str
    offered: Mapping[str, Any]
    plain: Callable[[Any], Any]
    compiled: Callable[[], Callable[[Any], Any]]
    inputs: Sequence[tuple[str, Any]]

    @property
    def title(self) -> str:
        """Return component and name."""
        return f"{type(self.owner).__name__}.{self.name}"


class Functions:
    """The functions of a component, looked at once, before anything else runs them.

    The compiled ones cannot be stopped, so nothing else is looked at where a plain one does not come back.
    """

    def __init__(self, functions: Callable[[], Sequence[Function]]) -> None:
        self._make = functions

    @cached_property
    def all(self) -> Sequence[Function]:
        """The functions."""
        return self._make()

    @cached_property
    def _faults(self) -> dict[str, Broken]:
        for name, look in _STAGES.items():
            for function in self.all:
                try:
                    look(function)
                except Broken as fault:
                    return {name: fault}
        return {}

    def check(self, name: str) -> None:
        """Raise what was found under a name; the others were not looked at then."""
        if name in self._faults:
            raise self._faults[name]
        self.sound(but=name)

    def sound(self, but: str = "") -> None:
        """Raise NotChecked if a function is not fit to be run."""
        order = list(_STAGES)
        for name, fault in self._faults.items():
            if but not in order or order.index(name) < order.index(but):
                raise NotChecked(f"not checked, as {name!r} does not hold: {fault.reason}") from fault

    def guarded(self, rows: list[Row]) -> list[Row]:
        """Return properties that are looked at only if the functions are fit to be run."""

        def behind(name: str, check: Callable[[], None]) -> Callable[[], None]:
            def run() -> None:
                self.check(name)
                entry_addresses()
                check()

            return run

        return [(name, says, behind(name, check)) for name, says, check in rows]

    def rows(self) -> list[Row]:
        """Return the properties of the functions."""
        return [
            (
                "known parameters",
                "its functions ask for parameters that it offers",
                lambda: self.check("known parameters"),
            ),
            (
                "time budget",
                "its functions come back within a second, in plain Python",
                lambda: self.check("time budget"),
            ),
            (
                "finite numbers",
                "its functions return finite numbers and raise nothing",
                lambda: self.check("finite numbers"),
            ),
            *self.guarded(
                [
                    ("compiled equals plain", "compiled, its functions return the same numbers", self._same_compiled),
                    ("determinism", "its functions return the same whenever they are called", self._repeatable),
                ]
            ),
        ]

    def _same_compiled(self) -> None:
        for function in self.all:
            compiled = function.compiled()
            for words, value in function.inputs:
                one, other = np.asarray(function.plain(value)), np.asarray(compiled(value))
                size = float(np.max(np.abs(one), initial=0.0))
                if not np.allclose(other, one, rtol=_SAME, atol=_SAME * size):
                    raise Broken(
                        f"{function.title}({words}) is {_short(one)} plain and {_short(other)} compiled",
                        *described(function.owner),
                    )

    def _repeatable(self) -> None:
        for function in self.all:
            one, other = (dict(function.owner.parameters()) for _ in range(2))
            if one != other:
                raise Broken(f"its parameters are {one} first and {other} later", "parameters()", other)
            first = [np.array(function.plain(value)) for _, value in function.inputs]
            for (words, value), once in reversed(list(zip(function.inputs, first, strict=True))):
                again = np.asarray(function.plain(value))
                if not np.array_equal(again, once):
                    raise Broken(
                        f"{function.title}({words}) is {_short(once)} first and {_short(again)} later",
                        *described(function.owner),
                    )


def _short(value: Any) -> str:
    array = np.asarray(value)
    return f"{float(array):.9g}" if array.ndim == 0 else np.array2string(array, precision=6, threshold=8)


def _names(function: Function) -> None:
    for name in parameter_names(function.function, function.form):
        if name not in function.offered:
            error = not_offered(function.title, name, function.offered)
            raise Broken(f"{where(function.function)}: {error}".rstrip("."), name, "not offered")


def _calls(function: Function) -> list[Call]:
    return [
        Call(f"{function.title}({words})", function.function, lambda value=value: function.plain(value))  # type: ignore[misc]
        for words, value in function.inputs
    ]


def _time(function: Function) -> None:
    try:
        make_all(_calls(function))
    except OutOfTime as slow:
        raise Broken(str(slow), *described(function.owner)) from None
    except Exception:
        return  # what it raises is the business of the next property


def _finite(function: Function) -> None:
    for words, value in function.inputs:
        title = f"{function.title}({words})"
        try:
            result = function.plain(value)
        except Exception as error:
            line = _raised_at(error)
            raise Broken(
                f"{title} raises {type(error).__name__}: {error}, in {where(function.function)}{line}",
                *described(function.owner),
            ) from error
        # what is written comes as an array
        kinds = (int, float) if FORMS[function.form].returns else (np.ndarray,)
        if isinstance(result, bool) or not isinstance(result, kinds):
            cause = " (a power of a negative number)" if isinstance(result, complex) else ""
            raise Broken(
                f"{title} returns {result!r}{cause}, in {where(function.function)}, and not one number",
                *described(function.owner),
            )
        if not np.all(np.isfinite(result)):
            raise Broken(f"{title} is {_short(result)}, in {where(function.function)}", *described(function.owner))


def _inside(function: Function) -> None:
    for words, value in function.inputs if not FORMS[function.form].returns else ():
        if np.any(np.asarray(function.plain(value))[-ROOM:] != OLD):
            raise Broken(f"{function.title}({words}) writes beyond its block", *described(function.owner))


_STAGES: dict[str, Callable[[Function], None]] = {
    "known parameters": _names,
    "time budget": _time,
    "finite numbers": _finite,
    "writes its block": _inside,
}
"""What is looked at first, in this order; the rest only if all of it holds."""


def _raised_at(error: Exception) -> str:
    trace, line = error.__traceback__, 0
    while trace is not None:
        line, trace = trace.tb_lineno, trace.tb_next
    return f", at line {line}" if line else ""


def scalar_function(
    owner: Any, name: str, function: Callable[..., Any], values: Sequence[float], offered: Mapping[str, Any]
) -> Function:
    """Return a function of one number with numbers to try."""
    from nonsmooth.testing.callers import compiled_caller, plain_caller

    def plain(x: float) -> Any:
        return plain_caller(function, "scalar", offered)(x)

    def compiled() -> Callable[[float], Any]:
        return compiled_caller(function, "scalar", offered, type(owner).__name__)

    inputs = [(f"{x:g}", x) for x in values if math.isfinite(x)]
    return Function(owner, name, function, "scalar", offered, plain, compiled, inputs)
