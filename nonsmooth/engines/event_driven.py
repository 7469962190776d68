"""The event-driven engine: smooth steps of high order between events that are located to the last digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, final

from nonsmooth.engine.memory.owners import Island, Options, Tolerance
from nonsmooth.engine.memory.solvers import SOLVERS, pivoted_contacts, solver_of
from nonsmooth.engine.numerics.tolerances import GAP, RELATIVE_GAP, RELATIVE_TIME, RELATIVE_VELOCITY, TIME, VELOCITY
from nonsmooth.interfaces.engine import Engine
from nonsmooth.interfaces.scales import Scales
from nonsmooth.parameters import parameter

if TYPE_CHECKING:
    from nonsmooth.engine.memory.memory import Memory
    from nonsmooth.system.system import System


class PainlevePolicy(StrEnum):
    """What happens if a sliding contact has no contact force (Painleve's paradox).

    With much friction, the contact problem of a sliding contact may have no solution. The order of the members is that
    of the engine's numbers.
    """

    IMPACT = "impact"
    """Velocities jump: the contact's impact law is applied to the closed contact, although no gap closes."""
    COMPLIANT = "compliant"
    """Velocities jump by an impact of the closed contact without loss of energy, as by a stiff spring."""
    REFUSE = "refuse"
    """The run ends at this time with `RunFailed`, because the contact force has no solution."""


_POLICIES = tuple(PainlevePolicy)
_LARGEST_STEP = 0.1
"""Largest step [s] of the default options."""
_LARGEST_RELATIVE_STEP = 10.0
"""The same, relative to the time scale of the system."""


@final
@dataclass(frozen=True)
class EventDriven(Engine):
    """Integrates between events, finds each of them, and solves there for impulses and new modes.

    Its tolerances and limits are numerical, not physical. By default, those of gaps, velocities and times, and the
    largest step, follow from the sizes of the system: the smallest free body and its typical acceleration
    (:class:`~nonsmooth.interfaces.Scales`).
    """

    tolerance: float = parameter(1e-9, doc="relative error of a step of the flow", above=0.0, maximum=1e-2)
    impact_tolerance: float = parameter(1e-8, doc="relative error of a step inside an impact", above=0.0, maximum=1e-2)
    time_tolerance: float | None = parameter(
        None,
        doc="accuracy of event times; by default 1e-10 of the time scale, at most 1e-12 s",
        unit="s",
        above=0.0,
        maximum=1e-3,
    )
    gap_tolerance: float | None = parameter(
        None,
        doc="gap that counts as closed; by default 1e-9 of the smallest body, at most 1e-12 m",
        unit="m",
        above=0.0,
        maximum=1e-3,
    )
    velocity_tolerance: float | None = parameter(
        None,
        doc="relative velocity that counts as zero; by default 2e-7 of the speed scale, at most 2e-8 m/s",
        unit="m/s",
        above=0.0,
        maximum=1e-2,
    )
    largest_step: float | None = parameter(
        None,
        doc="largest step of the flow; by default ten time scales, at most 0.1 s",
        unit="s",
        above=0.0,
        maximum=1e9,
    )
    steps_per_period: float = parameter(4.0, doc="least steps per time scale of a prescribed motion", minimum=1.0)
    painleve: str = parameter(
        "impact",
        doc="what happens where sliding has no contact force: an impact without collision by the contact's law, "
        "the same without loss as a stiff spring does it, or the end of the run",
        unit="",
        choices=_POLICIES,
    )
    solver: str = parameter("auto", doc="solver of the contact problem", unit="", choices=SOLVERS)

    @property
    def uses_flow(self) -> bool:
        """True: the built-in flow integrates the equations of motion between events."""
        return True

    @property
    def records_contacts(self) -> bool:
        """True: modes change at events only, and each event stores the modes and the impulses."""
        return True

    def check(self, system: System) -> None:
        """Accept every system, because this engine can run all that a system can declare."""

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return the number of contacts that Lemke's method may solve together, as ``{"n_pivoted": number}``.

        The workspace holds a tableau of this size. ``n_slots`` is the number of contacts near each other for which the
        memory is laid out.
        """
        return {"n_pivoted": pivoted_contacts(solver_of(self.solver), n_slots)}

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        """Return solver, policy, tolerances and first steps [s] as numbers of the workspace.

        An option that is None follows from the sizes of the system, and is at most the value for a body of 1 mm.
        """
        time = _given(self.time_tolerance, min(TIME, RELATIVE_TIME * scales.time))
        largest_step = _given(self.largest_step, min(_LARGEST_STEP, _LARGEST_RELATIVE_STEP * scales.time))
        step = min(largest_step, scales.period / self.steps_per_period)
        return {
            Options.solver: solver_of(self.solver),
            Options.painleve_policy: _POLICIES.index(self.painleve),
            Tolerance.relative: self.tolerance,
            Tolerance.impact: self.impact_tolerance,
            Tolerance.time: time,
            Tolerance.resolution: time,
            Tolerance.gap: _given(self.gap_tolerance, min(GAP, RELATIVE_GAP * scales.length)),
            Tolerance.velocity: _given(self.velocity_tolerance, min(VELOCITY, RELATIVE_VELOCITY * scales.speed)),
            Tolerance.largest_step: step,
            Island.free_step: step,
            Island.closed_step: step,
        }

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        """Call the compiled entry point ``advance``; the result is its status."""
        return int(call("advance", most_steps, int(pauses_before_end)))


def _given(option: float | None, by_size: float) -> float:
    """Value of an option, or the value that follows from the sizes of the system if the option is None."""
    return by_size if option is None else option
