"""The same source compiled and as plain Python gives the same numbers.

The functions of laws, bodies, shapes and motions are compared one by one by the conformance kit ("compiled equals
plain", tests/testing); here is the engine.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth import engine
from nonsmooth.engine.native.kernel import PLAIN
from tests.engine.plain_cases import CASES

LEAST_ENTERED = 0.95
"""Least part of the engine's functions that the cases enter; the others are for rare difficulties and for faults."""
ACCOUNTED = (
    *("axis along the normal", "border", "bouncing", "creeping", "flat", "hills", "impact problem 2"),
    *("into the singularity", "next to the bound, 1", "next to the bound, 4", "no force, impact", "over an edge"),
    *("shaken", "skew", "slow border", "squeezed"),
)
"""Cases of which all energy is accounted for."""
COMPILING = ("native", "memory")
"""Folders of the engine whose modules compile, or run in Python only."""

pytestmark = pytest.mark.skipif(PLAIN, reason="nothing is compiled")


@pytest.mark.slow
@pytest.mark.timeout(390)
def test_compiled_and_plain_agree(tmp_path: Path) -> None:
    """Events and words alike, numbers to 1e-12 of the largest of their kind; the cases enter most of the engine.

    One test, as the plain cases take an interpreter of their own and some two minutes, more where others work, too.
    """
    plain, entered = _plain(tmp_path / "numbers")
    for name, case in CASES.items():
        _compare(name, plain[name], case())
    functions = _functions()
    missed = functions - entered
    assert len(missed) < (1.0 - LEAST_ENTERED) * len(functions), f"add cases for {sorted(missed)} to plain_cases.py"


def _plain(file: Path) -> tuple[dict[str, Any], set[str]]:
    """Run all cases as plain Python, in an interpreter of their own: their numbers, and what they entered."""
    root = Path(__file__).parents[2]
    environment = os.environ | {"NONSMOOTH_PLAIN": "1", "PYTHONPATH": str(root)}
    command = [sys.executable, "-m", "tests.engine.plain_cases", str(file)]
    done = subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found: tuple[dict[str, Any], set[str]] = pickle.loads(file.read_bytes())
    return found


def _compare(name: str, plain: dict[str, Any], compiled: dict[str, Any]) -> None:
    assert list(plain) == list(compiled), name
    for key, value in compiled.items():
        one, other = np.asarray(plain[key]), np.asarray(value)
        if one.dtype.kind != "f":
            np.testing.assert_array_equal(one, other, err_msg=f"{name}: {key}")
        else:
            size = float(np.max(np.abs(other[np.isfinite(other)]), initial=1e-300))
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * max(size, 1.0), err_msg=f"{name}: {key}")


def _functions() -> set[str]:
    """Return the functions of the engine, as "folder/module.function"."""
    found: set[str] = set()
    folder = Path(engine.__path__[0])
    for path in folder.rglob("*.py"):
        module = path.relative_to(folder).with_suffix("").as_posix()
        if not module.startswith(COMPILING):
            lines = path.read_text().splitlines()
            found |= {f"{module}.{line[4 : line.index('(')]}" for line in lines if line.startswith("def ")}
    return found


@pytest.mark.parametrize("name", ACCOUNTED)
def test_the_energy_is_accounted_for(name: str) -> None:
    """The run ends, and work, losses and energies at its ends agree."""
    numbers = CASES[name]()
    assert list(numbers.get("status", ["done"])) == ["done"]
    assert abs(numbers["wrong"][0]) < 1e-7


def test_this_process_is_compiled_unless_asked() -> None:
    """The switch is read from the environment."""
    assert (os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")) == PLAIN
