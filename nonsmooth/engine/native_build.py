"""How numba compiles the engine and the shims of laws, and where it keeps them; all that leans on its private parts."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import itertools
import os
import pickle
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, final

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_name
from numba.core.bytecode import FunctionIdentity
from numba.core.caching import CacheImpl, _CacheLocator
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import PassManager
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.types.functions import BaseFunction
from numba.core.untyped_passes import FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

_PACKAGE = Path(__file__).resolve().parents[1]
KEYED = "shim-"
"""Begins what stands for the source file of a function that is cached under a key."""


def cache_folder() -> Path:
    """Return the folder of the compiled engine, named after a hash over all of its sources.

    An edit of any source file, another numba, another Python or another kind of processor gives another folder: a
    stale cache cannot be met.  Falls back to a temporary folder where the user's cache is not writable.
    """
    return _cache_folder()


@functools.cache
def _cache_folder() -> Path:
    digest = hashlib.sha256(f"{numba.__version__}{np.__version__}{sys.version}{get_host_cpu_name()}".encode())
    for folder in ("engine", "model"):
        for source in sorted((_PACKAGE / folder).glob("*.py")):
            digest.update(source.name.encode() + source.read_bytes())
    name = f"engine-{digest.hexdigest()[:16]}"
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    for root in (home / "nonsmooth", Path(tempfile.gettempdir()) / f"nonsmooth-{os.getuid()}"):
        try:
            (root / name).mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(root / name, os.W_OK):
            return root / name
    raise OSError(f"No folder for the compiled engine: neither {home} nor {tempfile.gettempdir()} can be written to.")


class _StampedLocator(_CacheLocator):
    """Keeps the engine and the shims that have a key in :func:`cache_folder`; leaves other functions alone."""

    def __init__(self, source: str) -> None:
        self._source = source

    def get_cache_path(self) -> str:
        return str(cache_folder())

    def get_source_stamp(self) -> str:
        return cache_folder().name

    def get_disambiguator(self) -> str:
        return Path(self._source).stem

    @classmethod
    def from_function(cls, function: Any, source: str) -> _StampedLocator | None:
        inside = Path(source).resolve().parent == _PACKAGE / "engine"
        return cls(source) if inside or source.startswith(KEYED) else None


CacheImpl._locator_classes.insert(0, _StampedLocator)


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


@contextlib.contextmanager
def raw() -> Iterator[None]:
    """Leave what is compiled inside as intermediate code: only the rooms that take it in go on with it, once each."""
    with contextlib.ExitStack() as stack:
        for owner, name in _LATER:
            _replace(stack, owner, name, lambda *_: None)
        yield


def c_function(function: Callable[..., Any], signature: Any, cache: bool, **options: Any) -> Any:
    """Compile a C function, or take it from the cache; a cache that cannot be read or written is done without."""
    compile_it = functools.partial(numba.cfunc, signature, nopython=True, error_model="numpy", **options)
    try:
        return compile_it(cache=cache)(function)
    except (OSError, EOFError, pickle.UnpicklingError):
        return compile_it()(function)


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
