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

NOT_ENTERED = {
    "contact/search": {"_accept_raw", "_rubs"},
    "contact/distribution": {"_add_disc_curve", "_disc_excess"},
    "events/event_loop": {"_up_to_end"},
    "flow/choices": {"_choose_at"},
    "impact/clock": {"_restore_phases"},
    "impact/end": {"cut_short", "faded"},
    "events/averaging": {"average_island_of", "end_averaging"},
    "events/simultaneous": {"_touches_already"},
    "events/stopping": {"_share"},
    "events/twins": {"take_over"},
    "flow/location": {"_advance", "_behind_jump", "_hides_another", "_sampled", "_soonest"},
    "flow/projection": {"_motion_by_gaps", "_speed_at"},
    "flow/self_check": {"_presses", "blame"},
    "events/event_update": {"_force_gone", "_is_over", "_share_a_bound"},
    "contact/enumeration": {"_sweep_slips"},
}
"""By module, what no case enters: ways out of rare difficulties and of faults, run compiled by other tests."""
COMPILING = ("native", "memory")
"""Folders of the engine whose modules compile, or run in Python only."""

pytestmark = pytest.mark.skipif(PLAIN, reason="nothing is compiled")


@pytest.mark.slow
@pytest.mark.timeout(390)
def test_compiled_and_plain_agree(tmp_path: Path) -> None:
    """Events and words alike, numbers to 1e-12 of the largest of their kind; and the cases enter the whole engine.

    One test, as the plain cases take an interpreter of their own and some two minutes, more where others work, too.
    """
    plain, entered = _plain(tmp_path / "numbers")
    for name, case in CASES.items():
        _compare(name, plain[name], case())
    assert _missed(entered) == {}, "add a case to tests/engine/plain_cases.py"


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


def _missed(entered: set[str]) -> dict[str, set[str]]:
    """Return the functions of the engine, by module, that no case enters, but for those listed."""
    missed: dict[str, set[str]] = {}
    folder = Path(engine.__path__[0])
    for path in folder.rglob("*.py"):
        module = path.relative_to(folder).with_suffix("").as_posix()
        if not module.startswith(COMPILING):
            names = {line[4 : line.index("(")] for line in path.read_text().splitlines() if line.startswith("def ")}
            names -= NOT_ENTERED.get(module, set())
            if left := {name for name in names if f"{module}.{name}" not in entered}:
                missed[module] = left
    return missed


def test_this_process_is_compiled_unless_asked() -> None:
    """The switch is read from the environment."""
    assert (os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")) == PLAIN
