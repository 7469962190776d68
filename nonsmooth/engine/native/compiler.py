"""The compiler in use: the engine's own passes, or numba's if the installed version lacks a name that those need.

Both modules offer the functions below.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from nonsmooth.engine.native.numba_names import MISSING

_compiler = importlib.import_module(f"nonsmooth.engine.native.{'standard' if MISSING else 'own'}_compiler")

kernel_dispatcher: Callable[[Callable[..., Any]], Any] = _compiler.kernel_dispatcher
"""Numba's dispatcher of a kernel."""
law_dispatcher: Callable[[Callable[..., Any]], Any] = _compiler.law_dispatcher
"""Numba's dispatcher of a plug-in's function, which is compiled on demand."""
entry_address: Callable[[Callable[..., Any], Any, str, str], int] = _compiler.entry_address
"""``entry_address(function, typed, signature, key)``: address of the C function of an entry point.

It is compiled, and stored on disk under its key. Equal keys must mean equal functions. An empty key stores nothing.
"""
shim_address: Callable[[Callable[..., Any], str, str], int] = _compiler.shim_address
"""``shim_address(function, signature, key)``: address of the C function of a shim, which calls a plug-in's function."""
KEEPS_FILES: bool = _compiler.KEEPS_FILES
"""True if compiled entry points are stored in the files of :mod:`nonsmooth.engine.native.code_files`.

Other processes can then write these files. False if numba stores the machine code in files of its own.
"""
