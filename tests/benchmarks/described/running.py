"""Runs of this commit: what is simulated, what it computed, what it consists of."""

from __future__ import annotations

import math
import re
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.plugins import registry
from tests.benchmarks.described.systems import build
from tests.benchmarks.described.vocabulary import WORDS

_PLACE = re.compile(r"\S+\.py, line \d+")


@dataclass(frozen=True)
class Task:
    """A system, its end time and the time between its samples [s]."""

    system: ns.System
    t_end: float
    sample_interval: float

    @classmethod
    def of(cls, request: dict[str, Any]) -> Task:
        """Return the task of a description, or of a scenario: its name, parameters and the part of its time to run.

        Raises
        ------
        NonsmoothError
            If a start or a parameter breaks a rule.
        """
        if "scenario" in request:
            scenario = registry.load("scenarios", request["scenario"])(**request["parameters"])
            t_end = request["part"] * scenario.t_end
            return cls(scenario.build(), t_end, min(scenario.sample_interval, t_end))
        return cls(build(request), request["t_end"], request["sample_interval"])


def prepared(request: dict[str, Any]) -> Callable[[], object]:
    """Return what runs the system of a request, which is built and assembled once."""
    task = Task.of(request)
    model = ns.assemble(task.system)
    return lambda: model.run(task.t_end, sample_interval=task.sample_interval)


@dataclass(frozen=True)
class Observed:
    """What a run computed.

    Attributes
    ----------
    end : str
        "done" or another status; the message of the error of a run that failed; "cut off" by the limit of time.
    q, times, impulses : array
        Coordinates at the samples, times of the events [s], impulses of their contacts [N s].
    components : tuple of str
        The kinds of bodies and joints of the system, and of the laws of the contacts that closed.
    """

    end: str
    q: NDArray[np.float64]
    times: NDArray[np.float64]
    impulses: NDArray[np.float64]
    components: tuple[str, ...] = ()


_CUT_OFF = "cut off"
"""How a run ends that takes longer than its limit."""


def observe(request: dict[str, Any], seconds: float) -> Observed:
    """Run what a request describes for at most some seconds of processor time, and return what it computed."""
    limit = math.inf

    def watch(t: float, t_end: float) -> None:
        # from the first call on: compiling a new kind of law is no part of the run
        nonlocal limit
        limit = min(limit, time.process_time() + seconds)
        if time.process_time() > limit:
            raise KeyboardInterrupt

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            task = Task.of(request)
            solution = ns.simulate(task.system, task.t_end, sample_interval=task.sample_interval, progress=watch)
    except ns.RunFailed as error:
        part = error.solution
        return _observed(part, _message(error)) if isinstance(part, ns.Solution) else _nothing(error)
    except Exception as error:
        return _nothing(error)
    return _observed(solution, _CUT_OFF if solution.status == "interrupted" else solution.status)


def _message(error: Exception) -> str:
    """Return what an error says, without the places of the source that it names: they are a tree's own."""
    return _PLACE.sub("a line of the source", f"{type(error).__name__}: {error}")


def _nothing(error: Exception) -> Observed:
    return Observed(_message(error), np.empty(0), np.empty(0), np.empty(0))


def _observed(solution: ns.Solution, end: str) -> Observed:
    events = solution.events
    return Observed(end, solution.q, events.time, events.listed_impulse, _components(solution))


def _components(solution: ns.Solution) -> tuple[str, ...]:
    """Return the kinds of bodies and joints, and of the laws of the contacts that closed, by their words."""
    system = solution.system
    closed = [system.contacts[i] for i in np.unique(solution.events.listed)]
    laws = [law for contact in closed for law in (contact.normal, contact.friction, contact.impact)]
    used = [*system.bodies, *(tie.component for tie in system.joints), *(law for law in laws if law is not None)]
    return tuple(sorted({WORDS.get(type(one), type(one).__name__) for one in used}))
