"""Left: what a run left in the memory of its model, read when it is asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.limits import LIMITS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.tables import record_with
from nonsmooth.interfaces import Engine, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.checkpoint import Booleans, Checkpoint, Difference, Integers
from nonsmooth.model.engine_parts import own_of
from nonsmooth.model.laid_out import energies
from nonsmooth.queries.near import size_of
from nonsmooth.runs.open_span import open_span
from nonsmooth.runs.outcome import cause_of
from nonsmooth.solution.end import Counters, End
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.recorded import Recorded
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Continuation, Floats, State
from nonsmooth.solution.suspicion import suspicions
from nonsmooth.system.system import System


class Standing(NamedTuple):
    """What no run changes of a memory, which goes on to other runs.

    Attributes
    ----------
    tails, features : array
        Places of the tails of the bodies, and of the pairs of features of the declared contacts.
    changing : tuple of array
        :attr:`nonsmooth.engine.memory.memory.Memory.changing`.
    """

    tails: Integers
    features: Integers
    changing: tuple[Booleans, ...]

    @classmethod
    def of(cls, memory: Memory, n_bodies: int) -> Standing:
        """Take it from a memory."""
        tails, features = memory[owners.Body.tail][:n_bodies], memory.declared(owners.Contact.features)
        return cls(tails - memory.blocks, features.copy(), memory.changing)


class Left(NamedTuple):
    """What a run left.

    Attributes
    ----------
    system : System
        What ran.
    engine : Engine
        What integrated it.
    key : callable
        Returns the digest of its model.
    start : tuple
        Kinetic and potential energy where the account begins [J].
    blank, before, now : Checkpoint
        What the memory held before any run, where nothing yet said when the run would end, and now.
    told : int
        Events since ``before``.
    standing : Standing
        What of the memory no run changes.
    """

    system: System
    engine: Engine
    key: Callable[[], str]
    start: tuple[float, float]
    blank: Checkpoint
    before: Checkpoint
    now: Checkpoint
    told: int
    standing: Standing

    def end(self, said: tuple[str, str], code: int, wall: float, recorded: Recorded) -> End:
        """Return how a run ended that recorded so much.

        Parameters
        ----------
        said : tuple of str
            Status and message.
        code : int
            Status of the engine.
        wall : float
            Time that it took [s].
        recorded : Recorded
            What it recorded.
        """
        now, state = self.now, self.state()
        counters = Counters(
            steps=now[owners.Totals.n_steps],
            rejected=now[owners.Totals.n_rejected],
            impacts=now[owners.Totals.n_impacts],
            impact_steps=now[owners.Totals.n_impact_steps],
            limits={
                word: int(n)
                for word, n in zip(LIMITS, self.now[owners.Totals.n_steps_limited][: len(LIMITS)], strict=True)
                if n
            },
            gap_looks=now[owners.Totals.n_gap_evaluations],
            listings=now[owners.Totals.n_listings],
            wall_seconds=wall,
        )
        status, message = said
        if status == "done":
            worst = (
                now[owners.Run.worst_energy_time],
                now[owners.Run.worst_energy],
                now[owners.Run.worst_energy_ratio],
            )
            tolerances = now[owners.Tolerance.relative], now[owners.Tolerance.impact]
            bodies = dict(zip(self.system.names.bodies, self.system.bodies, strict=True))
            moved = recorded.rows[:, 0], recorded.rows[:, 1 : 1 + now[owners.Model.n_q]]
            scale = now[owners.Run.energy_scale]
            known = Solution.known(self.system, recorded, End(state, counters, status, message))
            found = suspicions(
                self.engine,
                worst,
                (now[owners.Run.jump_time], now[owners.Run.jumped_energy]),
                0.0 if self._stores() else known.friction_gain,
                state.energy,
                bodies,
                moved,
                tolerances,
                counters.steps,
                scale,
                self._floor(),
                partial(open_span, known),
            )
            if found:
                status, message = "suspect", f"{message}, but {found}"
        cause, own = cause_of(self.engine, code), self.now.parts[0].view(record_with(own_of(self.engine)))[0]
        verdict = {
            measure: float(own[f"{part.key}.{measure.name}"])
            for part in own_of(self.engine)
            for measure in self.engine.verdict
        }
        return End(state, counters, status, message, cause.name if cause else "", verdict)

    def _stores(self) -> bool:
        """Return whether some law of friction may store energy in its contact."""
        return any(isinstance(one.friction, (StatefulFrictionLaw, TractionLaw)) for one in self.system.contacts)

    def _floor(self) -> float:
        """Return the work of the forces on all bodies, as they are now, on a way as long as the bodies [J]."""
        now, total = self.now, 0.0
        for body, tail in zip(self.system.bodies, self.standing.tails.tolist(), strict=True):
            size = size_of(body)
            if body.n_u > 0 and math.isfinite(size):
                force = now.blocks[tail + body.n_q : tail + body.n_q + body.n_u]
                total += float(np.linalg.norm(force)) * size
        return total

    def state(self) -> State:
        """Return the state in which the model is now."""
        now, model = self.now, owners.Model
        n_q, n_u, n, slots = (now[one] for one in (model.n_q, model.n_u, model.n_declared, owners.Island.n_contacts))
        y = now[owners.Island.y][: now[owners.Model.n_y]]
        contact = owners.Contact
        modes, rates = now.declared(contact.mode).copy(), now.declared(contact.closing_rate).copy()
        directions = now.declared(contact.direction).copy()
        # an active slot is newer than the record of its declared contact
        listed = now[owners.Contact.declared][:slots]
        modes[listed] = now[owners.Contact.mode][:slots]
        directions[listed] = now[owners.Contact.direction][:slots]
        rates[listed] = now[owners.Contact.closing_rate][:slots]
        features, places = np.zeros((n, CANDIDATE)), self.standing.features
        for number in np.flatnonzero(places > 0).tolist():
            features[number] = now.blocks[places[number] - now.first :][:CANDIDATE]
        state = State(
            now[owners.Island.time],
            y[:n_q],
            y[n_q : n_q + n_u],
            modes,
            directions,
            rates,
            features,
            y[n_q + n_u + N_ACCOUNTS :],
            now[owners.OwnGuard.has_just_fired][: now[owners.Model.n_own_guards]],
            self._account(y[n_q + n_u :]),
        )
        difference = Difference.between(self.blank, self.before, self.standing.changing)
        return state.with_continuation(Continuation(self.key(), difference, self.told))

    def _account(self, integrated: Floats) -> EnergyAccount:
        now, bodies = self.now, self.system.bodies
        driven, rubbed, exchanged, loads = integrated[:N_ACCOUNTS].tolist()
        return EnergyAccount(
            *self.start,
            *energies(bodies, self.standing.tails, now.blocks),
            driven_work=now[owners.Totals.driven_work] + driven,
            restitution_loss=now[owners.Totals.restitution_loss],
            friction_loss=now[owners.Totals.friction_loss] + rubbed,
            closing_loss=now[owners.Totals.closing_loss],
            exchanged_in_flow=exchanged,
            load_work=loads,
        )
