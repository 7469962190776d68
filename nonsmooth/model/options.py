"""Options of a run that are numerical, not physical."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.modes import POLICIES
from nonsmooth.engine.memory.solvers import SOLVERS
from nonsmooth.parameters import Component, parameter


@final
@dataclass(frozen=True)
class Options(Component):
    """Tolerances and limits; the defaults suit bodies from millimetres to metres."""

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
