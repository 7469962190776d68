"""Conformance checks of functions that the engine calls: time, finite numbers, the same results if compiled."""

from __future__ import annotations

import functools
import inspect
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, final

import numpy as np

from nonsmooth.binding.compile import bind, caller, parameter_names
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.kernel import PLAIN, at, entry_addresses, unshared
from nonsmooth.parameters import not_offered
from nonsmooth.testing.child import CALL, about_to
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.outcome import Broken, NotChecked, Row, described, name_of, says_of
from nonsmooth.types import Array

Caller = Callable[..., Any]
ROOM = 4
"""Number of extra floats behind a function's block, to detect writing beyond the block."""
OLD = 7.0e3
"""Value of the extra floats behind a block before a call: if it has changed after the call, the function wrote beyond
its block."""
_SAME = 1e-9
"""Largest difference of compiled and plain results that is taken as round-off, relative to their size."""


def plain_caller(function: Caller, form: str, values: Mapping[str, Any]) -> Caller:
    """Return a function in plain Python with its parameters filled in.

    The parameters of a function of the form "map" are arrays with one number per contact.
    """
    names = parameter_names(function, form)
    plain = _without_pointers(function)

    def call(*arguments: Any) -> Any:
        return plain(*arguments, **{name: values[name] for name in names})

    return call


@functools.cache
def _without_pointers(function: Caller) -> Caller:
    """Return a copy of a function in which slices of arrays replace pointers, for a call in plain Python.

    Compiled functions that are composed of several parts give each part a pointer into an array. Plain Python has no
    pointers. A function without pointers is returned unchanged.
    """
    scope = getattr(function, "__globals__", {})
    if PLAIN or not any(value is at for value in scope.values()):
        return function
    sliced = {name: _slice if value is at else value for name, value in scope.items()}
    copy = types.FunctionType(function.__code__, sliced, function.__name__, function.__defaults__, function.__closure__)
    copy.__qualname__ = function.__qualname__
    return copy


def _slice(heap: Array, offset: int) -> Array:
    return heap[offset:]


def compiled_caller(function: Caller, form: str, values: Mapping[str, Any], owner: str) -> Caller:
    """Return a compiled function with its parameters filled in; it takes numbers and contiguous arrays.

    Raises
    ------
    UnknownName
        The function has a parameter that is not among ``values``.
    PluginError
        The function cannot be compiled.
    """
    names = parameter_names(function, form)
    address, heap = bind(function, form, dict.fromkeys(values, 0.0) if form == "map" else values, owner)
    if PLAIN:
        return plain_caller(function, form, values)
    numbers = [number for name in names for number in values[name]] if form == "map" else heap
    return caller(form, address, np.array([*numbers, 0.0]))


def place_of_function(function: Caller) -> str:
    """Return name, file and line of a function."""
    code = inspect.unwrap(unshared(function)).__code__
    return f"{function.__qualname__} in {code.co_filename}, line {code.co_firstlineno}"


def written(call: Callable[[Array], Any], size: int, old: float | Array = 0.0) -> Array:
    """Return the block that a function has written, and :data:`ROOM` numbers behind it.

    Before the call the ``size`` numbers of the block are ``old``, and the numbers behind it are :data:`OLD`.
    """
    out = np.full(size + ROOM, OLD)
    out[:size] = old
    call(out)
    return out


def left_over(call: Callable[[Array], Any], other: Callable[[Array], Any], size: int, row: int = 0) -> str:
    """Return a message if ``call`` leaves a number in a block unwritten; "" if it writes all numbers.

    ``other`` writes the block for another input: a number that it wrote and ``call`` did not is found. ``row`` is the
    length of the rows of the block, 0 for a block without rows.
    """
    wrong = np.flatnonzero(written(call, size, written(other, size)[:size]) != written(call, size))
    if len(wrong) == 0:
        return ""
    place = f"{wrong[0] % row} of row {wrong[0] // row}" if row else f"{wrong[0]} of the block"
    return f"number {place} is left from the call before"


