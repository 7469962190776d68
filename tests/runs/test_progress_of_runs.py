"""The bar of `simulate`: on a terminal only, after some seconds, and without an effect on the run."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball
from nonsmooth.progress import displays


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def _run(build: Any, **more: Any) -> ns.Solution:
    ball = Ball(0.01)
    system = build.over(ball, restitution=0.8, friction=0.0)
    system.place(ball, position=(0.0, 0.0, 0.11))
    return ns.simulate(system, 0.5, until=lambda run: False, **more)


def test_a_long_run_on_a_terminal_shows_a_bar(build: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a condition each step is reported, so that this short run counts as long."""
    plain = _run(build)
    terminal = _Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(displays, "_LONG", -1.0)
    shown = _run(build)
    assert "of 0.5 s" in terminal.getvalue()
    np.testing.assert_array_equal(plain.q, shown.q)
    np.testing.assert_array_equal(plain.events.time, shown.events.time)


@pytest.mark.parametrize("progress", [None, False])
def test_the_bar_can_be_switched_off(build: Any, monkeypatch: pytest.MonkeyPatch, progress: bool | None) -> None:
    terminal = _Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(displays, "_LONG", -1.0)
    _run(build, progress=progress)
    assert terminal.getvalue() == ""
