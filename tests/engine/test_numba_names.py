"""The names of numba and llvmlite that are not documented: all are there, in one file, and some can be missing."""

from __future__ import annotations

import ctypes
import importlib
import inspect
import itertools
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth.engine.native.kernel import PLAIN

if PLAIN:
    pytest.skip("nothing is compiled", allow_module_level=True)

import numba
from llvmlite import __version__, ir
from llvmlite.binding import parse_assembly
from numba import types
from numba.core import ccallback, codegen, event
from numba.core.bytecode import FunctionIdentity
from numba.core.dispatcher import Dispatcher
from numba.core.types.functions import BaseFunction

from nonsmooth.engine.native import numba_names, passes
from nonsmooth.engine.native.callees import KERNELS
from nonsmooth.engine.native.code_files import read
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.kernel import address_of, jit
from nonsmooth.engine.native.loader import load
from nonsmooth.engine.native.passes import CFunction, ShimPasses
from nonsmooth.engine.native.types import FLOATS, call_at, moved

ROOT = Path(__file__).parents[2]
ATTRIBUTES = {**numba_names.OF_TYPES, **numba_names.OF_PASSES}
NAMES = [(owner, name) for owner, names in ATTRIBUTES.items() for name in names]


@pytest.mark.parametrize(("owner", "name"), NAMES, ids=[name for _, name in NAMES])
def test_it_is_there(owner: Any, name: str) -> None:
    """Under the name by which it is overridden or called."""
    assert inspect.getattr_static(owner, name) is not None


def test_this_version_lacks_nothing() -> None:
    """So the engine's own passes compile it, and kernels that allocate memory do not compile."""
    assert numba_names.MISSING == ""
    assert numba_names.NO_ALLOCATION == {"_nrt": False}
    assert len(numba_names.NO_WRAPPERS) == 2


def test_supported_versions_are_those_of_the_package() -> None:
    """The message about a missing name must not name others."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert f"numba{numba_names.SUPPORTED}" in project["dependencies"]


def test_one_file_has_all_of_them() -> None:
    """No other one imports from numba's inner modules, or from llvmlite beyond its documented ``binding``."""
    sources = [
        path for folder in ("nonsmooth", "bodies", "laws", "scenarios") for path in (ROOT / folder).rglob("*.py")
    ]
    imports = re.compile(r"^\s*(?:from|import) (?:numba\.(?!extending\b|types\b)|llvmlite(?!\.binding\b|$))", re.M)
    assert [path.name for path in sources if imports.search(path.read_text())] == ["numba_names.py"]


def test_no_kernel_has_an_array() -> None:
    """Neither as argument nor as result; numba would count references to it."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    assert len(KERNELS) > 500
    for kernel in KERNELS:
        for kind in (kernel.signature.return_type, *kernel.signature.args):
            assert not any(isinstance(one, types.Buffer) for one in _parts(kind)), (kernel, kind)


def _parts(kind: Any) -> list[Any]:
    return [kind, *(part for one in kind for part in _parts(one))] if isinstance(kind, types.BaseTuple) else [kind]


_ALLOCATE = """
import sys
import numpy as np
from nonsmooth.engine.native.callees import Kernel
from nonsmooth.engine.native.compiler import kernel_dispatcher
from nonsmooth.engine.native.signatures import signature_of

def array(x):
    numbers = np.zeros(3)
    numbers[1] = x
    return numbers[1]

def list(x):
    numbers = [x, 2.0]
    return numbers[0]

def number(x):
    return 2.0 * x