@final
@dataclass(frozen=True)
class CheckedFunction:
    """A function of a component with inputs to try.

    Attributes
    ----------
    owner : object
        The component.
    name : str
        Name of the function in the interface.
    form : str
        Form of the function (:data:`nonsmooth.engine.native.forms.FORMS`).
    offered : mapping
        Values of the parameters that the function may take by name.
    inputs : sequence
        Pairs of a text for messages and the arguments of a call.
    size : int
        Length of the block that the function writes; 0 if it returns a number.
    said : str
        Name of the function in messages; if empty, class of the component and name of the function.
    """

    owner: Any
    name: str
    form: str
    offered: Mapping[str, Any]
    inputs: Sequence[tuple[str, tuple[Any, ...]]]
    size: int = 0
    said: str = ""

    @property
    def function(self) -> Caller:
        """The function to check."""
        return getattr(self.owner, self.name)  # type: ignore[no-any-return]

    @property
    def title(self) -> str:
        """Name of the function in messages, such as ``Coulomb.coefficient``."""
        return self.said or f"{type(self.owner).__name__}.{self.name}"

    @property
    def place(self) -> str:
        """Name, file and line of the function."""
        return place_of_function(self.function)

    @property
    def calls(self) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Pairs of a call as text and its arguments."""
        return ((f"{self.title}({words})", given) for words, given in self.inputs)

    def broken(self, reason: str) -> Broken:
        """Return a fault of the function, with the parameters of its component."""
        return Broken(reason, *described(self.owner))

    def about_to_call(self, words: str, prop: str) -> None:
        """Report to the watchdog that a call begins, which may take one second.

        ``words`` is the call as text. If the call takes longer, the property named ``prop`` fails.
        """
        about_to(f"{words} {{takes}} in {self.place}", self.owner, seconds=CALL, prop=prop)

    def has_come_back(self) -> None:
        """Report to the watchdog that the call has ended. The limit for the time of a trial then applies again."""
        about_to("it {takes}", self.owner)

    def plain(self, *given: Any) -> Any:
        """Call the function in plain Python; return its number, or the block of numbers that it writes."""
        return self._result(plain_caller(self.function, self.form, self.offered), given)

    def compiled(self) -> Caller:
        """Return the compiled function. A call returns its number, or the block of numbers that the function writes."""
        call = compiled_caller(self.function, self.form, self.offered, self.title)
        return lambda *given: self._result(call, given)

    def _result(self, call: Caller, given: tuple[Any, ...]) -> Any:
        # the function gets copies of arrays, as it may write to them by mistake
        own = tuple(one.copy() if isinstance(one, np.ndarray) else one for one in given)
        if FORMS[self.form].returns:
            return call(*own)
        return written(lambda out: call(*own, out), self.size)


def scalar_function(owner: Any, name: str, values: Sequence[float], offered: Mapping[str, Any]) -> CheckedFunction:
    """Return a component's function of a single number as a function to check, with ``values`` as inputs."""
    return CheckedFunction(owner, name, "scalar", offered, [(f"{x:g}", (x,)) for x in values])


@final
@dataclass(frozen=True, eq=False)
class _Functions:
    """The functions of a component, each with checks that it must pass before the engine may call it.

    If a function fails a check, the other properties of the component are not checked, because the engine would call
    that function.
    """

    made: Callable[[], Sequence[CheckedFunction]]
    found: dict[str, Broken | None] = field(default_factory=dict)

    @cached_property
    def all(self) -> Sequence[CheckedFunction]:
        """The functions that are checked, of the component and of its variants; they are made at the first use."""
        return self.made()

    def check(self, name: str) -> None:
        """Raise the fault that the check ``name`` found; raise NotChecked if a check before it found a fault."""
        for stage, look in _STAGES.items():
            if stage not in self.found:
                self.found[stage] = self._first_fault(look)
            fault = self.found[stage]
            if fault is not None and stage == name:
                raise fault
            if fault is not None:
                raise NotChecked(f"not checked, as {stage!r} does not hold: {fault.reason}") from fault
            if stage == name:
                return

    def _first_fault(self, look: Callable[[CheckedFunction], None]) -> Broken | None:
        for function in self.all:
            try:
                look(function)
            except Broken as fault:
                return fault
        return None

    def rows(self, found: Sequence[Row]) -> list[Row]:
        """Return the properties of the functions, then the properties ``found``.

        The latter are checked only if all functions can be run.
        """
        # a check without docstring gets no row. This is the check "writes its block": the property of this name is a
        # claim of the component
        own = [
            Row(name, says_of(look), functools.partial(self.check, name))
            for name, look in _STAGES.items()
            if look.__doc__
        ]
        later = [Row(name, says_of(look), functools.partial(self._every, look)) for name, look in _LATER.items()]
        behind = [row._replace(check=functools.partial(self._behind, row)) for row in (*later, *found)]
        return [*own, *behind]

    def _every(self, look: Callable[[CheckedFunction], None]) -> None:
        for function in self.all:
            look(function)

    def _behind(self, row: Row) -> None:
        self.check(row.name)
        entry_addresses()
        row.check()


