"""FinalState: the memory of a model after a run, from which state and end of the run are read when they are needed.

Many runs of a study need only their samples. Reading the state takes longer than a short run, so a solution reads it
at the first use of ``Solution.end``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import LIMITS, Mode
from nonsmooth.engine.memory.tables import record_with
from nonsmooth.interfaces import Engine, Measure, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.checkpoint import Booleans, Checkpoint, Difference, Integers
from nonsmooth.model.declared import searched
from nonsmooth.model.engine_parts import own_of
from nonsmooth.model.laid_out import energies
from nonsmooth.queries.near import size_of
from nonsmooth.runs.outcome import RunOutcome, cause_of, imbalance_span
from nonsmooth.solution.checks import closing_gain, friction_gain
from nonsmooth.solution.end import Counters, End, RunStatus
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.recorded import Recorded
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Continuation, Floats, State
from nonsmooth.solution.suspicion import suspicions
from nonsmooth.system.system import System


class FixedPlaces(NamedTuple):
    """Indices, in the checkpoints of a model, of the numbers from which a final state is made.

    The indices are the same for all runs of the model.

    Attributes
    ----------
    tails : array
        Position, in the blocks of a checkpoint, of dq/dt of each body; force, inverse mass and energies follow there.
    searched, features : array
        Numbers of the contacts whose features are searched for, and positions of their features in the blocks.
    changing : tuple of array
        Which numbers a run may change (:attr:`nonsmooth.engine.memory.memory.Memory.changing`).
    """

    tails: Integers
    searched: Integers
    features: Integers
    changing: tuple[Booleans, ...]

    @classmethod
    def of(cls, memory: Memory) -> FixedPlaces:
        """The places in checkpoints of a memory.

        A memory has offsets among all floats; a checkpoint has the blocks apart, which begin at ``memory.blocks``.
        """
        tails, (numbers, features) = memory[owners.BodyRecord.tail], searched(memory)
        return cls(tails - memory.blocks, numbers, features - memory.blocks, memory.changing)


class FinalState(NamedTuple):
    """Content of a model's memory after a run, with the data that are needed to make a state from it.

    Attributes
    ----------
    system : System
        The system that ran.
    engine : Engine
        The engine that integrated it.
    key : callable
        Function that returns the digest of the model.
    start_energy : tuple
        Kinetic and potential energy at the start of the energy account [J].
    blank : Checkpoint
        Content of the memory before any run.
    resumable : Checkpoint
        Content from which a continued run starts. It was copied before any step that is shortened to reach the end
        time.
    now : Checkpoint
        Content at the end of the run.
    n_known_events : int
        Number of events after ``resumable``.
    places : FixedPlaces
        Positions, in the checkpoints, of the numbers that a state needs.
    """

    system: System
    engine: Engine
    key: Callable[[], str]
    start_energy: tuple[float, float]
    blank: Checkpoint
    resumable: Checkpoint
    now: Checkpoint
    n_known_events: int
    places: FixedPlaces

    def end(self, outcome: RunOutcome, code: int, wall: float, recorded: Recorded) -> End:
        """End of the run, after checks of its energy account and quaternions.

        Parameters
        ----------
        outcome : RunOutcome
            Status and message, before the checks of the energy account.
        code : int
            Last status of the engine.
        wall : float
            Wall time of the run [s].
        recorded : Recorded
            Events and samples of the run.
        """
        state, counters = self.state(), self._counters(wall)
        status, message = outcome
        if status == RunStatus.DONE and (found := self._suspicions(End(state, counters, status, message), recorded)):
            status, message = RunStatus.SUSPECT, f"{message}, but {found}"
        cause = cause_of(self.engine, code)
        return End(state, counters, status, message, cause.name if cause else "", self._verdict())

    def state(self) -> State:
        """State of the model at the end of the run, with what a later run needs to continue this one.

        That is the difference of the resumable checkpoint from the blank memory, which is short.
        """
        now, contact, places = self.now, owners.ContactRecord, self.places
        n = now[owners.ModelNumbers.n_declared]
        # y has q, u, the energy accounts, and the inner states of laws
        n_q, n_u, y = now[owners.ModelNumbers.n_q], now[owners.ModelNumbers.n_u], now[owners.Island.y]
        features = np.zeros((n, CANDIDATE))
        features[places.searched] = now.blocks[places.features[:, None] + np.arange(CANDIDATE)]
        state = State(
            now[owners.Island.time],
            y[:n_q],
            y[n_q : n_q + n_u],
            self._of_contacts(contact.mode, np.full(n, Mode.OPEN)),
            self._of_contacts(contact.direction, np.tile([1.0, 0.0], (n, 1))),
            self._of_contacts(contact.closing_rate, np.zeros(n)),
            features,
            y[n_q + n_u + N_ACCOUNTS :],
            now[owners.OwnGuard.has_just_fired],
            self._account(y[n_q + n_u :]),
        )
        difference = Difference.between(self.blank, self.resumable, self.places.changing)
        return state.with_continuation(Continuation(self.key(), difference, self.n_known_events))

    def _of_contacts(self, declared: Any, found: np.ndarray) -> np.ndarray:
        """A number of every contact of the system. ``found`` has those of contacts that are not active."""
        active = self.now[owners.ContactRecord.declared][: self.now[owners.Island.n_contacts]]
        found[active] = self.now[declared][: len(active)]
        return found

    def _counters(self, wall: float) -> Counters:
        """Counters of the run, which took a wall time [s]."""
        now, totals = self.now, owners.Totals
        limits = now[totals.n_steps_limited]
        return Counters(
            steps=now[totals.n_steps],
            rejected=now[totals.n_rejected],
            impacts=now[totals.n_impacts],
            impact_steps=now[totals.n_impact_steps],
            limits={name: int(n) for name, n in zip(LIMITS, limits, strict=True) if n},
            gap_looks=now[totals.n_gap_evaluations],
            listings=now[totals.n_listings],
            wall_seconds=wall,
        )

    def _suspicions(self, end: End, recorded: Recorded) -> str:
        """Sentences about a run that reached its end but fails a check of its energy or of its quaternions, or "".

        ``end`` is the end of the run without the result of these checks.
        """
        now, run = self.now, owners.Run
        solution = Solution(self.system, recorded, end)
        return suspicions(
            self.engine,
            worst_event=(now[run.worst_energy_time], now[run.worst_energy], now[run.worst_energy_ratio]),
            jump=(now[run.jump_time], now[run.jumped_energy]),
            # energy that contacts brought in [J]; that of a law that stores energy is not counted, as it may return it
            added=closing_gain(solution) + (0.0 if self._friction_stores_energy() else friction_gain(solution)),
            energy=end.state.energy,
            bodies=dict(zip(self.system.names.bodies, self.system.bodies, strict=True)),
            # times and coordinates
            samples=(recorded.rows[:, 0], recorded.rows[:, 1 : 1 + now[owners.ModelNumbers.n_q]]),
            tolerances=(now[owners.Tolerance.relative], now[owners.Tolerance.impact]),
            steps=end.counters.steps,
            scale=now[run.energy_scale],
            floor=self._least_scale(),
            # evaluated only if it is needed, because it takes long
            span=partial(imbalance_span, solution),
        )

    def _verdict(self) -> dict[Measure, float]:
        """The measures by which the engine judges a run, such as the largest overlap, with their values at the end.

        They are scalars of the part that the engine added to the workspace. Empty for an engine that added none.
        """
        # the first part of a checkpoint is the record of scalars, with those of the engine at its end
        own = self.now.parts[0].view(record_with(own_of(self.engine)))[0]
        return {
            measure: float(own[f"{part.key}.{measure.name}"])
            for part in own_of(self.engine)
            for measure in self.engine.verdict
        }

    def _friction_stores_energy(self) -> bool:
        """True if a friction law has inner states, which may store energy."""
        return any(
            isinstance(row.laws.friction, (StatefulFrictionLaw, TractionLaw)) for row in self.system.contacts.rows
        )

    def _least_scale(self) -> float:
        """Scale of the energy account of bodies that hardly move [J].

        An imbalance is compared with it if less energy was exchanged. It is the sum, over the free bounded bodies, of
        the work of the force on each over its own size.
        """
        total = 0.0
        for body, tail in zip(self.system.bodies, self.places.tails.tolist(), strict=True):
            # the force follows q'
            size, first = size_of(body), tail + body.n_q
            if body.n_u > 0 and math.isfinite(size):
                total += float(np.linalg.norm(self.now.blocks[first : first + body.n_u])) * size
        return total

    def _account(self, integrated: Floats) -> EnergyAccount:
        """Energy account. ``integrated`` begins with the energies that the engine integrates with the state [J].

        The engine adds the others at instants. Work of driven bodies and losses by friction and closing have a part of
        each kind.
        """
        now, totals = self.now, owners.Totals
        driven, dissipated, exchanged, loads, closed = integrated[:N_ACCOUNTS].tolist()
        # kinetic and potential energy at the start, then the same at the end
        return EnergyAccount(
            *self.start_energy,
            *energies(self.system.bodies, self.places.tails, now.blocks),
            driven_work=now[totals.driven_work] + driven,
            restitution_loss=now[totals.restitution_loss],
            friction_loss=now[totals.friction_loss] + dissipated,
            closing_loss=now[totals.closing_loss] + closed,
            exchanged_in_flow=exchanged,
            load_work=loads,
        )


class UnreadEnd(NamedTuple):
    """Data from which ``Solution.end``, the end of a run, is read at its first use.

    Attributes
    ----------
    final : FinalState
        Memory of the model after the run.
    outcome : RunOutcome
        Status and message, before the checks of the energy account.
    code : int
        Last status of the engine.
    wall : float
        Wall time of the run [s].
    recorded : Recorded
        Events and samples of the run.
    """

    final: FinalState
    outcome: RunOutcome
    code: int
    wall: float
    recorded: Recorded

    def read(self) -> End:
        """Read the end, and check the energy account and the quaternions of the run."""
        return self.final.end(self.outcome, self.code, self.wall, self.recorded)