Kernel(kernel_dispatcher(globals()[sys.argv[1]]), signature_of("f8(f8)")).compile()
"""


@pytest.mark.parametrize("name", ["array", "list", "number"])
def test_a_kernel_that_allocates_does_not_compile(name: str, tmp_path: Path) -> None:
    """Numba refuses it. In a process of its own, as the functions of arrays may be compiled already in this one."""
    done = _python(_ALLOCATE, tmp_path, name)
    assert (done.returncode == 0) == (name == "number"), done.stderr
    if name != "number":
        assert re.search("NRT required but not enabled|Only accept returning of array", done.stderr)


def test_no_signature_of_a_kernel_has_an_array() -> None:
    """Numba counts references to arrays, which makes loops ten times slower. Tuples may hide one."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    assert KERNELS
    for kernel in KERNELS:
        named = [kernel.signature.return_type, *kernel.signature.args]
        parts = [part for one in named for part in (one, *getattr(one, "types", ()))]
        assert not any(isinstance(part, (types.Array, types.List)) for part in parts), kernel.signature


def _with_array(x: float) -> float:
    numbers = np.zeros(3)
    numbers[1] = x
    return float(numbers[1])


def test_a_law_may_allocate() -> None:
    """Impact laws have arrays whose length is the number of contacts."""
    assert _call(address_of(lambda: _shim(jit(_with_array)), "scalar", ""), 3.0) == 3.0


_WITHOUT = """
import importlib, sys
owner, _, name = sys.argv[1].rpartition(".")
module, _, kind = owner.partition(":")
owner = importlib.import_module(module)
delattr(getattr(owner, kind) if kind else owner, name)
"""
_COMPILE = """
from numba.core import event
from nonsmooth.binding.compile import bind, evaluate
from nonsmooth.engine.native import compiler, entry_points
import nonsmooth.engine.events.event_loop

def law(x): return 2.0 * x + 1.0

assert compiler._compiler.__name__.endswith("standard_compiler")
assert evaluate(*bind(law, "scalar", {}, "test"), 3.0) == 7.0
with event.install_recorder("numba:run_pass") as passes:
    assert entry_points.compile_entry("ENTRY")[1] > 0
print(len(passes.buffer))
"""
_RUN = """
import numpy as np
import nonsmooth as ns
from bodies import Dumbbell, Harmonic, Plate
from laws import Coulomb, EnergeticImpact, Unilateral

plate, body = Plate(motion=Harmonic(amplitude=3.58e-4, frequency=25.0)), Dumbbell(radius=4.76e-3, aspect_ratio=3.9)
system = ns.System([plate, body], gravity=9.81)
system.contact(body, plate, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(restitution=0.65))
system.place(body, position=(0.0, 0.0, 2.0 * body.radius))
found = ns.simulate(system, t_end=0.2)
print(found.q[-1].tobytes().hex())
"""


