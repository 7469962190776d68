"""A store is whole, or goes on: killed clients, torn chunks, damage, other studies, a full disk."""

from __future__ import annotations

import importlib
import linecache
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.cli.main import main
from nonsmooth.studies.study_folder import StudyFolder
from tests.studies import ball

pytest.importorskip("zarr", "3.1.3")


@pytest.fixture(scope="module")
def whole() -> str:
    """Return the digest of the slow study, done at once."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return ball.digest(ball.slow_study().run(Path(folder) / "s.zarr", executor="serial", chunk=5))


def _client(path: Path, executor: str = "threads") -> subprocess.Popen[str]:
    """Start another process that runs the slow study, and wait until a part of it is stored."""
    code = f"from tests.studies import ball; ball.slow_study().run({str(path)!r}, executor={executor!r}, chunk=5)"
    client = subprocess.Popen([sys.executable, "-c", code], text=True)
    for _ in range(1200):
        if len(list(path.glob("status/c.*"))) >= 2:
            return client
        time.sleep(0.05)
    client.kill()
    raise AssertionError("nothing was stored within a minute")


@pytest.mark.slow
def test_a_client_that_is_killed_goes_on_to_the_same_bits(tmp_path: Path, whole: str) -> None:
    path = tmp_path / "s.zarr"
    client = _client(path)
    with pytest.raises(ns.InvalidInput, match="one run at a time that writes"):
        ball.slow_study().run(path)
    os.kill(client.pid, signal.SIGKILL)
    client.wait()
    assert 2 <= len(StudyFolder(path).committed()) < 12
    assert not studies.open_study(path).status.values.all()
    torn = path / "impacts" / ".c.11.part"  # what a chunk is called before it is whole
    torn.write_bytes(b"half")
    (path / "impacts" / "c.11").write_bytes(b"torn")  # of a chunk that was not committed
    assert ball.digest(ball.slow_study().run(path, executor="serial")) == whole
    assert not torn.exists()
    assert main(["study", "verify", str(path)]) == 0


@pytest.mark.slow
def test_a_study_goes_on_where_it_began_only(tmp_path: Path) -> None:
    path = tmp_path / "s.zarr"
    ball.study(6).run(path, executor="serial", chunk=2)
    before = (path / "status" / "c.0").stat().st_mtime_ns
    ball.study(6).run(path, executor="serial")
    assert (path / "status" / "c.0").stat().st_mtime_ns == before
    with pytest.raises(ns.InvalidInput, match=r"must hold the study that goes on there.*sampling"):
        ball.study(8).run(path)
    with pytest.raises(ns.InvalidInput, match="must be that of the beginning, 2"):
        ball.study(6).run(path, chunk=3)
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.tex").write_text("words")
    with pytest.raises(ns.InvalidInput, match="new or empty folder"):
        ball.study(6).run(other)
    assert (other / "thesis.tex").read_text() == "words"


@pytest.mark.slow
@pytest.mark.parametrize("changed", ["runs", "record"])
def test_a_program_that_was_changed_does_not_go_on_there(
    changed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What functions say decides what runs; the message says where the studies differ."""

    def begin(run: str, record: str) -> None:
        (tmp_path / "program.py").write_text(
            f"from tests.studies.ball import drop\ndef run(height):\n    return {run}\n"
            f"def told(scenario, solution):\n    return {record}\n",
            encoding="utf-8",
        )
        sys.modules.pop("program", None)
        importlib.invalidate_caches()
        linecache.clearcache()
        program = importlib.import_module("program")
        study = studies.Study(program.run, studies.grid(height=[0.01, 0.02]), [program.told], t_end=0.1)
        study.run(tmp_path / "s.zarr", executor="serial")

    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    begin("drop(height)", "1.0")
    begin("drop(height)", "1.0")
    other = {"runs": ("drop(height, 0.6)", "1.0"), "record": ("drop(height)", "2.0")}[changed]
    with pytest.raises(ns.InvalidInput, match=rf"must hold the study that goes on there.*{changed}.* was .* and is "):
        begin(*other)


@pytest.mark.slow
def test_a_study_that_was_cut_off_as_it_was_made_begins_anew(tmp_path: Path) -> None:
    path = tmp_path / "s.zarr"
    whole = ball.digest(ball.study(3).run(path, executor="serial"))
    (path / "zarr.json").unlink()
    assert ball.digest(ball.study(3).run(path, executor="serial")) == whole


@pytest.mark.slow
def test_damage_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.zarr"
    ball.study(6).run(path, executor="serial", chunk=2)
    part = path / "steps" / "c.1"
    content = bytearray(part.read_bytes())
    content[len(content) // 2] ^= 1
    part.write_bytes(bytes(content))
    (path / "impacts" / "c.2").unlink()
    assert main(["study", "verify", str(path)]) == 1
    told = capsys.readouterr()
    assert "3 of 3 chunks are stored, 2 files of them damaged" in told.out
    assert str(part) in told.err


@pytest.mark.slow
def test_a_file_that_cannot_be_written_whole_commits_nothing(tmp_path: Path) -> None:
    limit = "import resource, runpy; resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000));"
    code = (
        f"{limit} from tests.studies import ball; ball.study(3000).run({str(tmp_path / 's.zarr')!r}, executor='serial')"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ran.returncode == 1
    assert "could not be written" in ran.stderr
    assert not list(tmp_path.glob("s.zarr/status/c.*"))


def test_an_array_that_is_gone_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.zarr"
    ball.study(2).run(path, executor="serial")
    shutil.rmtree(path / "impacts")
    for what in "status", "verify":
        assert main(["study", what, str(path)]) == 2
        assert "must have all of its arrays, but it is 'without impacts'" in capsys.readouterr().err


@pytest.mark.parametrize("place", ["status", "writer", "", "q_end/c.0.0"])
def test_nothing_is_written_through_a_link(place: str, tmp_path: Path) -> None:
    """As in a study of another person."""
    path, home = tmp_path / "s.zarr", tmp_path / "home"
    ball.study(4).run(path, executor="serial", chunk=2)
    (path / "status" / "c.0").unlink(missing_ok=True)
    shutil.move(path / place, home)
    (path / place).symlink_to(home)
    before = {one: one.stat().st_mtime_ns for one in [home, *home.rglob("*")]}
    with pytest.raises(ns.InvalidInput, match="must be a file or folder of its own to be written to"):
        ball.study(4).run(path, executor="serial")
    assert {one: one.stat().st_mtime_ns for one in [home, *home.rglob("*")]} == before


def test_a_study_that_another_process_has_begun_meanwhile_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where two processes begin at once, and one has looked before the other one has made it."""
    path = tmp_path / "s.zarr"
    digest = ball.digest(ball.study(4).run(path, executor="serial", chunk=2))
    before = {one: one.stat().st_mtime_ns for one in path.glob("status/c.*")}
    monkeypatch.setattr(importlib.import_module("nonsmooth.studies.study"), "is_study", lambda path: False)
    assert ball.digest(ball.study(4).run(path, executor="serial", chunk=2)) == digest
    assert {one: one.stat().st_mtime_ns for one in path.glob("status/c.*")} == before != {}
