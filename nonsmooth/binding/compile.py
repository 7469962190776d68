"""Make a C function, which the engine calls by its address, from a Python function with named parameters."""

from __future__ import annotations

import dis
import functools
import inspect
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding import interpreted
from nonsmooth.binding.fingerprint import fingerprint
from nonsmooth.binding.refusal import Refusal, refusal
from nonsmooth.binding.source import described, name_of, place_of
from nonsmooth.engine.native import kernel
from nonsmooth.engine.native.forms import FORMS, Form
from nonsmooth.engine.native.kernel import PLAIN, address_of, at, jit
from nonsmooth.errors import RunsInPython
from nonsmooth.parameters import SharedNumbers, Value, not_offered

_SHIM = "def shim({arguments}):\n {call}\n{ending}"
_GUARDED_SHIM = "def shim({arguments}):\n try: {call}\n except Exception: {failure}\n{ending}"
"""Text of a shim, a C function around a Python function, for a function that may raise an exception.

An exception cannot pass through the compiled engine, so the shim returns NaN instead.

Compiling this guard takes as long as compiling the function. So functions that cannot raise get ``_SHIM``.
"""
_PYTHON_SHIM = """def shim({arguments}):
 try: {call}
 except (Exception, SystemExit) as error:
  note(error)
  {failure}
{interruption}{ending}"""
_INTERRUPTION = """ except KeyboardInterrupt:
  if not hold(): return shim({arguments})
  {failure}
"""
"""Part of a shim that handles Ctrl-C, because a KeyboardInterrupt cannot pass through the compiled engine.

The first Ctrl-C is stored until the engine can stop, and the call is repeated. A second one makes the call fail.
"""


class _Entry(NamedTuple):
    """How the engine calls a function: the address, and for a function that runs in Python two more fields.

    ``refusal`` is the reason why the function is not compiled. ``shim`` is the Python function at the address.
    """

    address: int
    refusal: Refusal | None = None
    shim: Callable[..., Any] | None = None


@functools.cache
def parameter_names(function: Callable[..., Any], form: str) -> tuple[str, ...]:
    """Names of a function's parameters, in order, without the first arguments, which its form prescribes."""
    return tuple(inspect.signature(function).parameters)[len(FORMS[form].roles) :]


def bind(
    function: Callable[..., Any], form: str, values: Mapping[str, Value], owner: str
) -> tuple[int, tuple[float, ...]]:
    """Address of a function, and the block of its parameters, whose values are found in ``values`` by name.

    A function that cannot be compiled runs in Python. A warning gives the reason, once.

    Parameters
    ----------
    function : callable
        A plain function. The form prescribes its first arguments; the arguments after them are its parameters.
    form : str
        One of :data:`nonsmooth.engine.native.forms.FORMS`.
    values : mapping of str to float, tuple of float or SharedNumbers
        Values by parameter name, such as fields of a law or the gravity. The function gets tuples and tables as blocks.
    owner : str
        The law, for messages.

    Returns
    -------
    tuple of int and tuple of float
        The address, and the block of parameters: places for the recorded arguments, then one number for each
        parameter, in the order of the signature, then the tuples. The number of a tuple is its position in the block.

    Raises
    ------
    UnknownName
        If the function has a parameter without a value.
    """
    names = parameter_names(function, form)
    for name in names:
        if name not in values:
            raise not_offered(f"{owner}: {described(function)},", name, values)
    vectors = _vectors(values, names)
    first = FORMS[form].n_recorded
    heap: list[float] = [math.nan] * first + [0.0] * len(names)
    for i, name in enumerate(names, start=first):
        value = values[name]
        if isinstance(value, SharedNumbers):
            heap[i] = float(len(heap))
            heap += value.numbers.tolist()
        elif isinstance(value, tuple):
            heap[i] = float(len(heap))
            heap += [float(x) for x in value]
        else:
            heap[i] = float(value)
    entry = _entry(function, form, vectors)
    if entry.refusal is not None and entry.shim is not None and entry.address not in _warned:
        _warned.add(entry.address)
        _warn(function, owner, entry.refusal, interpreted.cost(entry.shim, form, tuple(heap)))
    return entry.address, tuple(heap)


