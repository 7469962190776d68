"""How numba compiles the engine and the shims of laws; with the cache all that leans on its private parts.

All of it is made of subclasses: what else numba compiles in the process is compiled as ever.
"""

from __future__ import annotations

import contextlib
import gc
import secrets
from collections.abc import Callable, Iterator
from typing import Any, final

from llvmlite import ir
from llvmlite.binding import create_pass_builder, create_pipeline_tuning_options
from numba.core import types
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
from numba.core.sigutils import normalize_signature
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.untyped_passes import FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

from nonsmooth.engine.native.cache import Store


@register_pass(mutates_CFG=False, analysis_only=False)
@final
class Number(FunctionPass):
    """Give a function a number that no function of another process has.

    A symbol is made of a function's name, types and number, and cached code of several processes is linked by symbols.
    """

    _name = "number"

    def __init__(self) -> None:
        """Leave all to the state."""

    def run_pass(self, state: Any) -> bool:
        """Draw the number."""
        state.func_id.unique_id = secrets.randbits(48)
        return True


class _Typing:
    """A typing context that finds the types of an operation once: numba tries all candidates at every place."""

    def __init__(self, context: Any) -> None:
        self._context = context

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, arguments: Any, keywords: Any) -> Any:
        if not isinstance(function, types.Function):
            return self._context.resolve_function_type(function, arguments, keywords)
        key = function, tuple(arguments), tuple(sorted(keywords.items()))
        if key not in _typed:
            _typed[key] = self._context.resolve_function_type(function, arguments, keywords)
        return _typed[key]


_typed: dict[Any, Any] = {}


@register_pass(mutates_CFG=True, analysis_only=False)
@final
class TypeOnce(NopythonTypeInference):
    """Type inference that remembers; a tenth of the time of compiling."""

    _name = "remembering_type_inference"

    def run_pass(self, state: Any) -> bool:
        """Infer the types of all variables."""
        context = state.typingctx
        state.typingctx = _Typing(context)
        try:
            return bool(super().run_pass(state))
        finally:
            state.typingctx = context


class _RolledLibrary(JITCodeLibrary):
    """Code whose loops stay as they stand: unrolled, such short ones take longer to compile, and to run.

    Nor are several vectors of a loop taken at once: of a dozen numbers most would be left over.
    """

    def _builder(self) -> Any:
        options = create_pipeline_tuning_options(speed_level=3)
        options.loop_vectorization, options.loop_unrolling, options.loop_interleaving = True, False, False
        return create_pass_builder(self._codegen._tm, options)

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout
        builder = self._builder()
        for function in module.functions:
            builder.getFunctionPassManager().run(function, builder)

    def _optimize_final_module(self) -> None:
        builder = self._builder()
        builder.getModulePassManager().run(self._final_module, builder)


class _RawLibrary(_RolledLibrary):
    """Intermediate code as it was lowered, which is never run: the code of a caller takes it in and is optimised."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """What is told of the code's environment."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Leave it: no code, no environment."""


def _let_inline(module: Any) -> None:
    """Let the wrapper that has the address take in what it wraps, which numba forbids."""
    for function in module.functions if module.name == "cfunc_wrapper" else ():
        for block in function.blocks:
            for instruction in block.instructions:
                if isinstance(instruction, ir.CallInstr):
                    instruction.attributes.discard("noinline")


class _EntryLibrary(_RolledLibrary):
    """Code of an entry point, in which the function is one with its wrapper: a call of it is one call."""

    def add_ir_module(self, module: Any) -> None:
        """Add a module to those that are linked."""
        _let_inline(module)
        super().add_ir_module(module)

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and not function.name.startswith("cfunc."):
                function.linkage = "internal"
        super()._optimize_final_module()


class _ShimLibrary(JITCodeLibrary):
    """Code of a shim, all of which is taken into its one function."""

    def add_ir_module(self, module: Any) -> None:
        """Add a module to those that are linked."""
        _let_inline(module)
        super().add_ir_module(module)

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and not function.name.startswith("cfunc."):
                function.linkage = "internal"
        super()._optimize_final_module()


class _Lower(NativeLowering):
    """Lowering to intermediate code into a library of one's own."""

    _library: type[JITCodeLibrary]

    def run_pass(self, state: Any) -> bool:
        """Lower, and keep the machine code where the library makes any of it."""
        state.library = self._library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
@final
class LowerRaw(_Lower):
    """Lowering that leaves what it makes to the callers; half of the time of compiling."""

    _name, _library = "raw_native_lowering", _RawLibrary


@register_pass(mutates_CFG=True, analysis_only=False)
@final
class LowerEntry(_Lower):
    """Lowering into code with loops as they stand."""

    _name, _library = "entry_native_lowering", _EntryLibrary


@register_pass(mutates_CFG=True, analysis_only=False)
@final
class LowerShim(_Lower):
    """Lowering into code of one function."""

    _name, _library = "shim_native_lowering", _ShimLibrary


_ENGINE = (
    TranslateByteCode,
    FixupArgs,
    IRProcessing,
    ReconstructSSA,
    NopythonTypeInference,
    PreLowerStripPhis,
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
)
"""The passes of numba that the engine's plain loops need.

Those left out rewrite closures, literals, overloads and whole arrays, which the engine has none of.
"""


def _engine_passes(state: Any) -> PassManager:
    passes = PassManager("engine")
    for one in _ENGINE:
        passes.add_pass(one, one.__name__)
    return passes


def _compiler(numba_passes: Callable[[Any], PassManager], lowering: type) -> type[CompilerBase]:
    own = {NopythonTypeInference: TypeOnce, NativeLowering: lowering}

    @final
    class Passes(CompilerBase):
        def define_pipelines(self) -> list[PassManager]:
            passes = numba_passes(self.state)
            passes.passes = [(own.get(one, one), what) for one, what in passes.passes]
            passes.add_pass_after(Number, TranslateByteCode)
            passes.finalize()
            return [passes]

    return Passes


EntryPasses = _compiler(_engine_passes, LowerEntry)
"""For functions of the engine that are called by address."""
KernelPasses = _compiler(_engine_passes, LowerRaw)
"""For functions of the engine that those take in."""
ShimPasses = _compiler(DefaultPassBuilder.define_nopython_pipeline, LowerShim)
"""For shims, which are called by address."""
LawPasses = _compiler(DefaultPassBuilder.define_nopython_pipeline, LowerRaw)
"""For functions of plug-ins, which shims take in."""


@contextlib.contextmanager
def uncollected() -> Iterator[None]:
    """Look for no garbage inside, a tenth of the time: the compiler makes millions of small objects that live."""
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
        self, function: Callable[..., Any], signature: Any, store: Store | None, passes: type[CompilerBase]
    ) -> None:
        options = {"nopython": True, "error_model": "numpy"}
        super().__init__(function, normalize_signature(signature), locals={}, options=options, pipeline_class=passes)
        if store is not None:
            self._cache = store
