"""Calls of C functions by their addresses: functions of laws and bodies, shapes, and the interrupt check.

A law is compiled alone, to a C function. The engine reads its address from the workspace, so that a new law never
recompiles the engine.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from inspect import isfunction
from typing import Any

from numba import types
from numba.extending import intrinsic, typeof_impl

from nonsmooth.engine.native.compiler import law_dispatcher
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.numba_names import cgutils, ir, typing_context
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


call_scalar, call_compliance, call_traction, call_rates, call_guard, call_body, call_load, call_pair, call_map = (
    by_address(signature_of(FORMS[form].signature))
    for form in ("scalar", "compliance", "traction", "rates", "guard", "body", "load", "pair", "map")
)
"""Calls of a function at an address, by the name of its form."""
call_watch = by_address(types.float64(types.float64))
"""Call of the interrupt check."""


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
def _support_at(typingctx: Any, floats: Any, place: Any, x: Any, y: Any, z: Any) -> Any:
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


def support(floats: Any, place: int, x: float, y: float, z: float) -> Any:
    """Farthest point of a body [m]: the version of ``kernel.call_support`` that compiled code calls."""
    return _support_at(floats, place, x, y, z)


@typeof_impl.register(Shared)
def _type_of_shared(value: Shared, context: Any) -> Any:
    """Numba type of a `Shared`, a function that exists in a version for Python and in a version for compiled code.

    The type is that of the version for compiled code. If this version is a Python function, the type is that of a
    dispatcher, which compiles it at the first call. If this version is an intrinsic, numba knows its type.
    """
    half = globals()[value.compiled] if value.compiled else value.function
    return types.Dispatcher(_dispatcher(half)) if isfunction(half) else typing_context.resolve_value_type(half)


@functools.cache
def _dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's dispatcher of a function that compiled functions of plug-ins call. It is made once for each function."""
    return law_dispatcher(function)
