"""The same source compiled and as plain Python gives the same run."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth.engine.kernel import PLAIN

SCRIPT = """
import math, sys
import numpy as np
import nonsmooth as ns
from bodies import Dumbbell, Harmonic, Plate
from laws import (
    Anisotropic, Bristle, Coulomb, EnergeticImpact, HuntCrossley, NewtonImpact, RateAndState, Unilateral,
)
from nonsmooth.engine.kernel import PLAIN

def run(laws, periods, skew):
    plate = Plate(Harmonic(amplitude=0.9 * 9.81 / (50 * math.pi) ** 2, frequency=25.0))
    body = Dumbbell()
    system = ns.System([plate, body])
    system.contact(plate, body, **laws)
    half, tilt = body.centre_distance / 2, math.radians(10)
    system.place(
        body,
        position=(half * math.cos(tilt), 0, body.radius + half * math.sin(tilt)),
        orientation=(math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0),
        velocity=(0, skew, 0),
    )
    return ns.simulate(system, periods / 25.0)

out = {"plain": PLAIN}
def rigid(impact, friction=Coulomb(0.2, 0.25)):
    return {"normal": Unilateral(), "friction": friction, "impact": impact}

def soft(friction):
    return {"normal": HuntCrossley(1e8, 0.5), "friction": friction}

for name, laws, periods, skew in (
    ("drift", rigid(EnergeticImpact(0.65)), 10, 0.0),
    ("skew", rigid(EnergeticImpact(0.65)), 2, 1.0),
    ("newton", rigid(NewtonImpact(0.65)), 1, 0.1),
    ("compliant", soft(Coulomb(0.2, 0.25)), 2, 0.1),
    ("bristle", soft(Bristle(0.2, 0.25)), 2, 0.1),
    ("anisotropic", rigid(EnergeticImpact(0.65), Anisotropic(0.2, 0.3)), 1, 0.1),
    ("rate_and_state", rigid(EnergeticImpact(0.65), RateAndState(0.2, 0.01, 0.02, 1e-3, 1e-4)), 1, 0.1),
):
    s = run(laws, periods, skew)
    out |= {f"{name}_q": s.q, f"{name}_u": s.u, f"{name}_time": s.events.time, f"{name}_cause": s.events.cause,
            f"{name}_after": s.events.after, f"{name}_impulse": s.events.impulse, f"{name}_residual": s.energy.residual}
np.savez(sys.argv[1], **out)
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """Run the script compiled and plain, each in its own interpreter."""
    folder = tmp_path_factory.mktemp("plain")
    script = folder / "script.py"
    script.write_text(SCRIPT)
    root = str(Path(__file__).parents[2])
    processes = []
    for mode in ("0", "1"):
        environment = os.environ | {"NONSMOOTH_PLAIN": mode, "PYTHONPATH": root}
        command = [sys.executable, str(script), str(folder / f"{mode}.npz")]
        processes.append(subprocess.Popen(command, env=environment, stderr=subprocess.PIPE))
    for process in processes:
        _, errors = process.communicate()
        assert process.returncode == 0, errors.decode()
    return [np.load(folder / f"{mode}.npz") for mode in ("0", "1")]


def test_the_switch_switches(runs: list[Any]) -> None:
    """One run was compiled, the other was not."""
    assert [bool(run["plain"]) for run in runs] == [False, True]


@pytest.mark.parametrize("name", ["drift", "skew", "newton", "compliant", "bristle", "anisotropic", "rate_and_state"])
def test_compiled_and_plain_agree(runs: list[Any], name: str) -> None:
    """Ten periods of drift, two of a skew start, some with other laws: events alike, states to 1e-12."""
    compiled, plain = runs
    np.testing.assert_array_equal(plain[f"{name}_cause"], compiled[f"{name}_cause"])
    np.testing.assert_array_equal(plain[f"{name}_after"], compiled[f"{name}_after"])
    np.testing.assert_allclose(plain[f"{name}_time"], compiled[f"{name}_time"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(plain[f"{name}_q"], compiled[f"{name}_q"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(plain[f"{name}_u"][:, :3], compiled[f"{name}_u"][:, :3], rtol=0, atol=1e-12)
    scale = np.max(np.abs(compiled[f"{name}_u"]))
    np.testing.assert_allclose(plain[f"{name}_u"], compiled[f"{name}_u"], rtol=0, atol=1e-12 * scale)
    assert len(compiled[f"{name}_cause"]) > 10


def test_this_process_is_compiled_unless_asked() -> None:
    """The switch is read from the environment."""
    assert (os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")) == PLAIN
