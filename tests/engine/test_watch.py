"""Progress and Ctrl-C in the middle of what takes long; nothing unfinished is kept."""

from __future__ import annotations

import _thread
import gc
import importlib
import signal
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth import watch
from nonsmooth.engine.native.kernel import PLAIN

RADIUS = 0.01
_half = importlib.import_module(f"nonsmooth.engine.native.{'plain' if PLAIN else 'machine_code'}")


@pytest.fixture(autouse=True)
def _ctrl_c() -> Iterator[None]:
    """Python's own handler, which a process in the background of a script is started without."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def _often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watch, "_REPORTED_EVERY", 1e-3)


def _between_two_plates(beside: bool) -> ns.System:
    """Return a ball without loss that touches two plates: an impact without end; another one falls beside."""
    lid = Plate(Rest(position=(0.0, 0.0, 2.0 * RADIUS), orientation=(0.0, 1.0, 0.0, 0.0)))
    plate, ball, free = Plate(), Ball(RADIUS), Ball(RADIUS)
    system = ns.System([plate, lid, free, ball])
    laws: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless()}
    for other in (plate, lid, ball):
        if other is not plate or not beside:
            system.exclude(free, other)
    if beside:
        system.contact(plate, free, **laws, impact=EnergeticImpact(0.5))
    system.contact(plate, ball, **laws, impact=EnergeticImpact(1.0))
    system.contact(lid, ball, **laws, impact=EnergeticImpact(1.0))
    system.place(ball, position=(0.0, 0.0, RADIUS), velocity=(0.0, 0.0, -1.0))
    system.place(free, position=(0.1, 0.0, RADIUS), velocity=(0.0, 0.0, -1.0))
    return system


def _endless(n: int) -> ns.ImpactResult:
    """Solve the impact of points that bounce to and fro between two walls, n of them."""
    normal = np.kron(np.eye(n), [[1.0, -1.0]])
    speeds = -np.linspace(1.0, 2.0, n)
    laws = [EnergeticImpact(1.0)] * (2 * n)
    return ns.solve_impact(np.eye(n), normal, np.zeros((n, 2 * n, 2)), speeds, laws, [Frictionless()] * (2 * n))


def test_an_impact_without_end_says_so() -> None:
    with pytest.raises(ns.RunFailed, match="did not end"):
        _endless(1)


def test_an_impact_alone_is_interrupted() -> None:
    timer = threading.Timer(0.05, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        _endless(20)
    timer.join()


@pytest.mark.usefixtures("_often")
@pytest.mark.parametrize("beside", [False, True])
def test_ctrl_c_in_an_impact_keeps_the_state_before_it(beside: bool, capsys: pytest.CaptureFixture[str]) -> None:
    """Also where the impact is one of two at that instant, the other of which was over; and it is told."""
    times: list[float] = []

    def progress(t: float, t_end: float) -> None:
        times.append(t)
        _thread.interrupt_main()

    solution = ns.simulate(_between_two_plates(beside), 1.0, progress=progress)
    assert times == [0.0]
    assert capsys.readouterr().err.startswith("interrupted at t = 0 s: the run returns what it has")
    assert (solution.status, solution.message, solution.t_end) == ("interrupted", "the run was interrupted", 0.0)
    assert solution.energy.kinetic_end == solution.energy.kinetic_start > 0.0
    assert abs(solution.energy.residual) < 1e-15


def test_a_failed_impact_keeps_the_state_before_it() -> None:
    with pytest.raises(ns.RunFailed, match="did not end") as failed:
        ns.simulate(_between_two_plates(True), 1.0)
    solution = failed.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.energy.kinetic_end == solution.energy.kinetic_start > 0.0
    assert abs(solution.energy.residual) < 1e-15


@pytest.mark.usefixtures("_often")
def test_what_the_report_raises_ends_the_run() -> None:
    def progress(t: float, t_end: float) -> None:
        raise ZeroDivisionError("of the user's own")

    with pytest.raises(ZeroDivisionError, match="of the user's own"):
        ns.simulate(_between_two_plates(False), 1.0, progress=progress)


@pytest.mark.usefixtures("_often")
def test_runs_in_other_threads_report_there() -> None:
    """Where no signal is served; the handler of the main thread stays in place."""
    reported: list[int] = []

    def progress(t: float, t_end: float) -> None:
        reported.append(threading.get_ident())
        raise KeyboardInterrupt

    solutions: list[ns.Solution] = []
    thread = threading.Thread(
        target=lambda: solutions.append(ns.simulate(_between_two_plates(False), 1.0, progress=progress))
    )
    thread.start()
    thread.join()
    assert reported == [thread.ident]
    assert solutions[0].status == "interrupted"


def test_a_watch_that_was_given_up_looks_again_in_the_next_run() -> None:
    """As a second Ctrl-C does it, which comes while the first is taken."""
    model = ns.assemble(_between_two_plates(False))
    model._laid.watch._looks.close()

    def progress(t: float, t_end: float) -> None:
        raise ZeroDivisionError("of the user's own")

    with pytest.MonkeyPatch.context() as often:
        often.setattr(watch, "_REPORTED_EVERY", 1e-3)
        with pytest.raises(ZeroDivisionError, match="of the user's own"):
            model.run(1.0, progress=progress)


@pytest.mark.slow
def test_a_model_leaves_no_watch_behind() -> None:
    gc.collect()
    before = len(_half.watches)
    models = [ns.assemble(_between_two_plates(False)) for _ in range(3)]
    with pytest.raises(ns.RunFailed, match="did not end"):
        models[0].run(1.0)
    del models
    gc.collect()
    assert len(_half.watches) == before
