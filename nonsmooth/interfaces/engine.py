"""Interface of engines, which integrate a system from its start to the end of a run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

from nonsmooth.interfaces.scales import Scales
from nonsmooth.parameters import Component

if TYPE_CHECKING:
    from nonsmooth.engine.memory.declare import Singleton
    from nonsmooth.engine.memory.memory import Memory
    from nonsmooth.model.laid_out import LaidOut
    from nonsmooth.system.system import System

FIRST_CODE = 100
"""Smallest code of a cause, defined by a single engine, for which this engine ends a run (:class:`EndCause`).

Smaller codes are the causes in :mod:`nonsmooth.engine.memory.modes`, which all engines share.
"""


@final
@dataclass(frozen=True)
class Measure:
    """A number by which an engine judges its run, such as the largest overlap.

    Attributes
    ----------
    name : str
        Name of the scalar in ``Engine.own`` that holds the number when the run ends.
    unit : str
        SI unit, "1" for a pure number.
    meaning : str
        Description of the number, in a few words.
    """

    name: str
    unit: str
    meaning: str


@final
@dataclass(frozen=True)
class EndCause:
    """A cause that an engine defines itself, and for which it ends a run.

    Attributes
    ----------
    code : int
        The status that ``Engine.advance`` returns, :data:`FIRST_CODE` or more.
    name : str
        Name of the cause, which ``Solution.cause`` gives.
    reason : str
        Description of the event, as a sentence without its full stop.
    remedy : str
        Advice for the user, as a whole sentence.
    is_failure : bool
        Whether the run failed.
    """

    code: int
    name: str
    reason: str
    remedy: str = ""
    is_failure: bool = True


class Engine(Component, ABC):
    """An integrator; its parameters are its options.

    All engines share the model: bodies, geometry, contacts and laws, in one workspace
    (:mod:`nonsmooth.engine.memory.workspace`). They share its results: samples, events, energies, and the state at the
    end of a run. The contract:

    1. ``check`` refuses a system that this engine cannot run, before anything is laid out.
    2. ``own`` declares numbers of its own. All numbers of the workspace exist for every engine.
    3. ``counts`` gives the counts that its options decide, ``settings`` the scalars that it sets.
    4. ``prepare`` evaluates numbers of its own that no run changes. Numbers that it keeps of contacts have the length
       ``per(..., "n_declared")``, and ``contact.declared`` for their index: the place of a contact among the active
       ones changes.
    5. ``advance`` continues the run from the state in the memory, with steps of its own
       (:func:`nonsmooth.steps.step`) and with entry points of :mod:`nonsmooth.engine`. All numbers that it needs later,
       in another process too, are in the memory.
    6. Samples are due up to the time ``ws.island.time``, the first one at ``ws.output.next_sample``. ``begin_sample``
       appends a sample and returns the place of its state. ``begin_event`` begins an event, before velocities change,
       and ``record_event`` appends it. An engine pauses if its buffers are half full; it is called again with empty
       ones.
    7. It returns ``STALLED`` if time stops passing. The memory then holds the state at that instant, and
       ``contact.burst_events`` counts the events of each contact that stalls. This does not yet end the run: an engine
       that is made of two may let the other one continue from there.
    8. An engine that ``records_contacts`` records an event at the start, and one whenever modes change.  Other engines
       record no event of a system with contacts, because its modes and impulses would be zeros.
    9. ``verdict`` names numbers that the user reads with the run, ``causes`` the causes for which only this engine ends
       a run.  ``promised_residual`` decides which runs are suspect.
    """

    @property
    def own(self) -> type[Singleton] | None:
        """Class that declares the numbers which the engine adds to the memory; None, the default, if it adds none."""
        return None

    @property
    def uses_flow(self) -> bool:
        """True if the engine uses the built-in integrator (:mod:`nonsmooth.engine.flow`) between events.

        Its ``settings`` then give the tolerances of the integrator.
        """
        return False

    @property
    def records_contacts(self) -> bool:
        """True if the events of a run with this engine store impulses, and the modes after each event."""
        return False

    @property
    def verdict(self) -> tuple[Measure, ...]:
        """Numbers by which the engine judges a run, for ``Solution.end.verdict``; none by default."""
        return ()

    @property
    def causes(self) -> tuple[EndCause, ...]:
        """Causes for which only this engine ends a run; none by default."""
        return ()

    @property
    def promised_residual(self) -> float | None:
        """Largest energy residual of a good run, relative to the exchanged energy; a run above it is suspect.

        If it is None, the default, ``ws.tolerance.relative`` and ``ws.tolerance.impact`` decide.
        """
        return None

    @abstractmethod
    def check(self, system: System) -> None:
        """Check that the engine can run a system.

        Raises
        ------
        InvalidInput
            If the engine cannot run the system. The message names the unsupported part and another engine.
        """

    @abstractmethod
    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return the counts of :data:`nonsmooth.engine.memory.tables.COUNTS` that no system decides; others are 0.

        Parameters
        ----------
        n_slots : int
            Number of contacts near each other for which the memory is laid out. It grows when a run needs more, and the
            method is called again. The arrays of the engine must not depend on it in any other way.
        """

    @abstractmethod
    def settings(self, scales: Scales) -> Mapping[Any, float]:
        """Return scalars of the workspace that it sets, by their declarations: ``{Tolerance.relative: 1e-9}``.

        Parameters
        ----------
        scales : Scales
            Sizes of the system.
        """

    def prepare(self, model: LaidOut) -> None:
        """Evaluate numbers of its own that no run changes, once a system is laid out; nothing by default.

        Parameters
        ----------
        model : LaidOut
            The system in its memory, before any body is placed. Functions and parameters of bodies, contacts and laws
            are there; states are not.
        """

    @abstractmethod
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        """Continue to the end time ``ws.request.t_end``, a failure, full buffers or ``most_steps``.

        Parameters
        ----------
        call : callable
            ``call(name, *numbers)`` calls an entry point, or a step of the engine, on the memory. During the call,
            progress is reported, and Ctrl-C interrupts at a point at which nothing is lost.
        memory : Memory
            The memory.
        most_steps : int
            Largest number of steps.
        pauses_before_end : bool
            Whether to pause before a step that may lead past the end time.

        Returns
        -------
        int
            ``DONE`` at the end time, to which ``ws.island.time`` is set, ``PAUSED`` to be called again, ``STOPPED`` if
            a guard ends the run, a failure of :data:`nonsmooth.engine.memory.modes.REASONS`, or the ``code`` of one
            of :attr:`causes`.
        """
