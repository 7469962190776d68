"""The same bits wherever runs are done, and however often their processes die."""

from __future__ import annotations

import contextlib
import importlib
import os
import re
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.interfaces import Scenario
from nonsmooth.plugins import file
from nonsmooth.studies import status
from nonsmooth.studies.dask import Parcel, SchedulerLost
from nonsmooth.studies.status import CaseStatus
from nonsmooth.studies.study_folder import StudyFolder
from tests.studies import ball

pytest.importorskip("zarr", "3.1.3")
pytestmark = pytest.mark.slow
"""Processes start, die and start again."""


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the digest of the study, done one run after another."""
    return ball.digest(ball.study().run(tmp_path_factory.mktemp("serial") / "s.zarr", executor="serial"))


@contextlib.contextmanager
def _two_processes() -> Iterator[Any]:
    dask, distributed = pytest.importorskip("dask"), pytest.importorskip("distributed")
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 2}),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as made,
    ):
        yield made


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Return a cluster of two processes that all live."""
    with _two_processes() as made:
        yield made


@pytest.fixture
def mortal_cluster() -> Iterator[Any]:
    """Return a cluster whose processes a test may kill: dask replaces them at some later time, or not at all."""
    with _two_processes() as made:
        yield made


@pytest.mark.parametrize("chunk", [1, 10, 100])
def test_two_threads_give_the_same_bits(serial: str, tmp_path: Path, chunk: int) -> None:
    assert ball.digest(ball.study().run(tmp_path / "s.zarr", executor=studies.Threads(2), chunk=chunk)) == serial


@pytest.mark.parametrize("chunk", [1, 10, 100])
def test_two_processes_give_the_same_bits(serial: str, tmp_path: Path, chunk: int, cluster: Any) -> None:
    executor = studies.Dask(cluster.scheduler_address)
    assert ball.digest(ball.study().run(tmp_path / "s.zarr", executor=executor, chunk=chunk)) == serial


def test_a_worker_that_is_killed_costs_nothing(tmp_path: Path, mortal_cluster: Any) -> None:
    executor = studies.Dask(mortal_cluster.scheduler_address)
    path = tmp_path / "s.zarr"

    def kill() -> None:
        while len(list(path.glob("status/c.*"))) < 2:
            time.sleep(0.02)
        os.kill(next(iter(mortal_cluster.workers.values())).pid, signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    found = ball.slow_study().run(path, executor=executor, chunk=5)
    killer.join()
    whole = ball.slow_study().run(tmp_path / "whole.zarr", executor="serial")
    assert ball.digest(found) == ball.digest(whole)


def test_the_run_that_kills_its_worker_is_found(
    tmp_path: Path, mortal_cluster: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mortal_cluster.scheduler, "allowed_failures", 1)
    # one is not enough: a task can come to a worker whose end is not known yet; each one more costs seconds
    heights = [0.01, 0.02, 0.03, 0.05, 0.06]
    study = studies.Study(ball.deadly, studies.grid(height=heights), ball.RECORD, t_end=ball.T_END)
    found = study.run(tmp_path / "s.zarr", executor=studies.Dask(mortal_cluster.scheduler_address), chunk=4)
    ends = [CaseStatus.CRASHED.code if height == 0.05 else CaseStatus.DONE.code for height in heights]
    assert found.status.values.tolist() == ends
    assert found.reason.values[3] == status.WORKER_DIED
    assert "died" in StudyFolder(tmp_path / "s.zarr").texts()[3]
    assert (found.impacts >= 0).sum() == 4


_FALLING = """
from dataclasses import dataclass

from bodies import Ball
from nonsmooth import System
from nonsmooth.interfaces import Scenario
from nonsmooth.parameters import parameter


@dataclass(frozen=True)
class Falling(Scenario):
    title = "A ball that falls"
    t_end: float = parameter(0.1, doc="end time", unit="s", above=0.0)

    def build(self):
        system = System([Ball(0.01)])
        system.place(system.bodies[0], position=(0.0, 0.0, 1.0))
        return system

    def acceptance(self, solution):
        return ()
"""


def _falling(folder: Path) -> studies.Study:
    (folder / "falling.py").write_text(_FALLING, encoding="utf-8")
    scenario = file.load("scenario", (Scenario,), f"{folder}/falling.py:Falling")()
    return studies.Study(scenario, studies.grid(t_end=[0.1, 0.2]), ["u_end"])


def test_other_processes_find_a_class_of_a_file(tmp_path: Path, cluster: Any) -> None:
    executor = studies.Dask(cluster.scheduler_address)
    found = _falling(tmp_path).run(tmp_path / "s.zarr", executor=executor)
    np.testing.assert_allclose(found.u_end[:, 2], [-0.981, -1.962], rtol=1e-12)


def test_a_file_that_is_another_one_by_now_is_refused(tmp_path: Path) -> None:
    _falling(tmp_path)
    parcel = Parcel.of(ball.study()._work)
    assert parcel.fault() == ""
    (tmp_path / "falling.py").write_text("", encoding="utf-8")
    assert re.search(r"must find the file that the study was begun with.*falling\.py", parcel.fault())


def test_workers_without_the_module_are_refused(tmp_path: Path, cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "only_here.py").write_text(
        "from tests.studies.ball import drop as made\n\ndef drop(height):\n    return made(height)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    study = studies.Study(
        importlib.import_module("only_here").drop, studies.grid(height=[0.01]), ["impacts"], t_end=0.1
    )
    with pytest.raises(ns.InvalidInput, match=r"must find what the study runs.*only_here.*PYTHONPATH"):
        study.run(tmp_path / "s.zarr", executor=studies.Dask(cluster.scheduler_address))
    assert (studies.open_study(tmp_path / "s.zarr").status == CaseStatus.NOT_RUN.code).all()


def test_a_scheduler_that_ends_is_told_and_the_study_goes_on(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    path = tmp_path / "s.zarr"
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as made:

        def end() -> None:
            while not list(path.glob("status/c.*")):
                time.sleep(0.02)
            made.close()

        ender = threading.Thread(target=end)
        ender.start()
        with pytest.raises(SchedulerLost, match="Complete chunks stay"):
            ball.slow_study().run(path, executor=studies.Dask(made.scheduler_address), chunk=5)
        ender.join()
    whole = ball.slow_study().run(tmp_path / "whole.zarr", executor="serial")
    assert ball.digest(ball.slow_study().run(path, executor="serial")) == ball.digest(whole)


def test_no_scheduler_is_told_within_seconds(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    began = time.monotonic()
    with pytest.raises(ns.InvalidInput, match=r"must answer within 5 s.*127.0.0.1:9.*dask scheduler"):
        ball.study().run(tmp_path / "s.zarr", executor=studies.Dask("tcp://127.0.0.1:9"))
    assert time.monotonic() - began < 20.0


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda path: ball.study().run(path, executor="thread"), ("executor", "Did you mean 'threads'")),
        (lambda path: ball.study().run(path, chunk=0), ("chunk", "positive", "0")),
        (lambda path: studies.Threads(0), ("Threads: n", "positive", "0")),
        (lambda path: studies.Dask(n=0), ("Dask: n", "positive", "0")),
    ],
)
def test_bad_requests_are_refused(tmp_path: Path, make: Callable[[Path], Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ns.InvalidInput) as error:
        make(tmp_path / "s.zarr")
    for word in words:
        assert word in str(error.value)
    assert not (tmp_path / "s.zarr").exists()