def address_alone(function: Callable[..., Any], form: str, values: Mapping[str, Value], owner: str) -> int:
    """Address of a function that reads the block of parameters of another one, as :func:`bind` gives it."""
    entry = _entry(function, form, _vectors(values, parameter_names(function, form)))
    # the warning of a function that runs in Python tells its cost, for which the block is needed
    return entry.address if entry.refusal is None else bind(function, form, values, owner)[0]


def _vectors(values: Mapping[str, Value], names: tuple[str, ...]) -> tuple[bool, ...]:
    return tuple(isinstance(values[name], (tuple, SharedNumbers)) for name in names)


def refused(function: Callable[..., Any], form: str) -> Refusal | None:
    """Reason why a function whose parameters are numbers cannot be compiled; None if it can."""
    return _entry(function, form, (False,) * len(parameter_names(function, form))).refusal


def bind_in_python(
    function: Callable[..., Any], form: str, owner: str, method: Callable[..., Any], why: Refusal
) -> tuple[int, tuple[float, ...]]:
    """Address and block of parameters of a function that runs in Python, because it calls the Python method ``method``.

    The block is empty. A warning names the method and the reason ``why`` it cannot be compiled.
    """
    shim = _shim_in_python(function, form, ())
    address = interpreted.address(shim, form)
    _warn(method, owner, why, interpreted.cost(shim, form, ()))
    return address, ()


def vector_place(function: Callable[..., Any], form: str, heap: Sequence[float], name: str) -> int:
    """Position, in the block ``heap`` of a function's parameters, of the first number of the tuple ``name``."""
    return int(heap[parameter_place(function, form, name)])


def parameter_place(function: Callable[..., Any], form: str, name: str) -> int:
    """Index of a parameter's value in the block of numbers that :func:`bind` returns for the function."""
    return FORMS[form].n_recorded + parameter_names(function, form).index(name)


_warned: set[int] = set()


def _warn(function: Callable[..., Any], owner: str, why: Refusal, cost: str) -> None:
    file, line = place_of(function)
    warnings.warn_explicit(
        f"{owner}: {described(function)}, runs in Python, as numba cannot compile {why.describe(file)}. {cost}. "
        "Numbers, tuples, math, branches, loops and functions under @compiled can be compiled.",
        RunsInPython,
        file or name_of(function),
        line,
    )


@functools.cache
def _entry(function: Callable[..., Any], form: str, vectors: tuple[bool, ...]) -> _Entry:
    if PLAIN:
        return _Entry(address_of(lambda: _shim_in_python(function, form, vectors), form, ""))
    text = (_GUARDED_SHIM if _may_raise(function) else _SHIM).format(**_parts(form, vectors))
    try:
        key = fingerprint(function, form + text)
        return _Entry(address_of(lambda: _made(text, {"law": jit(function), "at": at}), form, key))
    except Exception as error:  # the compiler's errors have no base of their own
        shim = _shim_in_python(function, form, vectors)
        return _Entry(interpreted.address(shim, form), refusal(function, error), shim)


def _shim_in_python(function: Callable[..., Any], form: str, vectors: tuple[bool, ...]) -> Callable[..., Any]:
    parts = _parts(form, vectors)
    scope = {
        "law": interpreted.in_python(function, interpreted.move),
        "at": interpreted.move,
        "note": functools.partial(interpreted.note, function),
        "hold": interpreted.hold,
    }
    return _made(_PYTHON_SHIM.format(**parts, interruption="" if PLAIN else _INTERRUPTION.format(**parts)), scope)


def _parts(form: str, vectors: tuple[bool, ...]) -> dict[str, str]:
    """Texts that complete the template of a shim, by name.

    "arguments" are those of the shim, and "call" is its call of the function. "failure" sets the result after an
    exception. "ending" are the lines after the call, which store arguments and return the result.
    """
    its = FORMS[form]
    item = "at(p, {0} * n)" if form == "map" else "p[{0}]"
    items = ["at(p, int(p[{0}]))" if vector else item for vector in vectors]
    unpacked = [text.format(i) for i, text in enumerate(items, start=its.n_recorded)]
    call = f"law({', '.join([*its.roles, *unpacked])})"
    return {
        "arguments": ", ".join(its.arguments),
        "call": f"v = float({call})" if its.returns else call,
        "failure": "v = nan" if its.returns else "out[0] = nan",
        "ending": _record(its) + (" return v\n" if its.returns else ""),
    }


