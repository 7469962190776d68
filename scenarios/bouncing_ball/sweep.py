"""One run after another over Gamma, each from where the one before ended."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.runs.simulate import Progress, simulate
from scenarios.bouncing_ball.scenario import BouncingBall

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Points:
    """The impacts that a sweep kept.

    Attributes
    ----------
    gamma, phase, flight : array
        Gamma, phase of the table at the impact [turns], and the flight that follows [table periods].
    """

    gamma: Floats
    phase: Floats
    flight: Floats


def sweep(
    scenario: BouncingBall, gammas: Iterable[float], *, settle: int, keep: int, progress: Progress | None
) -> Points:
    """Run a scenario over values of Gamma, upwards or downwards.

    Every run lasts ``settle`` + ``keep`` table periods and begins at the phase and with the take-off speed of the last
    impact of the one before, so that it stays on the attractor that it follows as long as that exists.
    """
    values = [float(gamma) for gamma in gammas]
    duration = (settle + keep) * scenario.period
    whole = duration * len(values)
    found: list[Floats] = []
    start: dict[str, float] = {}
    for i, gamma in enumerate(values):
        one = dataclasses.replace(scenario, gamma=gamma, **start)
        run = simulate(one.build(), duration, sample_interval=duration)
        if progress is not None:
            progress((i + 1) * duration, whole)
        times, flights, phases = one.impact_times(run), one.flights(run), one.phases(run)
        kept = times[:-1] >= settle * one.period
        found.append(np.column_stack([np.full(kept.sum(), gamma), phases[:-1][kept], flights[kept]]))
        if len(times) > 0:
            last = run.events.u_after[run.events.cause == Cause.IMPACT][-1]
            start = {"start_phase": 2.0 * math.pi * float(phases[-1]), "speed": float(last[2])}
    return Points(*np.vstack(found).T)
