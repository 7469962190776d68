"""Loads machine code into the process by llvmlite alone, in a tenth of the time that numba takes to be imported."""

from __future__ import annotations

import functools
import importlib
from typing import Any

import llvmlite.binding as llvm

from nonsmooth.engine.native.code_files import MachineCode


@functools.cache
def _linker() -> Any:
    """LLVM's execution engine, which links object code and keeps it until the process ends. It compiles nothing."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine()
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)


def load(machine_code: MachineCode) -> int:
    """Address of the C function of some machine code. It is valid until the process ends."""
    linker = _linker()
    # LLVM ends the process if a symbol is missing. Laws that allocate memory or handle exceptions need symbols of numba
    if any(llvm.address_of_symbol(name) is None for name in machine_code.externals):
        importlib.import_module("nonsmooth.engine.native.own_compiler").start_runtime()
    linker.add_object_file(llvm.ObjectFileRef.from_data(machine_code.code))
    linker.finalize_object()
    return int(linker.get_function_address(machine_code.symbol))
