"""Numbers of a run: what was asked for, totals, counters, buffers of the output, and why it ended."""

from __future__ import annotations

import math
from typing import final

from nonsmooth.engine.memory.declare import (
    FloatRow,
    IntegerRow,
    Life,
    Singleton,
    address,
    floats,
    integers,
    one_of,
    question,
    real,
    whole,
)
from nonsmooth.engine.memory.modes import LIMITS, Cause, Status
from nonsmooth.engine.memory.sizes import fixed, per, sample_numbers

_REQUEST, _STATE, _OUTPUT = Life.REQUEST, Life.STATE, Life.OUTPUT


@final
class Request(Singleton, key="request"):
    """What a call requests."""

    t_end: float = real(_REQUEST, "s", "End time.")
    sample_start: float = real(_REQUEST, "s", "Time of the first sample.")
    sample_interval: float = real(_REQUEST, "s", "Time between samples.")
    sample_span: float = real(_REQUEST, "s", "Largest step that the buffer of samples allows.", begin=math.inf)
    n_known_events: int = whole(_REQUEST, "Number of events of a resumed run that are recorded already.")
    is_resumed: bool = question(_REQUEST, "The run continues an earlier one.")
    n_work: int = whole(_REQUEST, "Work since the last interrupt check, in evaluations of a contact.")
    work_budget: int = whole(_REQUEST, "Work until the next interrupt check, in evaluations of a contact.")
    interrupt_check: int = address(_REQUEST, "Address of the interrupt check, or 0.")
    is_interrupted: bool = question(_REQUEST, "The run is to stop.")


@final
class Totals(Singleton, key="totals"):
    """Energies and counts of a run since its start."""

    driven_work: float = real(_STATE, "J", "Work of driven bodies at instants.")
    restitution_loss: float = real(_STATE, "J", "Energy dissipated by restitution.")
    friction_loss: float = real(_STATE, "J", "Energy dissipated by friction at instants.")
    closing_loss: float = real(_STATE, "J", "Energy dissipated by closings and projections.")
    n_impacts: int = whole(_STATE, "Number of impacts.")
    n_steps: int = whole(_STATE, "Number of accepted steps.")
    n_rejected: int = whole(_STATE, "Number of rejected steps.")
    n_listings: int = whole(_STATE, "Number of times that the neighbour list was made.")
    n_evaluations: int = whole(_STATE, "Number of evaluations of contact forces.")
    n_impact_steps: int = whole(_STATE, "Number of steps of impacts.")
    n_gap_evaluations: int = whole(_STATE, "Number of evaluations of gaps in search of a root.")
    n_steps_limited: IntegerRow = integers(_STATE, fixed(len(LIMITS)), "Number of steps that each limit ended.")


@final
class Run(Singleton, key="run"):
    """How a run is going, and why it ended."""

    has_started: bool = question(_STATE, "The start is recorded.")
    n_calls: int = whole(_STATE, "Number of calls of the engine.")
    failure: Status = one_of(Status, _OUTPUT, "Status of a failed check, else running.")
    failed_number: int = whole(_OUTPUT, "Contact, joint or body of the failed check.")
    found: float = real(_OUTPUT, "", "Value that the failed check found, in the unit of the check.")
    allowed: float = real(_OUTPUT, "", "Value that the failed check allows, in the unit of the check.")
    passed_pair: int = whole(_OUTPUT, "Pair of convex parts that passed into each other, or -1.", begin=-1)
    passed_depth: float = real(_OUTPUT, "m", "Depth of that pair.")
    passed_allowed: float = real(_OUTPUT, "m", "Depth that the tolerances allow.")
    n_past_map: int = whole(_OUTPUT, "Number of contacts of an impact law that wrote past its block.")
    has_too_many_blocks: bool = question(
        _OUTPUT, "A contact problem has more blocks, or a wider band, than the memory holds."
    )

    worst_energy: float = real(_STATE, "J", "Largest unexplained change of energy.")
    worst_energy_ratio: float = real(_STATE, "1", "That change over the energy that the tolerances allow.")
    worst_energy_time: float = real(_STATE, "s", "Time of that change.")
    energy_scale: float = real(_STATE, "J", "Energy that the unexplained change is compared with.")
    jumped_energy: float = real(_STATE, "J", "Energy that springs gained by beginning inside of a body.")
    jump_time: float = real(_STATE, "s", "Last time of such a gain.")


@final
class OutputNumbers(Singleton, key="output"):
    """Buffers of events and samples, which Python empties between calls."""

    n_events: int = whole(_OUTPUT, "Number of events in the buffers.")
    floats_used: int = whole(_OUTPUT, "Number of floats in use.")
    integers_used: int = whole(_OUTPUT, "Number of integers in use.")
    last_floats: int = whole(_OUTPUT, "Where the floats of the last event begin.")
    last_integers: int = whole(_OUTPUT, "Where the integers of the last event begin.")
    last_cause: Cause = one_of(Cause, _OUTPUT, "Cause of the last event.")
    last_contact: int = whole(_OUTPUT, "Contact of the last event.")
    last_phases: int = whole(_OUTPUT, "Phases of the impact of the last event.")
    n_samples: int = whole(_OUTPUT, "Number of samples in the buffer.")
    sample_index: int = whole(_STATE, "Number of the next sample.")
    next_sample: float = real(_STATE, "s", "Time of the next sample.")
    event_numbers: FloatRow = floats(_OUTPUT, per(1, "event_floats"), "", "Floats of the events.", is_late=True)
    event_codes: IntegerRow = integers(_OUTPUT, per(1, "event_integers"), "Integers of the events.", is_late=True)
    samples: FloatRow = floats(_OUTPUT, sample_numbers, "", "Time, state and totals of each sample.", is_late=True)
