"""The names of numba and llvmlite that their documentation does not promise, in one file.

Another version may lack any of them. They form two groups.

* Without the first group the workspace has no numba type, and no kernel compiles. The import then fails with a message
  that names the missing name and the supported versions.
* The second group makes the engine's own compiler passes (:mod:`nonsmooth.engine.native.passes`) and the content of its
  files of machine code (:mod:`nonsmooth.engine.native.code_files`). :data:`MISSING` names the first one that is
  missing. The engine is then compiled by numba's documented ``njit`` and ``cfunc(cache=True)``
  (:mod:`nonsmooth.engine.native.standard_compiler`), which takes longer and gives the same results.

Documented names (``numba.types``, ``numba.jit``, ``numba.extending.intrinsic``) are imported where they are used.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from typing import Any

import numba
from numba import types

SUPPORTED = ">=0.61,<0.70"
"""Supported versions of numba, as in pyproject.toml."""


def _first_missing(attributes: Mapping[Any, Iterable[str]]) -> str:
    """Full name of the first attribute that numba lacks in this version; empty if it has all.

    ``attributes`` are the names that a class, or an instance of it, must have. The name is that of the class, such as
    ``numba.core.dispatcher.Dispatcher.compile``, for a message.
    """
    for owner, names in attributes.items():
        kind = owner if isinstance(owner, type) else type(owner)
        for name in names:
            # static: a property must not be evaluated
            if inspect.getattr_static(owner, name, None) is None:
                return f"{kind.__module__}.{kind.__qualname__}.{name}"
    return ""


def _refusal(missing: object) -> ImportError:
    """Error for a version of numba with which the engine cannot be compiled at all. It lacks ``missing``."""
    return ImportError(
        f"The compiled engine does not work with numba {numba.__version__}: {missing}. "
        f"Install numba{SUPPORTED}, or set NONSMOOTH_PLAIN=1 to run the engine as plain Python, which is slow."
    )


try:
    from llvmlite import ir
    from numba.core import cgutils
    from numba.core.dispatcher import Dispatcher
    from numba.core.imputils import RefType, iternext_impl
    from numba.core.registry import cpu_target
    from numba.core.typeconv import Conversion
    from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, signature
    from numba.extending import infer_getattr, lower_cast, lower_getattr_generic, lower_setattr_generic
except ImportError as error:
    raise _refusal(error) from error

typing_context = cpu_target.typing_context
"""Numba's table of the types of functions."""
OF_TYPES: Mapping[Any, Iterable[str]] = {
    # kernels are compiled with the signatures that they declare, and not again for each literal
    Dispatcher: ("compile", "disable_compile"),
    cgutils.create_struct_proxy(types.complex128): ("_getvalue",),
    typing_context: ("resolve_value_type",),
}
"""Attributes of the first group."""
if _name := _first_missing(OF_TYPES):
    raise _refusal(f"it lacks {_name}")

MISSING = ""
"""The first name of the second group that this version lacks; empty if all are there."""
OF_PASSES: Mapping[Any, Iterable[str]] = {}
"""Attributes of the second group."""
try:
    from llvmlite.binding import create_pass_builder, create_pipeline_tuning_options
    from numba.core.ccallback import CFunc
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler import CompilerBase, DefaultPassBuilder
    from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
    from numba.core.runtime import rtsys
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

    OF_PASSES = {
        # names by which the passes optimise a module, link it, and make its machine code
        JITCodeLibrary: (
            *("_optimize_functions", "_optimize_final_module", "_finalize_final_module", "_finalized"),
            *("add_ir_module", "codegen", "has_dynamic_globals", "_get_compiled_object"),
        ),
        # the processor, and the environment of Python objects that kernels do not have
        cpu_target.target_context.codegen(): ("_tm", "_data_layout", "set_env"),
        # which passes run
        CompilerBase: ("define_pipelines",),
        PassManager: ("add_pass_after",),
        DefaultPassBuilder: ("define_nopython_pipeline",),
        Context: ("resolve_function_type",),
        # the C function of a compiled function
        CFunc: ("compile", "_compile_uncached", "native_name", "address"),
        # numba's runtime, which allocates the arrays of impact laws
        rtsys: ("initialize",),
    }
    MISSING = _first_missing(OF_PASSES)
except (ImportError, AttributeError) as error:
    MISSING = str(error).split(" (")[0]


def _known(options: Mapping[str, bool]) -> Mapping[str, bool]:
    """Select the ``options`` of ``numba.jit`` that this version knows: with any other it raises an error."""
    try:
        from numba.core.cpu import CPUTargetOptions
    except ImportError:
        # a version without the list of its options. Kernels compile without these options, too
        return {}
    return {name: value for name, value in options.items() if hasattr(CPUTargetOptions, name)}


NO_ALLOCATION = _known({"_nrt": False})
"""Options of ``numba.jit`` with which a function that allocates memory does not compile.

A kernel with arrays would count references to them, which makes it tens of times slower.
"""
NO_WRAPPERS = _known({"no_cpython_wrapper": True, "no_cfunc_wrapper": True})
"""Options of ``numba.jit`` for a function that only compiled functions call."""
