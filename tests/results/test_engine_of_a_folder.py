"""A folder says which engine ran; where that cannot be loaded, it still tells what was stored."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball
from nonsmooth.results.solution_folder import SolutionFolder
from tests.runs.own_engine import Midpoint


def _falling() -> ns.System:
    ball = Ball(0.02)
    system = ns.System([ball])
    system.place(ball, position=(0.0, 0.0, 1.0), velocity=(1.0, 0.0, 0.0))
    return system


def _said(folder: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads(SolutionFolder.opened(ns.Output(folder)).attributes["engine"])
    return found


def test_the_folder_names_the_built_in_engine_with_its_options(tmp_path: Path) -> None:
    """Also where all of them are the defaults."""
    ns.simulate(_falling(), 0.1, output=tmp_path)
    said = _said(tmp_path)
    assert (said["type"], said["tolerance"]) == ("event_driven", 1e-9)
    assert ns.open_solution(tmp_path).track.engine == ns.EventDriven()


def test_an_engine_that_is_not_installed_costs_only_what_it_would_compute(tmp_path: Path) -> None:
    """The system is there, states and energies at the samples are; what needs the engine asks for it."""
    ran = ns.simulate(_falling(), 0.1, sample_interval=0.01, engine=Midpoint(2e-3), output=tmp_path)
    assert _said(tmp_path) == {"type": "tests.runs.own_engine:Midpoint", "step": "0.002"}
    found = ns.open_solution(tmp_path)
    np.testing.assert_array_equal(found.q, ran.q)
    for name in ("kinetic_energy", "position"):
        np.testing.assert_array_equal(found.history(name)[name], ran.history(name)[name])
    with pytest.raises(ns.InvalidInput, match="is known between its samples only where"):
        found.at(0.055)
    assert ns.open_solution(tmp_path, engine=Midpoint(2e-3)).track.engine == Midpoint(2e-3)


@pytest.mark.slow
def test_a_run_that_was_cut_off_asks_for_its_engine(tmp_path: Path) -> None:
    """To go on with another one would be another run, and so would be one with other options."""

    def stop(t: float, t_end: float) -> None:
        raise KeyboardInterrupt

    cut = ns.simulate(_falling(), 0.5, engine=Midpoint(), output=tmp_path, progress=stop)
    assert cut.status == "interrupted"
    with pytest.raises(ns.InvalidInput, match=r"must be one that is installed.*Midpoint.*engine="):
        ns.resume(tmp_path)
    with pytest.raises(ns.InvalidInput, match="same options"):
        ns.resume(tmp_path, engine=Midpoint(2e-3))
    whole = ns.simulate(_falling(), 0.5, engine=Midpoint())
    np.testing.assert_array_equal(ns.resume(tmp_path, engine=Midpoint()).q_end, whole.q_end)
