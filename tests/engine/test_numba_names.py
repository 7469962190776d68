"""What the engine leans on of numba and llvmlite that they do not promise, and what breaks without it."""

from __future__ import annotations

import inspect
import itertools
from typing import Any

import pytest

from nonsmooth.engine.native.kernel import PLAIN

if PLAIN:
    pytest.skip("nothing is compiled", allow_module_level=True)

from llvmlite import __version__, ir
from llvmlite.binding import parse_assembly
from numba import types
from numba.core import ccallback, cgutils, codegen, compiler, event, funcdesc, runtime, typing
from numba.core.bytecode import FunctionIdentity
from numba.core.dispatcher import Dispatcher
from numba.core.registry import cpu_target
from numba.core.types.functions import BaseFunction

from nonsmooth.engine.native import build
from nonsmooth.engine.native.build import CFunction, ShimPasses
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.native import address_of, jit
from nonsmooth.engine.native.types import FLOATS, call_at, moved

NAMES: tuple[tuple[Any, str, str], ...] = (
    (codegen.JITCodeLibrary, "_optimize_final_module", "each kernel is optimised by itself, and again in every caller"),
    (codegen.JITCodeLibrary, "add_ir_module", "a law is called by two calls"),
    (codegen.JITCodeLibrary, "_optimize_functions", "loops are unrolled, for a fifth more of the time"),
    (cpu_target.target_context.codegen(), "_tm", "no passes of our own are built"),
    (cpu_target.target_context.codegen(), "_data_layout", "code is optimised for a processor without vectors"),
    (codegen.JITCodeLibrary, "_finalize_final_module", "each kernel becomes machine code that nobody calls"),
    (codegen.JITCodeLibrary, "_finalized", "callers do not take in what each kernel is lowered to"),
    (codegen.JITCodeLibrary, "has_dynamic_globals", "code with addresses of this process is kept for others"),
    (codegen.JITCodeLibrary, "codegen", "raw code is told of its environment, at an address that it has not"),
    (codegen.JITCPUCodegen, "set_env", "the same"),
    (codegen.JITCPUCodegen, "magic_tuple", "code of another processor is loaded"),
    (Dispatcher, "disable_compile", "a kernel is compiled again for each literal that it is called with"),
    (compiler.CompilerBase, "define_pipelines", "numba's own passes run, for twice the time"),
    (compiler.PassManager, "add_pass_after", "functions are not numbered"),
    (compiler.DefaultPassBuilder, "define_nopython_pipeline", "laws are not compiled"),
    (funcdesc.FunctionDescriptor, "llvm_cfunc_wrapper_name", "code from disk has nothing that can be called"),
    (cgutils.create_struct_proxy(types.complex128), "_getvalue", "records with names have no value"),
    (compiler.CompileResult, "_reduce", "nothing is kept on disk"),
    (compiler.CompileResult, "_rebuild", "nothing is loaded from disk"),
    (
        typing.Context,
        "resolve_function_type",
        "types of operations are searched for at each place, a tenth of the time",
    ),
    (runtime.rtsys, "initialize", "a law that allocates memory, loaded from disk, ends the process"),
)


@pytest.mark.parametrize(("owner", "name", "without"), NAMES, ids=[name for _, name, _ in NAMES])
def test_it_is_there(owner: Any, name: str, without: str) -> None:
    """Under the name by which it is overridden or called."""
    assert inspect.getattr_static(owner, name) is not None, without


def _law(x: float) -> float:
    return 2.0 * x + 1.0


def _shim(law: Any) -> Any:
    scope = {"law": law, "__name__": __name__}
    exec("def shim(x, p): return law(x)", scope)
    return scope["shim"]


def _call(address: int, x: float) -> float:
    return float(FORMS["scalar"].prototype()(address)(x, None))


_CLASSES = (
    codegen.CPUCodeLibrary,
    codegen.JITCodeLibrary,
    codegen.JITCPUCodegen,
    Dispatcher,
    BaseFunction,
    FunctionIdentity,
    ccallback.CFunc,
)


