"""The event-driven engine: smooth steps of high order between events that are located to the last digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

from nonsmooth.engine.memory.modes import POLICIES
from nonsmooth.engine.memory.solvers import SOLVERS, pivoted_contacts, solver_number
from nonsmooth.interfaces.engine import Engine
from nonsmooth.parameters import parameter

if TYPE_CHECKING:
    from nonsmooth.engine.memory.memory import Memory
    from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class EventDriven(Engine):
    """Integrates between events, finds each of them, and solves there for impulses and new modes.

    Its tolerances and limits are numerical, not physical; the defaults suit bodies from millimetres to metres.
    """

    tolerance: float = parameter(1e-9, doc="relative error of a step of the flow", above=0.0, maximum=1e-2)
    impact_tolerance: float = parameter(1e-8, doc="relative error of a step inside an impact", above=0.0, maximum=1e-2)
    time_tolerance: float = parameter(1e-12, doc="accuracy of event times", unit="s", above=0.0, maximum=1e-3)
    gap_tolerance: float = parameter(1e-12, doc="gap that counts as closed", unit="m", above=0.0, maximum=1e-3)
    velocity_tolerance: float = parameter(
        2e-8, doc="relative velocity that counts as zero", unit="m/s", above=0.0, maximum=1e-2
    )
    largest_step: float = parameter(0.1, doc="largest step of the flow", unit="s", above=0.0, maximum=1e9)
    steps_per_period: float = parameter(4.0, doc="least steps per time scale of a prescribed motion", minimum=1.0)
    painleve: str = parameter(
        "impact",
        doc="what happens where sliding has no contact force: an impact without collision by the contact's law, "
        "the same without loss as a stiff spring does it, or the end of the run",
        unit="",
        choices=POLICIES,
    )
    solver: str = parameter("auto", doc="solver of the contact problem", unit="", choices=SOLVERS)

    @property
    def layers(self) -> tuple[str, ...]:
        """All."""
        return ("delassus", "contact", "impact", "flow")

    @property
    def records_contacts(self) -> bool:
        """Yes: modes change at events only."""
        return True

    def check(self, system: System) -> None:
        """Refuse nothing: whatever can be declared can be run."""

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return for how many contacts Lemke's tableau is laid out."""
        return {"n_pivoted": pivoted_contacts(solver_number(self.solver), n_slots)}

    def settings(self, time_scale: float) -> Mapping[str, float]:
        """Return tolerances and first steps."""
        step = min(self.largest_step, time_scale / self.steps_per_period)
        return {
            "solver": solver_number(self.solver),
            "policy": POLICIES.index(self.painleve),
            "rtol": self.tolerance,
            "impact_rtol": self.impact_tolerance,
            "time_tolerance": self.time_tolerance,
            "time_resolution": self.time_tolerance,
            "gap_tolerance": self.gap_tolerance,
            "velocity_tolerance": self.velocity_tolerance,
            "h_max": step,
            "h_free": step,
            "h_closed": step,
        }

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Call the entry point of that name."""
        return int(call("advance", most_steps, int(wary)))
