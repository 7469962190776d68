"""Run a system: the loop that feeds the engine, empties its buffers and reports progress."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from nonsmooth.engine.modes import DONE, PAUSED, REASONS, STOPPED
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.model.assembly import assemble
from nonsmooth.model.model import Model
from nonsmooth.model.options import Options
from nonsmooth.plugins.blocks import written_past
from nonsmooth.plugins.diagnose import culprit
from nonsmooth.queries.undeclared import warn_of_overlaps
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Counters, Solution
from nonsmooth.solution.suspicion import suspicions
from nonsmooth.system.system import System
from nonsmooth.watch import Watch

_STEPS_AT_ONCE = 2000
_DEFAULT_SAMPLES = 2000
Progress = Callable[[float, float], None]
_Chunks: TypeAlias = dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]]


def simulate(
    system: System,
    t_end: float,
    *,
    sample_interval: float | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Simulate a system from t = 0.

    Parameters
    ----------
    system : System
        Bodies, contacts, starts.
    t_end : float
        End time [s].
    sample_interval : float, optional
        Time between stored samples [s]; t_end / 2000 by default.  Events are stored exactly in any case.
    options : Options, optional
        Tolerances.
    progress : callable, optional
        Called now and then with the time reached and the end time [s], in the middle of a long impact, too.  What it
        raises ends the run and is raised.

    Returns
    -------
    Solution
        With status "done", "suspect" where its own checks found something (the message says what), or "interrupted"
        after Ctrl-C.

    Warns
    -----
    UndeclaredOverlap
        If bodies overlap at the start that have no contact, are not joined and not excluded.

    Raises
    ------
    InvalidInput
        If the start or a number is not valid; nothing has run then.
    RunFailed
        If the run cannot go on; its ``solution`` holds what was computed.
    """
    interval = t_end / _DEFAULT_SAMPLES if sample_interval is None else sample_interval
    for name, value in (("t_end", t_end), ("sample_interval", interval)):
        if not (math.isfinite(value) and value > 0.0):
            raise InvalidInput(f"simulate: {name}", "must be positive and finite", value, "Give it in [s].")
    model = assemble(system, options or Options())
    warn_of_overlaps(system)
    model.memory.scalars["t_end"] = t_end
    model.memory.scalars["sample_interval"] = interval
    return _run(model, progress)


def _run(model: Model, progress: Progress | None) -> Solution:
    scalars = model.memory.scalars
    start = model.energy()
    chunks: _Chunks = {}
    began = time.perf_counter()
    status, word = PAUSED, "done"
    t_end = float(scalars["t_end"][0])
    report = None if progress is None else lambda t: progress(t, t_end)
    try:
        with Watch(model.memory, report) as watch:
            while status == PAUSED:
                status = int(watch.call("advance", _STEPS_AT_ONCE))
                _drain(model, chunks)
                if progress is not None:
                    progress(float(scalars["t"][0]), t_end)
    except KeyboardInterrupt:
        _drain(model, chunks)
        status, word = PAUSED, "interrupted"
    message, past = REASONS[status], written_past(model)
    if past or status not in (DONE, STOPPED, PAUSED):
        word = "failed"
        message = f"At t = {float(scalars['t'][0]):.9g} s {message}. {past or culprit(model, status)}".strip()
    wall = time.perf_counter() - began
    solution = _solution(model, start, chunks, word, message, wall)
    if word == "failed":
        raise RunFailed(f"{message} What was computed is in the error's `solution`.", solution)
    return solution


def _drain(model: Model, chunks: _Chunks) -> None:
    """Empty the engine's buffers into a chunk of events, codes and samples, keyed by the number of the engine's call.

    An interrupt may fall anywhere in here, and the next call then neither repeats nor loses anything.
    """
    scalars, memory = model.memory.scalars, model.memory
    key = int(scalars["calls"][0])
    if key not in chunks:
        n_samples = int(scalars["n_samples"][0])
        width = model.n_y + 1
        chunks[key] = (
            memory.array("events", int(scalars["floats_used"][0])).copy(),
            memory.array("event_codes", int(scalars["integers_used"][0])).copy(),
            memory.array("samples", n_samples * width).reshape(n_samples, width).copy(),
        )
    for name in ("n_events", "n_samples", "floats_used", "integers_used", "last_floats"):
        scalars[name] = 0


def _solution(
    model: Model,
    start: tuple[float, float],
    chunks: _Chunks,
    word: str,
    message: str,
    wall: float,
) -> Solution:
    memory, scalars = model.memory, model.memory.scalars
    n_q, n_u = model.n_q, model.n_u
    all_rows, all_codes, table = (np.concatenate(parts) for parts in zip(*chunks.values(), strict=True))
    y = memory.array("y", model.n_y).copy()
    end = model.energy()
    energy = EnergyAccount(
        *start,
        *end,
        driven_work=float(scalars["driven_work"][0]) + float(y[n_q + n_u]),
        restitution_loss=float(scalars["restitution_loss"][0]),
        friction_loss=float(scalars["friction_loss"][0]) + float(y[n_q + n_u + 1]),
        closing_loss=float(scalars["closing_loss"][0]),
        exchanged_in_flow=float(y[n_q + n_u + 2]),
        load_work=float(y[n_q + n_u + 3]),
    )
    counters = Counters(
        steps=int(scalars["steps"][0]),
        rejected=int(scalars["rejected"][0]),
        impacts=int(scalars["impacts"][0]),
        impact_steps=int(scalars["impact_steps"][0]),
        wall_seconds=wall,
    )
    t, q = table[:, 0], table[:, 1 : 1 + n_q]
    worst = float(scalars["open_t"][0]), float(scalars["open_energy"][0]), float(scalars["open_share"][0])
    tolerances = float(scalars["rtol"][0]), float(scalars["impact_rtol"][0])
    found = suspicions(worst, energy, model.system.bodies, (t, q), tolerances) if word == "done" else ""
    if found:
        word, message = "suspect", f"{message}, but {found}"
    return Solution(
        model.system,
        t,
        q,
        table[:, 1 + n_q : 1 + n_q + n_u],
        Events.from_buffers(all_rows, all_codes, len(model.system.contacts), n_q, n_u),
        energy,
        counters,
        float(scalars["t"][0]),
        y[:n_q],
        y[n_q : n_q + n_u],
        word,
        message,
    )