class _Looking(event.Listener):  # type: ignore[misc]
    """Lists functions in numba's classes that are not numba's, whenever one of its passes begins."""

    def __init__(self) -> None:
        self.looks, self.foreign = 0, set[str]()

    def on_start(self, event: Any) -> None:
        self.looks += 1
        for owner in _CLASSES:
            for name, value in vars(owner).items():
                if inspect.isfunction(value) and not value.__module__.startswith("numba."):
                    self.foreign.add(f"{owner.__name__}.{name}")

    def on_end(self, event: Any) -> None:
        pass


def test_numba_is_not_patched() -> None:
    """While a law is compiled its classes are as they were: another thread may compile functions of its own."""
    looking, ids = _Looking(), FunctionIdentity._unique_ids
    with event.install_listener("numba:run_pass", looking):
        address = address_of(_shim(jit(_law)), "scalar", "")
        assert FunctionIdentity._unique_ids is ids
    assert looking.looks > 0
    assert looking.foreign == set()
    assert _call(address, 3.0) == 7.0


def test_what_a_shim_calls_is_compiled_within_it_alone() -> None:
    """The function itself stays intermediate code; our passes take the places of numba's."""
    law = jit(_law)
    with event.install_recorder("numba:run_pass") as passes:
        address = address_of(_shim(law), "scalar", "")
    named: dict[str, set[str]] = {"_law": set(), "shim": set()}
    for _, record in passes.buffer:
        named[record.data["qualname"]].add(record.data["name"].split()[0])
    for names in named.values():
        assert {"number", "remembering_type_inference"} <= names
        assert "nopython_type_inference" not in names
    assert [("raw_native_lowering" in names, "shim_native_lowering" in names) for names in named.values()] == [
        (True, False),
        (False, True),
    ]
    (compiled,) = law.overloads.values()
    assert isinstance(compiled.library, build._RawLibrary)
    defined = compiled.library._codegen._engine.is_symbol_defined
    assert not defined(compiled.fndesc.llvm_func_name)
    assert _call(address, -1.0) == -1.0
    assert build._typed


def test_a_call_of_a_shim_is_one() -> None:
    """All that it calls, and what has its address, are one function."""
    function: Any = CFunction(_shim(jit(_law)), types.float64(types.float64, FLOATS), None, ShimPasses)
    function.compile()
    defined = [one.name for one in function._library._final_module.functions if not one.is_declaration]
    assert defined == [function._wrapper_name]


def test_numbers_of_functions_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two processes count alike, and give one name to what a third one loads from both."""
    signature = types.float64(types.float64, FLOATS)
    names = []
    for _ in range(2):
        monkeypatch.setattr(FunctionIdentity, "_unique_ids", itertools.count(10**6))
        function = CFunction(_shim(jit(_law)), signature, None, ShimPasses)
        function.compile()
        names.append(function.native_name)
    assert names[0] != names[1]


class _Asked:
    """A store that keeps nothing, and lists what it is asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []

    def load_overload(self, signature: Any, context: Any) -> None:
        self.asked.append("load")

    def save_overload(self, signature: Any, compiled: Any) -> None:
        self.asked.append("save")


def test_a_store_takes_the_place_of_numbas_cache() -> None:
    """Numba's own would keep code by the file of its function: that of a shim is made, and in none."""
    store: Any = _Asked()
    CFunction(_shim(jit(_law)), types.float64(types.float64, FLOATS), store, ShimPasses).compile()
    assert store.asked == ["load", "save"]


@pytest.mark.skipif(
    tuple(int(part) for part in __version__.split(".")[:2]) < (0, 45), reason="pointers have types there"
)
def test_pointers_need_no_types(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what llvmlite is to drop: moving, reading and calling say for themselves what stands there."""
    pointer, number, size = ir.PointerType(), ir.DoubleType(), ir.IntType(64)
    monkeypatch.setattr(ir.FunctionType, "as_pointer", lambda function: pointer)
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(number, [pointer, size]), "probe")
    builder = ir.IRBuilder(function.append_basic_block())
    context = cpu_target.target_context
    place = moved(context, builder, FLOATS, *function.args)
    value = builder.load(place, typ=number)
    builder.ret(call_at(builder, function.args[1], number, [value, place]))
    parse_assembly(str(module)).verify()
