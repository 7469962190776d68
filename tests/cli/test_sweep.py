"""``nonsmooth sweep`` and ``nonsmooth study``."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth import studies
from nonsmooth.cli.main import main

pytest.importorskip("zarr", "3.1.3")

Call = Callable[..., tuple[int, str, str]]
SET = ("--set", "t_end=0.1", "--executor", "serial")


@pytest.mark.slow
def test_a_sweep_its_status_and_its_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.zarr"
    over = "--over", "restitution=0.5:0.9:3", "--over", "gamma=0.3,0.6"
    assert main(["sweep", "bouncing_ball", *over, *SET, "--record", "impacts", "--out", str(path)]) == 0
    assert re.match(r"6 runs: 6 done\n  impacts: \d+ to \d+\n", capsys.readouterr().out)
    found = studies.open_study(path)
    assert found.restitution.values.tolist() == [0.5, 0.7, 0.9]
    for number in "2", "5":
        (path / "status" / f"c.{number}").unlink()
    assert main(["study", "status", str(path)]) == 0
    assert "6 runs: 2 not run, 4 done" in (told := capsys.readouterr().out)
    assert "4 of 6 chunks are stored" in told
    assert main(["study", "resume", str(path), "--executor", "serial"]) == 0
    assert studies.open_study(path).identical(found)
    assert main(["study", "draw", str(path)]) == 0
    assert path.with_suffix(".png").stat().st_size > 1000
    assert main(["study", "draw", str(path)]) == 2


def test_the_components_of_a_vector_are_printed_and_drawn(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "s.zarr"
    words = ("--over", "friction=0.1,0.3", "--set", "t_end=0.4", "--record", "drift_velocity", "--executor", "serial")
    status, output, _ = call("sweep", "dumbbell", *words, "--out", str(path))
    assert status == 0
    assert re.search(r"^  drift_velocity\[0\]: .* m/s\n  drift_velocity\[1\]: .* m/s$", output, re.MULTILINE)
    assert call("study", "draw", str(path))[0] == 0
    assert path.with_suffix(".png").stat().st_size > 1000


@pytest.mark.slow
def test_draws(tmp_path: Path) -> None:
    draw = "--over", "gamma=0.3:0.9", "--over", "restitution=0.5:0.9", "--sample", "sobol:4", "--seed", "1"
    assert main(["sweep", "bouncing_ball", *draw, *SET, "--out", str(tmp_path / "s.zarr")]) == 0
    found = studies.open_study(tmp_path / "s.zarr")
    assert dict(found.sizes) == {"run": 4}
    assert main(["study", "draw", str(tmp_path / "s.zarr"), "--out", str(tmp_path / "p.png")]) == 0


@pytest.mark.fast_cases(7)
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--over", "gama=1:2:3"], "Did you mean 'gamma'"),
        (["--over", "gamma"], "NAME=VALUES"),
        (["--over", "gamma=2:1:3"], "lower end first"),
        (["--over", "gamma=1:2:x"], "whole number"),
        (["--over", "gamma=1:b:3"], "LOW:HIGH:N"),
        (["--over", "gamma=1:2"], "LOW:HIGH:N"),
        (["--over", "gamma=1:2"], "or 0.5:0.9 for a range, with --sample."),
        (["--over", "gamma=-1:2:3"], "must be >= 0"),
        (["--over", "gamma=nan:2:3"], "lower end first"),
        (["--over", "gamma=1:2:3", "--over", "gamma=1,2"], "come once"),
        ([], "at least"),
        (["--over", "gamma=1:2", "--sample", "sobol:5"], "power of two"),
        (["--over", "gamma=1:2", "--sample", "sobl:4"], "Did you mean 'sobol'"),
        (["--over", "gamma=1:2:3", "--record", "impact"], "Did you mean 'impacts'"),
        (["--over", "gamma=1:2:3", "--set", "gamma=1"], "must be left out with --over gamma"),
        (["--over", "gamma=1:2:3", "--chunk", "0"], "positive whole number of runs"),
        (["--over", "gamma=1:2:3", "--executor", "thread"], "Did you mean 'threads'"),
    ],
)
def test_wrong_requests(words: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "bouncing_ball", *words, "--out", str(tmp_path / "s.zarr")]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "s.zarr").exists()


def test_why_runs_have_no_records_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("--over", "gamma=1:2:3", "--budget", "5", "--record", "impacts", "--out", str(tmp_path / "s.zarr"))
    assert main(["sweep", "bouncing_ball", *words]) == 0
    assert "3 runs have no records; the first is run 0: At t = " in capsys.readouterr().err


def test_what_is_no_study(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for what in "status", "resume", "verify", "draw":
        assert main(["study", what, str(tmp_path / "none.zarr")]) == 2
        assert "must hold a study" in capsys.readouterr().err


_FILE = """
t_end = 0.3
[bodies.floor]
type = "plate"
[bodies.ball]
type = "ball"
radius = 0.01
start = { position = [0.0, 0.0, 0.05] }
[[contacts]]
between = ["floor", "ball"]
normal = "unilateral"
friction = "frictionless"
impact = { type = "energetic", restitution = 0.6 }
"""


@pytest.mark.slow
def test_a_file_is_swept_and_goes_on(call: Call, tmp_path: Path) -> None:
    file, path = tmp_path / "drop.toml", tmp_path / "s.zarr"
    file.write_text(_FILE, encoding="utf-8")
    words = ("--over", "bodies.ball.start.position.2=0.03,0.05", "--set", "contacts.0.impact.restitution=0.5")
    assert call("sweep", str(file), *words, "--record", "q_end", "--out", str(path))[0] == 0
    before = studies.open_study(path).q_end.values
    (path / "status" / "c.1").unlink()
    assert call("study", "resume", str(path))[0] == 0
    assert studies.open_study(path).q_end.values.tobytes() == before.tobytes()
    status, _, errors = call("sweep", str(file), "--over", "bodies.ball.radus=0.01,0.02", "--out", f"{path}.2")
    assert status == 2
    assert f"parameter of {file}" in errors
    assert "Did you mean 'bodies.ball.radius'" in errors
    status, _, errors = call("sweep", str(file), "--over", "bodies.ball.radius=-0.01,0.02", "--out", f"{path}.2")
    assert status == 2
    assert "bodies.ball.radius must be > 0 [m]" in errors
