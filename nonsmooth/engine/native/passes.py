"""The engine's own compiler passes: numba compiles the engine and the shims of laws in half of the time.

* Kernels stay intermediate code, which the optimiser sees once, as part of an entry point. Numba would optimise each of
  them alone, and again within each caller.
* The engine needs a third of numba's passes: it has no closures, literals, overloads or array expressions.
* The types of an operation are found once. Numba would find them again at every place.
* Short loops are not unrolled.

All of it consists of subclasses, so that other functions that numba compiles in the process are not affected.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable
from typing import Any, final

from numba import types

from nonsmooth.engine.native import numba_names as private
from nonsmooth.engine.native.code_files import MachineCode


@private.register_pass(mutates_CFG=False, analysis_only=False)
@final
class Number(private.FunctionPass):
    """Give a function a random number in place of numba's count.

    Symbols consist of a function's name, types and number. Code that several processes have kept on disk is linked by
    symbols, so that these must differ.
    """

    _name = "number"

    def __init__(self) -> None:
        """Do nothing. The base class requires this method of each pass, and numba makes a pass without arguments."""

    def run_pass(self, state: Any) -> bool:
        """Set the random number of the function that numba compiles. True means that it has changed."""
        # 48 bits: the same number twice is next to impossible
        state.func_id.unique_id = secrets.randbits(48)
        return True


class _Typing:
    """A typing context that finds the types of an operation once. Numba tries all candidates at every place."""

    def __init__(self, context: Any) -> None:
        """Keep numba's own context, which does the work."""
        self._context = context

    def __getattr__(self, name: str) -> Any:
        """Attributes of numba's context, for all that is not defined here."""
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, arguments: Any, keywords: Any) -> Any:
        """Signature of a call of ``function`` with the given types of arguments. Numba needs it at every call.

        Signatures of built-in functions and operators are kept for all kernels.
        """
        # a call of a kernel may compile it, and is left to numba
        if not isinstance(function, types.Function):
            return self._context.resolve_function_type(function, arguments, keywords)
        key = function, tuple(arguments), tuple(sorted(keywords.items()))
        if key not in _typed:
            _typed[key] = self._context.resolve_function_type(function, arguments, keywords)
        return _typed[key]


_typed: dict[Any, Any] = {}
"""Signatures found so far, by function and types of arguments."""


@private.register_pass(mutates_CFG=True, analysis_only=False)
@final
class TypeOnce(private.NopythonTypeInference):
    """Type inference that finds the types of each operation once, which saves a tenth of the time."""

    _name = "remembering_type_inference"

    def run_pass(self, state: Any) -> bool:
        """Infer the types of all variables, with a context that keeps the types of operations.

        Numba's own context is put back even after an error: other passes and functions use it.
        """
        context = state.typingctx
        state.typingctx = _Typing(context)
        try:
            return bool(super().run_pass(state))
        finally:
            state.typingctx = context


class _RolledLibrary(private.JITCodeLibrary):
    """Code whose loops are neither unrolled nor interleaved.

    Most loops run over a dozen numbers. Unrolled, they take longer to compile and to run.
    """

    def _builder(self) -> Any:
        """LLVM's passes of the third, highest level of optimisation, without those that unroll or interleave loops."""
        options = private.create_pipeline_tuning_options(speed_level=3)
        options.loop_vectorization, options.loop_unrolling, options.loop_interleaving = True, False, False
        return private.create_pass_builder(self._codegen._tm, options)

    def _optimize_functions(self, module: Any) -> None:
        """Optimise each function of a module alone. Numba calls this when the module joins the library."""
        # sizes and alignments of this processor, which the passes need to know
        module.data_layout = self._codegen._data_layout
        builder = self._builder()
        for function in module.functions:
            builder.getFunctionPassManager().run(function, builder)

    def _optimize_final_module(self) -> None:
        """Optimise the library as a whole, with all that is linked. Numba calls this before it makes machine code.

        Numba's own two rounds, with the counting of references in between, are not needed: kernels have no references.
        """
        builder = self._builder()
        builder.getModulePassManager().run(self._final_module, builder)


class _RawLibrary(_RolledLibrary):
    """Intermediate code as it was lowered. It is never run: an entry point includes it and is optimised as a whole."""

    def _optimize_final_module(self) -> None:
        """Do nothing: the code is optimised in the entry point that includes it."""

    def _finalize_final_module(self) -> None:
        """Mark the library as complete for numba, without making machine code of it."""
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """The library itself, on which numba then calls :meth:`set_env` in place of its code generator."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing. There is no machine code, into which numba would write the environment of Python objects."""


class _OneFunction:
    """Mixin of libraries whose function and wrapper become one, so that a call by address is a single call."""

    _final_module: Any

    def add_ir_module(self, module: Any) -> None:
        """Add a module of intermediate code to the library. Numba calls this for a function, then for its wrapper.

        The C wrapper calls the function, and converts arguments and result. Numba forbids to inline this call: here the
        mark "noinline" is removed from it.
        """
        for function in module.functions if module.name == "cfunc_wrapper" else ():
            for block in function.blocks:
                for instruction in block.instructions:
                    if isinstance(instruction, private.ir.CallInstr):
                        instruction.attributes.discard("noinline")
        super().add_ir_module(module)  # type: ignore[misc]

    def _optimize_final_module(self) -> None:
        """Optimise the module, of which only the C wrapper can be called from outside.

        All functions that it defines but the wrapper become internal. So those that are inlined everywhere are dropped.
        """
        # numba begins the name of a C wrapper with "cfunc."
        for function in self._final_module.functions:
            if not function.is_declaration and not function.name.startswith("cfunc."):
                function.linkage = "internal"
        super()._optimize_final_module()  # type: ignore[misc]