def _record(form: Form) -> str:
    """Lines of a shim that store the arguments for which a law gives no finite value.

    They are stored in front of the parameters of the law, where a message reads them.
    """
    if not form.recorded:
        return ""
    value = "" if form.returns else f" v = {' + '.join(f'out[{i}]' for i in range(form.watched))}\n"
    numbers = [
        f"{name}[{i}]" if form.given[name] == "F" else name for name, n in form.recorded.items() for i in range(n)
    ]
    stores = "".join(f"   p[{i}] = {number}\n" for i, number in enumerate(numbers))
    return f"{value} if v - v != 0.0:\n  s = {' + '.join(numbers)}\n  if s - s == 0.0:\n{stores}"


def in_python(
    function: Callable[..., Any], form: str, values: Mapping[str, Value], move: Callable[..., Any]
) -> Callable[..., Any]:
    """Python function that has the arguments of ``form`` and calls a law's or body's function without compilation.

    An exception of the function passes through, so that a message can name it. In compiled code, the function moves
    pointers by ``at``. Here it calls ``move(block, offset)``, which returns the block from the float ``offset`` on.
    """
    vectors = _vectors(values, parameter_names(function, form))
    scope = {"law": interpreted.in_python(function, move), "at": move}
    return _made(_SHIM.format(**_parts(form, vectors) | {"ending": ""}), scope)


def _made(text: str, scope: dict[str, Any]) -> Callable[..., Any]:
    scope |= {"__name__": __name__, "nan": math.nan}
    exec(text, scope)  # the shim's text is ours, never the user's
    shim: Callable[..., Any] = scope["shim"]
    return shim


_RAISING = ("RAISE_VARARGS", "BUILD_LIST", "BUILD_MAP", "BUILD_SET")
"""Bytecode instructions by which a function is taken as one that may raise an exception.

They are those of ``raise``, and of the making of a list, dict or set: a later access to the container may use an index
or a key that is missing.
"""


def _may_raise(function: Callable[..., Any]) -> bool:
    """True if a function may raise an exception.

    This includes the functions that it calls, directly or through other functions.
    """
    waiting, seen = [inspect.unwrap(function)], set()
    while waiting:
        one = waiting.pop()
        if not inspect.isfunction(one) or one in seen:
            continue
        seen.add(one)
        closure = inspect.getclosurevars(one)
        named = (*closure.globals.values(), *closure.nonlocals.values())
        # an index into a tuple may be out of its range
        if any(_is_table(value) for value in (*named, *one.__code__.co_consts)) or any(
            instruction.opname in _RAISING for instruction in dis.get_instructions(one)
        ):
            return True
        waiting += [inspect.unwrap(value) for value in named if callable(value)]
    return False


def _is_table(value: Any) -> bool:
    """True if a value is a tuple in which a function may look up numbers by an index, which may be out of range.

    A tuple that contains nothing but strings is excluded: Python stores names of arguments in such tuples.
    """
    return type(value) is tuple and any(not isinstance(item, str) for item in value)


def evaluate(address: int, parameters: tuple[float, ...], x: float) -> float:
    """Call the function of a single number that is at ``address``; return its value at ``x``.

    ``parameters`` is its block of parameters, which :func:`bind` returned together with the address.
    """
    return float(caller("scalar", address, np.array(parameters, dtype=float))(x))


def caller(form: str, address: int, numbers: NDArray[np.float64]) -> Callable[..., Any]:
    """A Python function that calls a function as the engine does, with numbers and contiguous arrays of floats.

    Lengths are not checked.

    Parameters
    ----------
    form : str
        One of :data:`nonsmooth.engine.native.forms.FORMS`.
    address : int
        Address of the function, from :func:`bind`.
    numbers : array
        Block of its parameters, from :func:`bind`. It must not be empty: append an unused number.
    """
    n_given = len(FORMS[form].given)
    if PLAIN:
        plain = getattr(kernel, f"call_{form}")
        return lambda *given: plain(address, *given[:n_given], numbers, *given[n_given:])
    native, parameters = FORMS[form].prototype()(address), numbers.ctypes.data

    def call(*given: Any, _kept: Any = numbers) -> Any:
        values = [one.ctypes.data if isinstance(one, np.ndarray) else one for one in given]
        return native(*values[:n_given], parameters, *values[n_given:])

    return call
