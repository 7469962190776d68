"""Machine code of laws on disk: found again by another process, never after anything that it depends on has changed."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections import namedtuple
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bodies.shapes.egg import Egg
from bodies.shapes.support_shape import SupportShape
from nonsmooth.binding.fingerprint import fingerprint
from nonsmooth.binding.methods import _by_numbers
from nonsmooth.compiled import compiled
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces.body import Vector

_SOURCE = """
import math
SCALE = 2.0
TABLE = (1.0, 2)
@compiled
def inner(x):
    return x + 1.0
@compiled
def helper(x, n=1):
    return SCALE * inner(x) + n
def law(x, p):
    return helper(x) + math.sqrt(p) + TABLE[1]
"""
_CHANGES = (
    ("SCALE = 2.0", "SCALE = 2.5"),
    ("SCALE = 2.0", "SCALE = 2"),
    ("(1.0, 2)", "(1.0, 3)"),
    ("x + 1.0", "x + 1.5"),
    ("x + 1.0", "x - 1.0"),
    ("n=1", "n=2"),
    ("math.sqrt", "math.exp"),
    ("TABLE[1]", "TABLE[0]"),
    ("law(x, p)", "law(p, x)"),
)


def _law(source: str, **names: Any) -> Callable[..., float]:
    scope: dict[str, Any] = {"__name__": __name__, "compiled": compiled, **names}
    exec(source, scope)
    law: Callable[..., float] = scope["law"]
    return law


def test_the_same_source_has_the_same_key() -> None:
    """Whatever object it has become."""
    keys = {fingerprint(_law(_SOURCE), "scalar") for _ in range(2)}
    assert len(keys) == 1
    assert keys != {""}


@pytest.mark.parametrize(("old", "new"), _CHANGES)
def test_another_source_has_another_key(old: str, new: str) -> None:
    """Constants, defaults, arguments, operations and names count, those of helpers of helpers too."""
    assert old in _SOURCE
    key = fingerprint(_law(_SOURCE.replace(old, new)), "scalar")
    assert key not in ("", fingerprint(_law(_SOURCE), "scalar"))


def test_the_context_counts() -> None:
    """The same function called in another way is other machine code."""
    law = _law(_SOURCE)
    assert fingerprint(law, "scalar") != fingerprint(law, "guard")


@pytest.mark.parametrize(
    ("source", "value"),
    [
        ("def law(x): return x + VALUE[0]", np.array([1.0])),
        ("def law(x): return x + VALUE[0]", (np.float64(1.0),)),
        ("def law(x): return x + VALUE.real", os),
        ("def law(x): return VALUE(x)", "text".count),
        ("def law(x, p=VALUE): return x", [1.0]),
        ("def law(x): return sum([x for _ in range(2)]) + (lambda: 1)()", None),
        ("def make(a):\n def law(x): return x + a\n return law\nlaw = make(VALUE)", 1.0),
        ("law = VALUE", abs),
    ],
)
def test_what_is_not_understood_has_no_key(source: str, value: object) -> None:
    """Arrays, other modules, bound methods, inner functions and closures."""
    assert fingerprint(_law(source, VALUE=value), "scalar") == ""


def test_functions_of_numpy_and_math_and_records_count() -> None:
    """Each by where it stands, or by its fields in their order."""
    values = (math.sqrt, math.exp, np.sqrt, namedtuple("One", ["a", "b"]), namedtuple("One", ["b", "a"]))
    keys = [fingerprint(_law("def law(x): return VALUE(x)", VALUE=value), "scalar") for value in values]
    assert len({*keys, ""}) == len(values) + 1
    with_default = namedtuple("with_default", ["a"], defaults=[1.0])
    assert fingerprint(_law("def law(x): return VALUE(x)", VALUE=with_default), "scalar") == ""


@pytest.mark.skipif(PLAIN, reason="nothing is compiled")
def test_the_method_of_a_shape_has_a_key_of_its_own() -> None:
    """So that another process need not compile it; another method, or other fields, give another key."""

    class Longer(SupportShape):
        def support(self, direction: Vector) -> Vector:
            return direction

    found = [(Egg, ("radius", "longer")), (Egg, ("longer", "radius")), (Longer, ("radius", "longer"))]
    keys = {fingerprint(_by_numbers(owner, names), "support") for owner, names in found}
    assert len({*keys, ""}) == len(found) + 1


def test_a_law_of_a_module_that_cannot_be_imported_has_no_key() -> None:
    """The code would not be loaded: numba imports the module."""
    assert fingerprint(_law("def law(x): return x", __name__="not_to_be_found"), "scalar") == ""


_RUN = """
import sys
import numba
from numba.core import event
from nonsmooth.binding.compile import bind, evaluate
import own_law
law = getattr(own_law, sys.argv[1])
with event.install_recorder("numba:run_pass") as passes:
    print(evaluate(*bind(law, "scalar", {"p": 4.0}, "test"), 3.0), len(passes.buffer))
"""
_ALLOCATING = """
import numpy as np
def filled(x, p):
    return np.full(1, x)[0] + p
"""


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="nothing is compiled")
def test_another_process_finds_a_law_until_it_changes(tmp_path: Path) -> None:
    """Compiled once, then found, as is one that allocates; compiled again for a new constant or a damaged file."""

    def run(source: str, name: str = "law") -> tuple[float, int]:
        (tmp_path / "own_law.py").write_text("from nonsmooth.compiled import compiled\n" + source)
        path = os.pathsep.join([str(tmp_path), str(Path(__file__).parents[2])])
        environment = {
            "XDG_CACHE_HOME": str(tmp_path),
            "PYTHONPATH": path,
            "PYTHONDONTWRITEBYTECODE": "1",
            # numba's own caches, which would not see an edit of a helper's file, have no part in this
            "NUMBA_CACHE_LOCATOR_CLASSES": "InTreeCacheLocator",
        }
        command = [sys.executable, "-c", _RUN, name]
        done = subprocess.run(command, env=os.environ | environment, check=True, capture_output=True, text=True)
        value, passes = done.stdout.split()
        return float(value), int(passes)

    value, passes = run(_SOURCE)
    assert value == 13.0
    assert passes > 0
    assert run(_SOURCE) == (13.0, 0)
    value, passes = run(_SOURCE.replace("SCALE = 2.0", "SCALE = 3.0"))
    assert value == 17.0
    assert passes > 0
    assert run(_SOURCE) == (13.0, 0)
    assert run(_ALLOCATING, "filled")[0] == 7.0
    assert run(_ALLOCATING, "filled") == (7.0, 0)
    assert not list(tmp_path.rglob("*.nbi"))
    for kept in tmp_path.glob("nonsmooth/*/*.code"):
        kept.write_bytes(kept.read_bytes()[:100])
    value, passes = run(_SOURCE)
    assert value == 13.0
    assert passes > 0
