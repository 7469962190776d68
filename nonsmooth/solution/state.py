"""State of a run at one time: the run can continue from it, or a new run can start from it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import check_kind, floats, is_finite
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import StatefulFrictionLaw, TractionLaw
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from nonsmooth.model.checkpoint import Difference

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
_ARRAYS = ("q", "u", "modes", "slip_directions", "closing_rates", "features", "law_states", "guards_spent")


@final
@dataclass(frozen=True)
class Continuation:
    """Data that continue a run as if it had not stopped, in addition to its state.

    Attributes
    ----------
    model : str
        Digest of the model that ran.
    difference : Difference
        Difference between the memory at a checkpoint and the memory before any run.  The checkpoint is a few steps
        before the end, at a time when the content does not depend on the end time.
    n_known_events : int
        Number of events after the checkpoint. The continued run repeats them, and they are recorded already.
    """

    model: str
    difference: Difference
    n_known_events: int


@final
@dataclass(frozen=True, eq=False)
class State:
    """State of a run at one time: the run can continue from it, or a new run can start from it.

    The end state of a run continues this run on the same model, as if it had not stopped.  Any other state starts a new
    run: a state made by :meth:`at`, a state changed by :func:`dataclasses.replace`, and a state that is given to a
    model with other parameters.  At its start a new run determines which contacts touch.  It also determines the slip
    direction that anisotropic friction opposes: from the slip of a sliding contact, or from the force on a sticking
    contact at the first instant.

    Attributes
    ----------
    time : float
        Time [s].
    q, u : array
        Coordinates and velocities of all bodies, shapes [n_q] and [n_u].
    modes : array
        Mode of every contact, 0 open, 1 stick, 2 slide, shape [n_contacts].  A closed contact stays closed until it
        separates, even if its gap is not zero.
    slip_directions : array
        Unit vectors in the tangent planes, shape [n_contacts, 2].
    closing_rates : array
        Approach speed at which each compliant contact closed last [m/s], shape [n_contacts].
    features : array
        Features in contact, for contacts that search for them, else zero; shape [n_contacts, 3].
    law_states : array
        Inner states of friction and traction laws, contact by contact, shape [n_states].
    guards_spent : array
        1 for a guard that fired at this time and must not fire again at once, shape [n_guards].
    energy : EnergyAccount
        Energy account up to this time.  A run that continues adds to it; a start begins a new account.
    continuation : Continuation or None
        Data that continue the run as if it had not stopped; None for a start.
    """

    time: float
    q: Floats
    u: Floats
    modes: Integers
    slip_directions: Floats
    closing_rates: Floats
    features: Floats
    law_states: Floats
    guards_spent: Integers
    energy: EnergyAccount
    # this field is no argument of the constructor, so dataclasses.replace sets it to None: a changed state starts a run
    continuation: Continuation | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        # read-only, because a change of these arrays would not change the run that continues
        for name in _ARRAYS:
            value = np.array(getattr(self, name))
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @classmethod
    def at(cls, system: System, time: float = 0.0, q: ArrayLike | None = None, u: ArrayLike | None = None) -> State:
        """State for a start, with all contacts open; contacts that touch close in the first instant of the run.

        Parameters
        ----------
        system : System
            The system.
        time : float
            Time [s].
        q, u : array, optional
            Coordinates and velocities of all bodies, in the order of the system; by default as they were placed.

        Raises
        ------
        InvalidInput
            `system` is not a System, the time is not finite, or `q` or `u` is not an array of numbers.
        """
        check_kind("State.at: system", system, System, "Make it by nonsmooth.System([...]).")
        if not is_finite(time):
            raise InvalidInput("State.at: time", "must be a finite number", time, "Give it in [s].")
        placed = system.starts()
        n = len(system.contacts)
        n_states = sum(len(row) * _n_states(row.laws.friction) for row in system.contacts.rows)
        return cls(
            time,
            placed[0] if q is None else floats("State.at: q", q),
            placed[1] if u is None else floats("State.at: u", u),
            np.full(n, Mode.OPEN),
            np.tile([1.0, 0.0], (n, 1)),
            np.zeros(n),
            np.zeros((n, CANDIDATE)),
            np.zeros(n_states),
            np.zeros(len(system.guards), dtype=np.int64),
            EnergyAccount(*(10 * [0.0])),
        )

    def __repr__(self) -> str:
        """Time, and numbers of coordinates, velocities and closed contacts."""
        closed = int(np.count_nonzero(self.modes))
        size = f"{len(self.q)} coordinates, {len(self.u)} velocities, {closed} of {len(self.modes)} contacts closed"
        return f"State(t = {self.time:.9g} s: {size})"

    def with_continuation(self, continuation: Continuation) -> State:
        """Set the data that continue the run, and return this state. Only for a state that was just made."""
        object.__setattr__(self, "continuation", continuation)
        return self


def _n_states(law: object) -> int:
    return len(law.initial_state) if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else 0
