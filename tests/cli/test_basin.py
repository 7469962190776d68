"""``nonsmooth basin``: what it prints and draws, how it goes on, and what it refuses."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth import studies
from nonsmooth.engine.native.kernel import PLAIN

pytest.importorskip("zarr", "3.1.3")
pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")

Call = Callable[..., tuple[int, str, str]]
STARTS = ("--over", "start_phase=0:6:3", "--over", "speed=0.05,0.2,0.42", "--set", "gamma=0.8", "--set", "t_end=4")
STROBE = ("--period", "0.04", "--at", "0.02", "--phase", "start_phase", "--within", "z,vz", "--keep", "16")


def _pictures(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.png"))


@pytest.mark.slow
def test_attractors_by_recurrences_which_go_on(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "s.zarr"
    status, output, errors = call("basin", "bouncing_ball", *STARTS, *STROBE, "--out", str(path))
    assert status == 0
    shares = [float(share) for share in re.findall(r"^A\d_period_\d: basin stability (\S+) ±", output, re.M)]
    assert shares == sorted(shares, reverse=True)
    assert sum(shares) == pytest.approx(1.0, abs=2e-4)
    assert "no uncertainty exponent" in errors
    assert _pictures(tmp_path / "s") == ["basins", "shares"]
    (path / "status" / "c.5").unlink()
    status, _, errors = call("basin", "bouncing_ball", *STARTS, *STROBE, "--out", str(path))
    assert status == 2
    assert "--overwrite" in errors
    assert call("study", "resume", str(path))[0] == 0
    assert (studies.open_study(path).status == 1).all()
    along = "--along", "speed=0.5", "--figures", str(tmp_path / "more")
    status, _, _ = call("basin", "bouncing_ball", *STARTS, *STROBE, "--out", str(path), *along)
    assert status == 0
    assert _pictures(tmp_path / "more") == ["basins", "fractions", "shares"]


@pytest.mark.slow
def test_the_classifier_of_the_scenario_with_failures_apart(call: Call, tmp_path: Path) -> None:
    words = ("--over", "phase=0,3", "--over", "beta0=-0.1,0.01,0.2", "--set", "mode=free", "--set", "t_end=1")
    status, output, _ = call("basin", "dumbbell", *words, "--along", "beta0", "--out", str(tmp_path / "s.zarr"))
    assert status == 0
    assert "2 runs failed" in output
    told = studies.basin_stability(studies.open_study(tmp_path / "s.zarr").attractor)
    for word, (share, error) in told.items():
        assert (f"{word}: basin stability {share:.4f} ± {error:.4f}" in output) == (share > 0.0)
    assert _pictures(tmp_path / "s") == ["basins", "fractions", "shares"]


@pytest.mark.slow
def test_features_and_the_exponent_of_a_smooth_boundary(call: Call, tmp_path: Path) -> None:
    """The number of bounces within a short time changes across curves."""
    starts = ("--over", "start_phase=0:1.5:32", "--over", "speed=0.15:0.4:32", "--set", "t_end=0.05")
    status, output, _ = call(
        "basin", "bouncing_ball", *starts, "--features", "impacts=0.5", "--out", str(tmp_path / "s.zarr")
    )
    assert status == 0
    found = re.search(r"uncertainty exponent of the boundary (\S+) ± (\S+)", output)
    assert found is not None
    assert float(found[1]) == pytest.approx(1.0, abs=0.1)
    assert _pictures(tmp_path / "s") == ["basins", "shares", "uncertainty"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ((), "Give --period and --within, or --features"),
        (("--period", "0.04"), "--within must be given"),
        (("--within", "z"), "--period must be given"),
        ((*STROBE, "--features", "impacts=1"), "--features must be left out"),
        (("--features", "impacts"), "NAME=TOLERANCE"),
        (("--features", "impact=1"), "Did you mean 'impacts'"),
        ((*STROBE, "--along", "speed"), "NAME=TOLERANCE"),
        ((*STROBE, "--along", "gamma=1"), "--along must name a parameter of --over"),
        ((*STROBE[:-2], "--keep", "500"), "short enough for a run of 4 s"),
    ],
)
def test_wrong_requests(words: tuple[str, ...], told: str, call: Call, tmp_path: Path) -> None:
    status, _, errors = call("basin", "bouncing_ball", *STARTS, *words, "--out", str(tmp_path / "s.zarr"))
    assert status == 2
    assert told in errors
    assert not list(tmp_path.iterdir())
