"""Calls of C functions by their addresses: functions of laws and bodies, shapes, and the interrupt check.

A law is compiled alone, to a C function. The engine reads its address from the workspace, so that a new law never
recompiles the engine.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

from numba import types
from numba.extending import intrinsic

from nonsmooth.engine.native.compiler import shim_address
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.numba_names import cgutils, ir
from nonsmooth.engine.native.shared import Shared
from nonsmooth.engine.native.signatures import signature_of
from nonsmooth.engine.native.types import FLOATS, WORD, call_at, moved


def by_address(signature: Any) -> Any:
    """Make a function ``call(address, *values)`` for kernels, which calls a C function of a signature at an address.

    It is an intrinsic: numba calls it with types where a call is compiled, and gets the signature of the call and the
    function that writes its code.
    """

    def call(typingctx: Any, address: Any, *values: Any) -> Any:
        """Signature of the call, with the address as the first argument, and the function that writes its code."""

        def lower(context: Any, builder: Any, _: Any, args: Any) -> Any:
            """Write the code of the call. Numba wants a value even from a function that returns none."""
            value = call_at(builder, args[0], context.get_value_type(signature.return_type), args[1:])
            return context.get_dummy_value() if signature.return_type is types.void else value

        return signature.return_type(types.int64, *signature.args), lower

    # numba reads the names of an intrinsic's parameters, so that `*values` alone does not do
    scope: dict[str, Any] = {"call": call}
    names = ", ".join(f"v{i}" for i in range(len(signature.args)))
    exec(f"def typed(typingctx, address, {names}): return call(typingctx, address, {names})", scope)
    return intrinsic(scope["typed"])


calls = {name: by_address(signature_of(form.signature)) for name, form in FORMS.items()}
"""Calls of a function at an address, by the name of its form."""
call_watch = by_address(types.float64(types.float64))
"""Call of the interrupt check."""


def address_of(shim: Callable[..., Any], form: str, key: str) -> int:
    """Address of a shim, which calls a plug-in's function, as a C function with the arguments of a form.

    ``form`` is the name of one of ``FORMS``, and ``key`` that of the file of machine code.
    """
    # compiled, or loaded from disk. Equal keys must mean equal functions; with an empty key nothing is kept on disk
    return shim_address(shim, signature_of(FORMS[form].signature), key)


watches: dict[int, Any] = {}
"""The C functions of interrupt checks by their addresses. Python frees those that are not listed here."""


def watch_address(function: Callable[[float], float]) -> int:
    """Address of a C function that calls an interrupt check, a Python function of time [s].

    The check returns how much work may be done until its next call, 0 to stop the run. The address is valid until
    :func:`forget_watch`.
    """
    callback = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(function)
    # an object of ctypes stores the address as its content. "or 0" is for type checkers: it is never None
    address = int(ctypes.c_void_p.from_buffer(callback).value or 0)
    watches[address] = callback
    return address


def forget_watch(address: int) -> None:
    """Release the C function of an interrupt check, whose address must not be called any more."""
    del watches[address]


@intrinsic
def at(typingctx: Any, floats: Any, offset: Any) -> Any:
    """Pointer to the number at an offset from a pointer to floats or integers, for compiled functions.

    An intrinsic: numba calls it with types, and gets the signature of the call and the function that writes its code.
    """

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        """Write the code: the pointer, moved by the offset."""
        return moved(builder, floats.kind, *args)

    return floats(floats, types.int64), codegen


@intrinsic
def _compiled_support_at(typingctx: Any, floats: Any, place: Any, x: Any, y: Any, z: Any) -> Any:
    """The farthest point of a body in a direction, for compiled functions, as a tuple [m].

    The numbers of a shape are ``floats``: the address of its support function at ``place``, then the parameters of the
    function. They may also be a tuple, which holds no function: the code is then compiled, too, but never run.

    An intrinsic: numba calls it with types, and gets the signature of the call and the function that writes its code.
    """
    # the type of the result
    point = types.UniTuple(types.float64, 3)

    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        """Write the code: store the direction, call the C function at the address, load the point that it wrote."""
        direction, found = (cgutils.alloca_once(builder, ir.DoubleType(), 3) for _ in range(2))
        for i, value in enumerate(args[2:]):
            builder.store(value, moved(builder, float, direction, WORD(i)))
            # zero for a tuple, which has no function to call
            builder.store(ir.DoubleType()(0.0), moved(builder, float, found, WORD(i)))
        if floats == FLOATS:
            # an address is stored as a float, which holds it exactly
            address = builder.load(moved(builder, float, *args[:2]), typ=ir.DoubleType())
            parameters = moved(builder, float, args[0], builder.add(args[1], WORD(1)))
            call_at(builder, builder.fptosi(address, WORD), ir.VoidType(), [direction, parameters, found])
        values = [builder.load(moved(builder, float, found, WORD(i)), typ=ir.DoubleType()) for i in range(3)]
        return context.make_tuple(builder, point, values)

    return point(floats, types.int64, types.float64, types.float64, types.float64), lower


def _compiled_support(floats: Any, place: int, x: float, y: float, z: float) -> Any:
    """Compiled half of :func:`call_support`. `Shared` compiles functions, so the intrinsic is called by one."""
    return _compiled_support_at(floats, place, x, y, z)


def _support(floats: Any, place: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Farthest point of a body in the direction (x, y, z) [m], by a C function whose address is ``floats[place]``.

    The parameters of the function follow its address. This is the half of :func:`call_support` that Python calls.
    """
    # copies as C arrays, since floats may be any sequence: of the parameters, with one unused number behind them, and
    # of the direction. The function writes the point to its last argument
    parameters = (ctypes.c_double * (len(floats) - place))(*floats[place + 1 :])
    direction, found = (ctypes.c_double * 3)(x, y, z), (ctypes.c_double * 3)()
    FORMS["support"].prototype()(int(floats[place]))(direction, parameters, found)
    return found[0], found[1], found[2]


call_support = Shared(_support, _compiled_support)


def _compiled_block(block: Any, place: int) -> Any:
    """Compiled half of :func:`block_at`: pointer to the numbers of a plug-in's table from a position on."""
    return at(block, place)


def _block(block: Any, place: int) -> Any:
    """Python half of :func:`block_at`: the numbers of a plug-in's table from a position on."""
    return block[place:]


block_at = Shared(_block, _compiled_block)