class _EntryLibrary(_OneFunction, _RolledLibrary):
    """Code of an entry point."""


class _ShimLibrary(_OneFunction, private.JITCodeLibrary):
    """Code of a shim."""


def _lowering(name: str, library: type[private.JITCodeLibrary]) -> type[private.NativeLowering]:
    """Make the pass that lowers a function to LLVM's intermediate code, in a library of a class of this module.

    The library makes machine code of it, or leaves that to the callers of the function. Each pass needs a ``name``.
    """

    @private.register_pass(mutates_CFG=True, analysis_only=False)
    @final
    class Lower(private.NativeLowering):
        _name = f"{name}_native_lowering"

        def run_pass(self, state: Any) -> bool:
            """Lower the function into a new library of the given class, in place of one of numba's."""
            state.library = library(state.targetctx.codegen(), state.func_id.func_qualname)
            # keep the machine code, so that it can be written to a file
            state.library.enable_object_caching()
            return bool(super().run_pass(state))

    return Lower


_LOWER_RAW = _lowering("raw", _RawLibrary)
"""Lowering of kernels and laws, whose machine code is part of their callers. It saves half of the time."""


def _engine_passes(state: Any) -> private.PassManager:
    """The passes of numba that the engine's loops over numbers need, in the order in which numba runs them.

    Numba wants a function of the ``state`` of the compiler. These passes do not depend on it.
    """
    passes = private.PassManager("engine")
    # from the byte code of Python to types, then to intermediate code. Those for closures, literals, overloads and
    # array expressions are left out
    for kind in (
        private.TranslateByteCode,
        private.FixupArgs,
        private.IRProcessing,
        private.ReconstructSSA,
        private.NopythonTypeInference,
        private.PreLowerStripPhis,
        private.IRLegalization,
        private.NativeLowering,
        private.NoPythonBackend,
    ):
        passes.add_pass(kind, kind.__name__)
    return passes


def _compiler(numba_passes: Callable[[Any], private.PassManager], lowering: type) -> type[private.CompilerBase]:
    """Make a class of compilers for ``numba.jit``, from passes of numba, in which the engine's own replace two.

    Those are the inference of types and the ``lowering``. The pass that numbers functions is added.
    """
    own = {private.NopythonTypeInference: TypeOnce, private.NativeLowering: lowering}

    @final
    class Passes(private.CompilerBase):
        def define_pipelines(self) -> list[private.PassManager]:
            """Numba's passes, with those of ``own`` in their places. Numba wants a list of pipelines to be tried."""
            passes = numba_passes(self.state)
            passes.passes = [(own.get(kind, kind), name) for kind, name in passes.passes]
            # after the first pass: all later ones use the number
            passes.add_pass_after(Number, private.TranslateByteCode)
            passes.finalize()
            return [passes]

    return Passes


EntryPasses = _compiler(_engine_passes, _lowering("entry", _EntryLibrary))
"""For entry points."""
KernelPasses = _compiler(_engine_passes, _LOWER_RAW)
"""For kernels, whose code is part of entry points."""
ShimPasses = _compiler(private.DefaultPassBuilder.define_nopython_pipeline, _lowering("shim", _ShimLibrary))
"""For shims, which have an address and call a plug-in's function."""
LawPasses = _compiler(private.DefaultPassBuilder.define_nopython_pipeline, _LOWER_RAW)
"""For functions of plug-ins, whose code is part of shims."""


@final
class CFunction(private.CFunc):
    """A C function made from a Python function; :meth:`compile` compiles it with the given passes.

    Parameters
    ----------
    function : callable
        The Python function.
    signature : numba signature
        Types of its arguments and of its result.
    passes : type
        The passes of the compiler.
    **options : bool
        Options of ``numba.jit`` in addition to "nopython" and "error_model".
    """

    def __init__(self, function: Any, signature: Any, passes: type, **options: bool) -> None:
        """Set the function up for :meth:`compile`. Numba's cache is not used."""
        # division by zero gives infinity or nan, as in numpy, and no error
        all_options = {"nopython": True, "error_model": "numpy", **options}
        # the types of arguments and the type of the result
        typed = private.normalize_signature(signature)
        # no types are prescribed for local variables: numba infers them
        super().__init__(function, typed, locals={}, options=all_options, pipeline_class=passes)

    def _compile_uncached(self) -> Any:
        """Compile the function, and keep the library that holds its code. Numba calls this in :meth:`compile`."""
        compiled = super()._compile_uncached()  # type: ignore[misc]
        self.library = compiled.library
        return compiled

    def machine_code(self, signature: str) -> MachineCode | None:
        """The compiled code in the form in which it is kept in a file; None if no other process could use it.

        Another process cannot use code that contains addresses of objects in this process. ``signature`` holds the
        types of the function as text.
        """
        if self.library.has_dynamic_globals:
            return None
        module = self.library._final_module
        declared = [one.name for one in (*module.functions, *module.global_variables) if one.is_declaration]
        # functions named llvm.* need no address: LLVM turns them into instructions, or into calls of the C library,
        # which each process has
        externals = tuple(name for name in declared if not name.startswith("llvm."))
        return MachineCode(self.native_name, signature, externals, self.library._get_compiled_object())
