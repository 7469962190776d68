"""The solution of a run that has ended, and the state in which it left the model."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import CATALOGUE, CATALOGUE_FLOATS, CLOSING_RATE, DIRECTION, N_ACCOUNTS
from nonsmooth.engine.memory.limits import LIMITS
from nonsmooth.engine.memory.modes import CONDITION_MET, DONE, PAUSED, REASONS, STOPPED
from nonsmooth.interfaces import Engine
from nonsmooth.model.blocks import written_past
from nonsmooth.model.image import Difference, Guards, Image
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.diagnose import culprit
from nonsmooth.runs.loop import Ending
from nonsmooth.runs.records import Records
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.solution import Counters, Solution
from nonsmooth.solution.state import Continuation, State
from nonsmooth.solution.suspicion import suspicions

_MODE, _PLACE = CATALOGUE.index("mode"), CATALOGUE.index("candidate")


def reason(model: LaidOut, guards: Guards, ending: Ending) -> tuple[str, str]:
    """Return the status of a run that has ended, in a word, and why it did; ``guards`` are those of the model."""
    past_map = int(model.memory.scalars["map_past"][0]) > 0
    past = "" if guards.hold(model.memory) and not past_map else written_past(model)
    status = ending.status
    if ending.trouble:
        return "failed", f"At t = {float(model.memory.scalars['t'][0]):.9g} s {ending.trouble}"
    if past or status not in (DONE, STOPPED, CONDITION_MET, PAUSED):
        message = f"At t = {float(model.memory.scalars['t'][0]):.9g} s {REASONS[status]}."
        return "failed", f"{message} {past or culprit(model, status) or ending.hint}".strip()
    return "interrupted" if ending.interrupted else "done", REASONS[status]


def solution_of(
    model: LaidOut,
    records: Records,
    start: tuple[float, float],
    said: tuple[str, str],
    state: State,
    wall: float,
    engine: Engine,
) -> Solution:
    """Return the solution of a run.

    Parameters
    ----------
    model : LaidOut
        What ran.
    records : Records
        What the engine recorded.
    start : tuple
        Kinetic and potential energy where the account begins [J].
    said : tuple
        Status and reason.
    state : State
        Where the run ended.
    wall : float
        Time that the engine took [s].
    engine : Engine
        What integrated it.
    """
    record, n_q, n_u = model.memory.scalars[0], model.n_q, model.n_u
    word, message = said
    recorded = records.joined(engine)
    table = recorded.rows
    counters = Counters(
        steps=int(record["steps"]),
        rejected=int(record["rejected"]),
        impacts=int(record["impacts"]),
        impact_steps=int(record["impact_steps"]),
        limits={word: int(n) for word, n in zip(LIMITS, model.memory.array("limits", len(LIMITS)), strict=True) if n},
        gap_looks=int(record["gap_looks"]),
        listings=int(record["listings"]),
        wall_seconds=wall,
    )
    t, q = table[:, 0], table[:, 1 : 1 + n_q]
    worst = float(record["open_t"]), float(record["open_energy"]), float(record["open_share"])
    tolerances = float(record["rtol"]), float(record["impact_rtol"])
    bodies = dict(zip(model.system.names.bodies, model.system.bodies, strict=True))
    found = suspicions(worst, state.energy, bodies, (t, q), tolerances, counters.steps) if word == "done" else ""
    if found:
        word, message = "suspect", f"{message}, but {found}"
    return Solution(
        model.system,
        t,
        q,
        table[:, 1 + n_q : 1 + n_q + n_u],
        state.energy,
        counters,
        state.time,
        state.q.copy(),
        state.u.copy(),
        word,
        message,
        state,
        recorded,
    )


def state_of(model: LaidOut, blank: Image, key: str, start: tuple[float, float], ending: Ending) -> State:
    """Return the state in which a run left its model, whose image before any run is ``blank``, its digest ``key``."""
    memory, n_q, n_u = model.memory, model.n_q, model.n_u
    n, slots = len(model.system.contacts), int(memory.scalars["n_contacts"][0])
    y = memory.array("y", model.n_y)
    rows = memory.array("catalogue", len(CATALOGUE) * n).reshape(n, len(CATALOGUE))
    floats = memory.array("catalogue_floats", CATALOGUE_FLOATS * n).reshape(n, CATALOGUE_FLOATS)
    modes, rates = rows[:, _MODE].copy(), floats[:, CLOSING_RATE].copy()
    directions = floats[:, DIRECTION : DIRECTION + 2].copy()
    # what stands in a slot is newer than what the catalogue keeps of it
    listed = memory.array("identity", slots)
    modes[listed] = memory.array("mode", slots)
    directions[listed] = memory.array("direction", 2 * slots).reshape(slots, 2)
    rates[listed] = memory.array("closing_rate", slots)
    features, places = np.zeros((n, CANDIDATE)), rows[:, _PLACE]
    for number in np.flatnonzero(places > 0).tolist():
        features[number] = memory.floats[places[number] :][:CANDIDATE]
    state = State(
        float(memory.scalars["t"][0]),
        y[:n_q],
        y[n_q : n_q + n_u],
        modes,
        directions,
        rates,
        features,
        y[n_q + n_u + N_ACCOUNTS :],
        memory.array("own_guard_spent", len(model.system.guards)),
        _account(model, start),
    )
    return state.with_continuation(Continuation(key, Difference.between(blank, ending.image), ending.told))


def _account(model: LaidOut, start: tuple[float, float]) -> EnergyAccount:
    record, first = model.memory.scalars[0], model.n_q + model.n_u
    driven, rubbed, exchanged, loads = model.memory.array("y", first + N_ACCOUNTS)[first:].tolist()
    return EnergyAccount(
        *start,
        *model.energy(),
        driven_work=float(record["driven_work"]) + driven,
        restitution_loss=float(record["restitution_loss"]),
        friction_loss=float(record["friction_loss"]) + rubbed,
        closing_loss=float(record["closing_loss"]),
        exchanged_in_flow=exchanged,
        load_work=loads,
    )
