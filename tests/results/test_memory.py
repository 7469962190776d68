"""With an output folder the memory of a run does not grow with its events."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.runs import folder_sink
from nonsmooth.runs.so_far import RunSoFar
from nonsmooth.solution import events
from nonsmooth.solution.checks import friction_gain
from nonsmooth.solution.csv_tables import events_table
from tests.results.runs import balls
from tests.runs.continued import differences

ROOT = Path(__file__).parents[2]
CHILD = """
import resource, sys
import nonsmooth as ns
from nonsmooth.runs import folder_sink
from tests.results.runs import bouncing
folder_sink._LARGEST_SIZE = 1 << 21
model = ns.assemble(bouncing())
model.run(1.0, sample_interval=1.0, output=sys.argv[1] + "/first")
solution = model.run(float(sys.argv[2]), sample_interval=1.0, output=sys.argv[1] + "/second")
print(len(solution.events), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a run drop what is written after few events."""
    monkeypatch.setattr(events, "_BLOCK", 7)
    for name, value in (("_LARGEST_SIZE", 10_000), ("_COMMIT_INTERVAL", 0.0), ("_FIRST_COMMIT", 0.0)):
        monkeypatch.setattr(folder_sink, name, value)
    monkeypatch.setattr(folder_sink, "_MOST_STEPS", 64)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the resident memory has other units elsewhere")
def test_memory_does_not_grow_with_events(tmp_path: Path) -> None:
    """Of 40 000 more events, which take 30 MB, a quarter at most is in memory."""
    found = []
    for t_end in ("600", "2100"):
        folder = tmp_path / t_end
        folder.mkdir()
        ran = subprocess.run(
            [sys.executable, "-c", CHILD, str(folder), t_end], cwd=ROOT, capture_output=True, text=True, check=True
        )
        found.append([int(word) for word in ran.stdout.split()])
    (few, before), (many, after) = found
    assert many - few > 35_000
    assert after - before < 8_000, "kB"


@pytest.mark.usefixtures("small")
def test_a_run_whose_events_were_dropped_is_the_same(tmp_path: Path) -> None:
    """To the last bit, also the events that a condition sees, and the energy that friction added."""
    whole, seen = ns.simulate(balls(), 1.0), list[int]()

    def until(run: RunSoFar) -> bool:
        seen.append(len(run.events))
        assert run.n_events == len(run.events)
        return False

    run = ns.simulate(balls(), 1.0, output=tmp_path)
    assert "time" not in vars(run.recorded.earlier), "read before it is used"
    assert differences(whole, run) == []
    assert repr(run) == repr(whole)
    assert events_table(run) == events_table(whole)
    assert friction_gain(run) == pytest.approx(friction_gain(whole), abs=1e-18)
    np.testing.assert_array_equal(run.events.first, whole.events.first)
    ns.simulate(balls(), 0.1, output=tmp_path / "until", until=until)
    assert seen == sorted(seen)
    assert seen[-1] > 5


@pytest.mark.usefixtures("small")
def test_a_copy_of_a_solution_needs_no_folder(tmp_path: Path) -> None:
    import pickle
    import shutil

    run = ns.simulate(balls(), 1.0, output=tmp_path / "run")
    copy, opened = pickle.loads(pickle.dumps(run)), ns.open_solution(tmp_path / "run")
    shutil.rmtree(tmp_path / "run")
    assert differences(ns.simulate(balls(), 1.0), copy) == []
    with pytest.raises(ns.InvalidInput, match="must be a whole chunk"):
        _ = opened.events.time