def all_rows(
    component: Any, functions: Callable[[], Sequence[CheckedFunction]], found: Sequence[Row], first: Sequence[Row] = ()
) -> list[Row]:
    """Return all properties of a component whose functions the engine calls.

    Parameters
    ----------
    component : object
        The component.
    functions : callable
        Returns the functions of the component, and of the same component with other parameters.
    found : sequence of Row
        Properties of the component that are checked only if these functions can be run.
    first : sequence of Row, optional
        Properties that are checked without a call of these functions.
    """
    return [*component_rows(component), *first, *function_rows(functions, found)]


def function_rows(functions: Callable[[], Sequence[CheckedFunction]], found: Sequence[Row]) -> list[Row]:
    """Return the checks of functions, then ``found``, which are checked only if the functions can be run."""
    return _Functions(functions).rows(found)


def _short(value: Any) -> str:
    array = np.asarray(value)
    return f"{float(array):.9g}" if array.ndim == 0 else np.array2string(array, precision=6, threshold=8)


def _known_parameters(function: CheckedFunction) -> None:
    """Functions of the component have only parameters whose values its `parameters` returns."""
    for name in parameter_names(function.function, function.form):
        if name not in function.offered:
            error = not_offered(function.title, name, function.offered)
            raise Broken(f"{function.place}: {error}".rstrip("."), name, "not offered")


def _time_budget(function: CheckedFunction) -> None:
    """Functions return within a second in plain Python."""
    for call, given in function.calls:
        function.about_to_call(call, "time budget")
        try:
            function.plain(*given)
        except Exception:
            break  # an exception does not break the time budget: the property "finite numbers" reports it
    function.has_come_back()


def _finite_numbers(function: CheckedFunction) -> None:
    """Functions return finite numbers and raise no exception."""
    for call, given in function.calls:
        try:
            result = function.plain(*given)
        except Exception as error:
            reason = f"{call} raises {type(error).__name__}: {error}, in {function.place}{_raised_at(error)}"
            raise function.broken(reason) from error
        # a function that writes its results into a block gives an array here, any other function a number
        kinds = (int, float) if FORMS[function.form].returns else (np.ndarray,)
        if isinstance(result, bool) or not isinstance(result, kinds):
            cause = " (a power of a negative number)" if isinstance(result, complex) else ""
            raise function.broken(f"{call} returns {result!r}{cause}, in {function.place}, and not one number")
        if not np.all(np.isfinite(result)):
            raise function.broken(f"{call} is {_short(result)}, in {function.place}")


def _writes_its_block(function: CheckedFunction) -> None:
    for call, given in () if FORMS[function.form].returns else function.calls:
        if np.any(np.asarray(function.plain(*given))[-ROOM:] != OLD):
            raise function.broken(f"{call} writes beyond its block")


def _compiled_equals_plain(function: CheckedFunction) -> None:
    """Compiled functions return the same numbers as in plain Python."""
    # end the time limit of the last call, as compiling may take longer than a call may
    function.has_come_back()
    compiled = function.compiled()
    for call, given in function.calls:
        one = np.asarray(function.plain(*given))
        function.about_to_call(f"compiled, {call}", "compiled equals plain")
        other = np.asarray(compiled(*given))
        if not np.allclose(other, one, rtol=_SAME, atol=_SAME * float(np.max(np.abs(one), initial=0.0))):
            raise function.broken(f"{call} is {_short(one)} plain and {_short(other)} compiled")
    function.has_come_back()


def _determinism(function: CheckedFunction) -> None:
    """Functions return the same numbers whenever they are called."""
    one, other = (dict(function.owner.parameters()) for _ in range(2))
    if one != other:
        raise Broken(f"its parameters are {one} first and {other} later", "parameters()", other)
    first = [np.array(function.plain(*given)) for _, given in function.calls]
    for (call, given), once in reversed(list(zip(function.calls, first, strict=True))):
        again = np.asarray(function.plain(*given))
        if not np.array_equal(again, once):
            raise function.broken(f"{call} is {_short(once)} first and {_short(again)} later")


def _table(*looks: Callable[[CheckedFunction], None]) -> dict[str, Callable[[CheckedFunction], None]]:
    return {name_of(look): look for look in looks}


_STAGES = _table(_known_parameters, _time_budget, _finite_numbers, _writes_its_block)
"""Checks that each function must pass first, in this order. If one fails, no other property is checked."""
_LATER = _table(_compiled_equals_plain, _determinism)
"""Further checks of functions that have passed the first checks."""


def _raised_at(error: Exception) -> str:
    trace, line = error.__traceback__, 0
    while trace is not None:
        line, trace = trace.tb_lineno, trace.tb_next
    return f", at line {line}" if line else ""
