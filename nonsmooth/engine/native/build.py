"""How numba compiles the engine and the shims of laws; with the cache all that leans on its private parts."""

from __future__ import annotations

import contextlib
import gc
import hashlib
import itertools
import threading
from collections.abc import Callable, Iterator
from typing import Any, final

from numba.core.bytecode import FunctionIdentity
from numba.core.ccallback import CFunc
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import Compiler, CompilerBase
from numba.core.compiler_machinery import PassManager
from numba.core.dispatcher import Dispatcher
from numba.core.sigutils import normalize_signature
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.types.functions import BaseFunction
from numba.core.untyped_passes import FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

from nonsmooth.engine.native.cache import Store


@final
class EnginePasses(CompilerBase):
    """The passes of numba that the engine's plain loops need.

    Those left out rewrite closures, literals, overloads and whole arrays, which the engine has none of.
    """

    def define_pipelines(self) -> list[PassManager]:
        """Return the one list of passes."""
        passes = PassManager("engine")
        for one in (
            TranslateByteCode,
            FixupArgs,
            IRProcessing,
            ReconstructSSA,
            NopythonTypeInference,
            PreLowerStripPhis,
            IRLegalization,
            NativeLowering,
            NoPythonBackend,
        ):
            passes.add_pass(one, one.__name__)
        passes.finalize()
        return [passes]


@contextlib.contextmanager
def typed_once() -> Iterator[None]:
    """Find the type of an operation once for given types of operands: numba tries all candidates at every place."""
    find: Callable[..., Any] = BaseFunction.get_call_type
    found: dict[Any, Any] = {}

    def remember(operation: Any, context: Any, arguments: Any, keywords: Any) -> Any:
        key = operation, tuple(arguments), tuple(sorted(keywords.items()))
        if key not in found:
            found[key] = find(operation, context, arguments, keywords)
        return found[key]

    with contextlib.ExitStack() as stack:
        _replace(stack, BaseFunction, "get_call_type", remember)
        yield


def _replace(stack: contextlib.ExitStack, owner: type, name: str, value: Callable[..., Any]) -> None:
    stack.callback(setattr, owner, name, getattr(owner, name))
    setattr(owner, name, value)


_LATER = (
    (CPUCodeLibrary, "_optimize_final_module"),
    (JITCodeLibrary, "_finalize_specific"),
    (JITCPUCodegen, "_add_module"),
    (JITCPUCodegen, "set_env"),
)
"""The steps of numba that optimise a function and make machine code of it."""


class _Thread(threading.local):
    """Whether what this thread compiles stays raw: others may compile functions of their own meanwhile."""

    raw = False


_thread = _Thread()


@contextlib.contextmanager
def raw(wanted: bool = True) -> Iterator[None]:
    """Leave what is compiled inside as intermediate code: only the rooms that take it in go on with it, once each."""
    before = _thread.raw
    with contextlib.ExitStack() as stack:
        for owner, name in _LATER:
            _replace(stack, owner, name, _unless_raw(getattr(owner, name)))
        _thread.raw = wanted
        try:
            yield
        finally:
            _thread.raw = before


def _unless_raw(step: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *arguments: None if _thread.raw else step(*arguments)


@contextlib.contextmanager
def raw_inside() -> Iterator[None]:
    """Leave the functions that those compiled inside call as intermediate code: their callers take it in.

    Functions that Python can call compiled, as those of a user's own, are not left so.
    """
    compiled: Callable[..., Any] = Dispatcher.compile

    def leave_raw(dispatcher: Any, signature: Any) -> Any:
        with raw(wanted=dispatcher.targetoptions.get("no_cpython_wrapper", False)):
            return compiled(dispatcher, signature)

    with contextlib.ExitStack() as stack:
        _replace(stack, Dispatcher, "compile", leave_raw)
        yield


@contextlib.contextmanager
def uncollected() -> Iterator[None]:
    """Look for no garbage inside: the compiler makes millions of small objects that live."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


class CFunction(CFunc):
    """A C function, compiled when asked for or taken from the disk.

    Parameters
    ----------
    function : callable
        What is compiled.
    signature : numba signature
        Its types.
    store : Store, optional
        Where it is kept on disk, if it is.
    passes : type
        The passes of the compiler.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        signature: Any,
        store: Store | None,
        passes: type[CompilerBase] = Compiler,
    ) -> None:
        options = {"nopython": True, "error_model": "numpy"}
        super().__init__(function, normalize_signature(signature), locals={}, options=options, pipeline_class=passes)
        if store is not None:
            self._cache = store


@contextlib.contextmanager
def numbered(key: str) -> Iterator[None]:
    """Give the functions that are compiled inside numbers that no other process gives to other functions.

    A symbol is made of a function's name, types and number, and cached code of several processes is linked by symbols.
    """
    kept = FunctionIdentity._unique_ids
    start = int.from_bytes(hashlib.sha256(key.encode()).digest()[:6], "big")
    FunctionIdentity._unique_ids = itertools.count(start)
    try:
        yield
    finally:
        FunctionIdentity._unique_ids = kept
