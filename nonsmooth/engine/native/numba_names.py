"""The names of numba and llvmlite that their documentation does not promise, in one file.

Another version may lack any of them. They form two groups.

* Without the first group the workspace has no numba type, and no kernel compiles. The import then fails with a message
  that names the missing name and the supported versions.
* The second group makes the engine's own compiler passes (:mod:`nonsmooth.engine.native.passes`) and its files of
  machine code (:mod:`nonsmooth.engine.native.cache`). :data:`MISSING` names the first one that is missing. The engine
  is then compiled by numba's documented ``njit`` and ``cfunc(cache=True)``
  (:mod:`nonsmooth.engine.native.standard_compiler`), which takes longer and gives the same results.

Documented names (``numba.types``, ``numba.jit``, ``numba.extending.intrinsic``) are imported where they are used.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numba
from numba import types

SUPPORTED = ">=0.61,<0.70"
"""Supported versions of numba, as in pyproject.toml."""


class Attribute(NamedTuple):
    """An attribute of a class of numba that the engine overrides or calls.

    Attributes
    ----------
    owner : object
        The class, or an instance.
    name : str
        The attribute.
    without : str
        The consequence if it is missing.
    """

    owner: Any
    name: str
    without: str


def _first_missing(attributes: Iterable[Attribute]) -> str:
    """Full name of the first attribute that this version lacks; empty if there is none."""
    for owner, name, _ in attributes:
        if inspect.getattr_static(owner, name, None) is None:
            kind = owner if isinstance(owner, type) else type(owner)
            return f"{kind.__module__}.{kind.__qualname__}.{name}"
    return ""


def _refusal(missing: object) -> ImportError:
    return ImportError(
        f"The compiled engine does not work with numba {numba.__version__}: {missing}. "
        f"Install numba{SUPPORTED}, or set NONSMOOTH_PLAIN=1 to run the engine as plain Python, which is slow."
    )


try:
    from llvmlite import ir
    from llvmlite.binding import get_host_cpu_name
    from numba.core import cgutils
    from numba.core.dispatcher import Dispatcher
    from numba.core.imputils import RefType, iternext_impl
    from numba.core.typeconv import Conversion
    from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, signature
    from numba.extending import infer_getattr, lower_cast, lower_getattr_generic, lower_setattr_generic
except ImportError as error:
    raise _refusal(error) from error

OF_TYPES = (
    Attribute(Dispatcher, "compile", "kernels are not compiled with the signatures that they declare"),
    Attribute(Dispatcher, "disable_compile", "a kernel is compiled again for each literal that it is called with"),
    Attribute(cgutils.create_struct_proxy(types.complex128), "_getvalue", "records have no value"),
)
"""Attributes of the first group."""
if _name := _first_missing(OF_TYPES):
    raise _refusal(f"it lacks {_name}")

MISSING = ""
"""The first name of the second group that this version lacks; empty if all are there."""
OF_PASSES: tuple[Attribute, ...] = ()
"""Attributes of the second group."""
try:
    from llvmlite.binding import create_pass_builder, create_pipeline_tuning_options, parse_assembly
    from numba.core.ccallback import CFunc
    from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
    from numba.core.compiler import CompilerBase, CompileResult, DefaultPassBuilder
    from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
    from numba.core.funcdesc import FunctionDescriptor
    from numba.core.registry import cpu_target
    from numba.core.runtime import rtsys
    from numba.core.serialize import dumps
    from numba.core.sigutils import normalize_signature
    from numba.core.typed_passes import (
        IRLegalization,
        NativeLowering,
        NoPythonBackend,
        NopythonTypeInference,
        PreLowerStripPhis,
    )
    from numba.core.typing import Context
    from numba.core.untyped_passes import FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

    _codegen = cpu_target.target_context.codegen()
    OF_PASSES = (
        Attribute(JITCodeLibrary, "_optimize_final_module", "each kernel is optimised alone, and again in each caller"),
        Attribute(JITCodeLibrary, "add_ir_module", "a law is called by two calls"),
        Attribute(JITCodeLibrary, "_optimize_functions", "loops are unrolled, which costs a fifth more time"),
        Attribute(_codegen, "_tm", "the engine has no optimiser of its own"),
        Attribute(_codegen, "_data_layout", "code is optimised for a processor without vectors"),
        Attribute(JITCodeLibrary, "_finalize_final_module", "each kernel becomes machine code that nobody calls"),
        Attribute(JITCodeLibrary, "_finalized", "callers do not include the intermediate code of kernels"),
        Attribute(JITCodeLibrary, "has_dynamic_globals", "code with addresses of this process is written to disk"),
        Attribute(JITCodeLibrary, "codegen", "intermediate code is given an environment, which has no address"),
        Attribute(JITCPUCodegen, "set_env", "the same"),
        Attribute(JITCPUCodegen, "magic_tuple", "code of another processor is loaded"),
        Attribute(CompilerBase, "define_pipelines", "numba's own passes run, which doubles the time"),
        Attribute(PassManager, "add_pass_after", "functions have no unique numbers"),
        Attribute(DefaultPassBuilder, "define_nopython_pipeline", "laws are not compiled"),
        Attribute(FunctionDescriptor, "llvm_cfunc_wrapper_name", "code from disk has no symbol to call"),
        Attribute(CompileResult, "_reduce", "nothing is written to disk"),
        Attribute(CompileResult, "_rebuild", "nothing is loaded from disk"),
        Attribute(Context, "resolve_function_type", "types are searched again at each place, a tenth of the time"),
        Attribute(rtsys, "initialize", "a law that allocates memory, loaded from disk, ends the process"),
    )
    MISSING = _first_missing(OF_PASSES)
except (ImportError, AttributeError) as error:
    MISSING = str(error).split(" (")[0]


def _known(options: Mapping[str, bool]) -> Mapping[str, bool]:
    """The options of ``numba.jit`` that this version knows: it refuses all others."""
    try:
        from numba.core.cpu import CPUTargetOptions
    except ImportError:
        return {}
    return {name: value for name, value in options.items() if hasattr(CPUTargetOptions, name)}


NO_ALLOCATION = _known({"_nrt": False})
"""Options of ``numba.jit`` with which a function that allocates memory does not compile.

A kernel with arrays would count references to them, which makes it tens of times slower.
"""
NO_WRAPPERS = _known({"no_cpython_wrapper": True, "no_cfunc_wrapper": True})
"""Options of ``numba.jit`` for a function that only compiled functions call."""