def _python(text: str, cache: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    # without machine code on disk all is compiled
    places = {"NUMBA_CACHE_DIR": str(cache / "numba"), "XDG_CACHE_HOME": str(cache), "PYTHONPATH": str(ROOT)}
    environment = os.environ | places
    return subprocess.run([sys.executable, "-c", text, *arguments], env=environment, capture_output=True, text=True)


@pytest.mark.parametrize(
    "missing",
    ["numba.core.compiler_machinery:PassManager.add_pass_after", "numba.core.compiler_machinery:.register_pass"],
    ids=["attribute", "import"],
)
def test_without_a_name_of_the_passes_numba_compiles_alone(missing: str, tmp_path: Path) -> None:
    """A line says so, once. A second process compiles nothing but the law."""
    for _ in range(2):
        done = _python(_WITHOUT + _COMPILE.replace("ENTRY", "assemble_delassus"), tmp_path, missing)
        assert done.returncode == 0, done.stderr
        assert missing.rpartition(".")[2] in done.stderr
        assert done.stderr.count("the engine is compiled by numba.njit(cache=True)") == 1
    assert done.stdout == "0\n"


@pytest.mark.slow
@pytest.mark.timeout(390)
def test_without_a_name_of_the_passes_results_are_the_same(tmp_path: Path) -> None:
    """To the last bit: the same operations in the same order."""
    missing = "numba.core.compiler_machinery:PassManager.add_pass_after"
    one, other = _python(_RUN, tmp_path), _python(_WITHOUT + _RUN, tmp_path, missing)
    assert one.returncode == 0, one.stderr
    assert other.returncode == 0, other.stderr
    assert one.stdout == other.stdout


def test_without_a_name_of_the_types_the_message_names_it(tmp_path: Path) -> None:
    """The version and the supported ones, too."""
    missing = "numba.core.typing.templates:.AbstractTemplate"
    done = _python(_WITHOUT + "from nonsmooth.engine.native.kernel import kernel", tmp_path, missing)
    assert done.returncode == 1
    for part in ("AbstractTemplate", numba.__version__, numba_names.SUPPORTED, "NONSMOOTH_PLAIN=1"):
        assert part in done.stderr.splitlines()[-1]


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
        address = address_of(lambda: _shim(jit(_law)), "scalar", "")
        assert FunctionIdentity._unique_ids is ids
    assert looking.looks > 0
    assert looking.foreign == set()
    assert _call(address, 3.0) == 7.0


def test_what_a_shim_calls_is_compiled_within_it_alone() -> None:
    """The function itself stays intermediate code; our passes take the places of numba's."""
    law = jit(_law)
    with event.install_recorder("numba:run_pass") as recorder:
        address = address_of(lambda: _shim(law), "scalar", "")
    named: dict[str, set[str]] = {"_law": set(), "shim": set()}
    for _, record in recorder.buffer:
        named[record.data["qualname"]].add(record.data["name"].split()[0])
    for names in named.values():
        assert {"number", "remembering_type_inference"} <= names
        assert "nopython_type_inference" not in names
    assert [("raw_native_lowering" in names, "shim_native_lowering" in names) for names in named.values()] == [
        (True, False),
        (False, True),
    ]
    (compiled,) = law.overloads.values()
    assert isinstance(compiled.library, passes._RawLibrary)
    defined = compiled.library._codegen._engine.is_symbol_defined
    assert not defined(compiled.fndesc.llvm_func_name)
    assert _call(address, -1.0) == -1.0
    assert passes._typed


def test_a_call_of_a_shim_is_one() -> None:
    """All that it calls, and what has its address, are one function."""
    function: Any = CFunction(_shim(jit(_law)), types.float64(types.float64, FLOATS), ShimPasses)
    function.compile()
    defined = [one.name for one in function.library._final_module.functions if not one.is_declaration]
    assert defined == [function._wrapper_name]


def test_numbers_of_functions_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two processes count alike, and give one name to what a third one loads from both."""
    signature = types.float64(types.float64, FLOATS)
    names = []
    for _ in range(2):
        monkeypatch.setattr(FunctionIdentity, "_unique_ids", itertools.count(10**6))
        function = CFunction(_shim(jit(_law)), signature, ShimPasses)
        function.compile()
        names.append(function.native_name)
    assert names[0] != names[1]


def test_code_is_kept_by_its_key_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Numba's own cache would keep code by the file of its function: that of a shim is made, and has none."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    address = address_of(lambda: _shim(jit(_law)), "scalar", "key")
    assert _call(address, 3.0) == 7.0
    code = read("shim-key")
    assert code is not None
    assert code.signature == FORMS["scalar"].signature
    assert _call(load(code), 3.0) == 7.0
    assert _call(address_of(_not_made, "scalar", "key"), -1.0) == -1.0


def _not_made() -> Any:
    raise AssertionError("the shim is on disk")


def test_a_law_with_addresses_of_the_process_is_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They mean nothing in another one."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    function = types.float64(types.float64)
    callback = numba.cfunc(function)(_law)
    pointer = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(callback.address)

    def law(x: float) -> float:
        return float(pointer(x))

    assert _call(address_of(lambda: _shim(jit(law)), "scalar", "key"), 3.0) == 7.0
    assert read("shim-key") is None


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
    place = moved(builder, float, *function.args)
    value = builder.load(place, typ=number)
    builder.ret(call_at(builder, function.args[1], number, [value, place]))
    parse_assembly(str(module)).verify()
