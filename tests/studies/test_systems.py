"""Systems and files without a scenario: all numbers of theirs can be varied, by the dotted keys of a file."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth import studies
from nonsmooth.engine.native.kernel import PLAIN

E, HEIGHT, G = 0.7, 0.1, 9.81
RESTITUTION, RADIUS, PLACE = "laws.energetic.restitution", "bodies.ball.radius", "bodies.ball.start.q.2"


def _dropped(restitution: float = E, radius: float = 0.01) -> ns.System:
    plate, ball = Plate(), Ball(radius)
    system = ns.System([plate, ball], gravity=G)
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(restitution))
    system.place(ball, position=(0.0, 0.0, HEIGHT + 0.01))
    return system


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="compares derivatives with closed forms, at length in plain mode")
def test_derivatives_by_numbers_of_a_system() -> None:
    """A ball that is larger strikes sooner, by as much as one that begins lower; gravity changes both its flights."""
    t = 0.2
    found = studies.sensitivity(_dropped(), (PLACE, RADIUS, RESTITUTION, "gravity"), at=[t])
    struck, speed = math.sqrt(2.0 * HEIGHT / G), math.sqrt(2.0 * HEIGHT * G)
    by_gravity = E * 0.5 * speed / G - (t - struck) - 0.5 * struck
    expected = [(1.0 + E) / struck, -(1.0 + E) / struck, speed, by_gravity]
    np.testing.assert_allclose(found.u_by[0, 2], expected, rtol=1e-8)
    assert found.family.units[RADIUS] == "m"


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
def test_a_fit_passes_over_starts_that_overlap() -> None:
    """Of the heights that are tried some are within the plate."""
    times = np.linspace(0.02, 0.3, 12)
    heights = studies.Family.of(_dropped()).model().run(0.3).at(times)["q"][:, 2]
    bounds = {PLACE: (0.002, 0.2), RESTITUTION: (0.5, 0.9)}
    begin = _dropped(restitution=0.6)
    found = studies.fit(begin, bounds, at=times, measured=heights, observe=lambda state: state.q[2], starts=16)
    assert found.values[PLACE] == pytest.approx(HEIGHT + 0.01, abs=1e-7)
    assert found.values[RESTITUTION] == pytest.approx(E, abs=1e-6)
    with pytest.raises(ns.InvalidInput, match="observe must return finite numbers"):
        studies.fit(begin, bounds, at=times, measured=heights, observe=lambda state: math.nan, starts=1)


def test_a_study_of_a_system_has_what_single_runs_have(tmp_path: Path) -> None:
    pytest.importorskip("zarr", "3.1.3")
    axes = {RESTITUTION: [0.5, 0.7], RADIUS: [0.008, 0.01]}
    study = studies.Study(_dropped(), studies.grid(**axes), ["q_end", "impacts"], t_end=0.3)
    found = study.run(tmp_path / "s.zarr", executor="serial")
    assert found[RADIUS].attrs == {"units": "m", "long_name": "radius"}
    for e in axes[RESTITUTION]:
        for radius in axes[RADIUS]:
            run = ns.simulate(_dropped(e, radius), 0.3)
            row = found.sel({RESTITUTION: e, RADIUS: radius})
            assert row.q_end.values.tobytes() == run.q_end.tobytes()
            assert row.impacts == run.counters.impacts
    other = studies.Study(_dropped(restitution=0.6), studies.grid(**axes), ["q_end", "impacts"], t_end=0.3)
    with pytest.raises(ns.InvalidInput, match="must hold the study that goes on there"):
        other.run(tmp_path / "s.zarr")


_SCRIPT = """
from nonsmooth import studies
from tests.studies.ball import drop
studies.Study(drop, studies.grid(height=[0.1]), ["impacts"], t_end=0.1).run("s.zarr", executor="dask")
"""


@pytest.mark.slow
def test_a_script_that_its_processes_would_run_again_is_told(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "script.py").write_text(_SCRIPT, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "script.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert ended.returncode == 1
    assert 'under `if __name__ == "__main__":`' in ended.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: studies.sensitivity(_dropped(), ("radius",), at=[0.1]), "Did you mean 'bodies.ball.radius'"),
        (lambda: studies.Study(_dropped(), studies.grid(gravity=[9.0]), ["impacts"]), "t_end must be positive"),
        (lambda: studies.sensitivity(3, ("radius",), at=[0.1]), "must be of a scenario, a system or a family"),  # type: ignore[arg-type]
    ],
)
def test_what_is_refused(make: Callable[[], Any], told: str) -> None:
    with pytest.raises(ns.InvalidInput, match=told):
        make()
