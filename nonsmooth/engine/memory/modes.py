"""Enumerations of the engine, with their texts: modes of contacts, causes of events, limits of steps, status."""

from __future__ import annotations

from enum import IntEnum


class Limit(IntEnum):
    """Cause that limited the length of a step."""

    NO_STEP = 0
    """No step was taken: an event follows another one at once, or the neighbour list was renewed."""
    ERROR = 1
    """The estimated error."""
    LARGEST_STEP = 2
    """The largest step of the engine."""
    NEIGHBOUR_LIST = 3
    """The neighbour list is valid only up to the end of the step."""
    SAMPLES = 4
    """The buffer of samples is full."""
    FIRST_STEP = 5
    """The first step after an event is short."""
    CLOSING_GAP = 6
    """A gap is about to close."""
    SINGULARITY = 7
    """Sliding comes near Painleve's singularity."""
    STOPPING_SLIP = 8
    """A slip is about to stop."""
    EVENT = 9
    """An event."""
    CROWDED_EVENTS = 10
    """Too many guards fire in the step."""
    END = 11
    """The end of the run."""
    AVERAGING = 12
    """The end of the averaging of forces."""
    TURN = 13
    """Bodies turn too far in ballistic motion."""


LIMITS = (
    "no step",
    "error",
    "largest step",
    "list of near contacts",
    "samples",
    "first step in contact",
    "gap about to close",
    "Painleve singularity",
    "slip that stops",
    "event",
    "crowded events",
    "end of the run",
    "averaging of forces",
    "turning in flight",
)
"""Text for each limit, by its number."""


class Mode(IntEnum):
    """Mode of a contact between events."""

    UNKNOWN = -1
    """No mode is known. Only a contact problem may begin so."""
    OPEN = 0
    """The bodies are apart, or separate."""
    STICK = 1
    """The contact is closed, and friction holds it."""
    SLIDE = 2
    """The contact is closed and slips, or is about to."""


BEFORE, DURING, AFTER = 0, 3, 6
"""First bits of the codes of a contact before, during and after an event, Eq. (29), in the recorded integer."""
CODE = 7
"""Mask of the three bits of a code."""


class Cause(IntEnum):
    """Cause of an event."""

    START = 0
    """The run begins."""
    IMPACT = 1
    """A gap closes with an approach."""
    LIFT_OFF = 2
    """A normal force vanishes."""
    SLIP_TO_STICK = 3
    """A slip comes to rest."""
    STICK_TO_SLIP = 4
    """Friction reaches its static bound."""
    CLOSING = 5
    """The bounces of an accumulation (Zeno sequence) are left out."""
    PAINLEVE = 6
    """A sliding contact has no force, and an impact without collision follows."""
    END = 7
    """The run ends."""
    JAM = 8
    """A slip jams at the Painleve singularity."""
    GUARD = 9
    """A guard of the user fires."""
    TOUCH = 10
    """A compliant contact touches."""
    FEATURE_END = 11
    """A contact passes the end of its features."""
    FEATURE_CHANGE = 12
    """A contact passes to other features."""
    AVERAGING = 13
    """Averaged forces begin or end."""
    STEP = 14
    """An engine that has no events of its own steps."""


CAUSES = (
    "start",
    "impact",
    "lift-off",
    "slip to stick",
    "stick to slip",
    "closing of an accumulation",
    "impact without collision",
    "end",
    "jamming of a slip",
    "guard of the scenario",
    "touch of a compliant contact",
    "end of a feature",
    "change of feature",
    "averaging of forces",
    "step of the engine",
)
"""Text for each cause, by its number."""

NO_CONTACT = -1
"""Value of the index of a contact if there is no contact."""
NO_RELEASE = Cause.START
"""Value of a cause of release if no jump of the contact point has released the contact."""


class Phase(IntEnum):
    """Phase of a contact within an impact."""

    IDLE = 0
    """No force acts."""
    COMPRESSION = 1
    """The bodies approach each other, and the contact stores energy."""
    EXPANSION = 2
    """The bodies separate, and the contact returns energy."""
    HELD = 3
    """The contact stays closed without restitution: a unilateral constraint."""


class Truncation(IntEnum):
    """Why an impact was cut short."""

    NONE = 0
    """It was not cut short, or has no end."""
    SLOW = 1
    """The approach that remains is negligible, relative to the fastest rate before the impact."""
    FAST = 2
    """A heavy body approaches, and the compressions of light bodies between it and others stop it gradually."""


class ImpactOutcome(IntEnum):
    """How the integration of an impact ended."""

    FINISHED = 1
    """No contact is loaded."""
    ENDLESS = 2
    """The integration was stopped: too many steps, or an interrupt."""
    INVALID = 3
    """A law gave a number that is not finite, or not positive."""
    MOVED = 4
    """The impact continues, but has reached the rim of its window."""


class Painleve(IntEnum):
    """What the engine does if sliding has no contact force (Painleve's paradox)."""

    BY_LAW = 0
    """An impact without collision, by the impact law of the contact."""
    COMPLIANT = 1
    """The same without loss, as a stiff spring does it."""
    REFUSE = 2
    """The run ends."""


class Status(IntEnum):
    """Result of a call of the engine, of a step, or of an instant."""

    RUNNING = 0
    """The motion continues."""
    DONE = 1
    """The end time is reached."""
    PAUSED = 2
    """The call ends before the end time: the buffers fill, or the run is interrupted."""
    STEP_TOO_SMALL = 3
    """The step is smaller than the time tolerance."""
    NOT_FINITE = 4
    """A law or a body gave a number that is not finite."""
    IMPACT_ENDLESS = 5
    """An impact did not end within its steps."""
    NO_CONTACT_SOLUTION = 6
    """The contact problem has no solution."""
    UPDATE_ENDLESS = 7
    """Impacts at one instant did not settle into modes."""
    STALLED = 8
    """Events accumulate, and time stops passing."""
    STOPPED = 9
    """A guard of the user ends the run."""
    NO_SLOT = 10
    """More contacts are near each other than can be listed."""
    PARADOX_REFUSED = 11
    """Sliding has no contact force, and the run is to end there."""
    JOINTS_APART = 12
    """Joints contradict each other."""
    GAP_UNEXPLAINED = 13
    """A gap is larger than the tolerances allow."""
    MOTION_UNEXPLAINED = 14
    """A projection moves a body farther than the tolerances allow."""
    QUATERNION_UNEXPLAINED = 15
    """The length of a quaternion differs from 1 by more than the tolerances allow."""
    CONDITION_MET = 16
    """The condition that ends the run holds."""
    GAP_UNDECIDED = 17
    """It cannot be decided whether a gap closes within a step."""
    PASSED = 18
    """Bodies passed into each other."""


REASONS = {
    Status.STOPPED: "a guard of the scenario ended the run",
    Status.DONE: "the end time was reached",
    Status.CONDITION_MET: "the condition that was given was met",
    Status.PAUSED: "the run was interrupted",
    Status.STEP_TOO_SMALL: "the step size fell below the time tolerance",
    Status.NOT_FINITE: "a law or a body returned a number that is not finite",
    Status.IMPACT_ENDLESS: "an impact did not end within its steps",
    Status.NO_CONTACT_SOLUTION: "the contact forces have no solution, and no impulse without collision leads to one",
    Status.UPDATE_ENDLESS: "impacts at one instant did not settle into a mode",
    Status.JOINTS_APART: "joints contradict each other: there is no motion that keeps all of them closed",
    Status.GAP_UNEXPLAINED: "a gap differs from zero by more than the tolerances allow",
    Status.GAP_UNDECIDED: "whether a gap closes within a step is not decided after ten thousand evaluations",
    Status.PASSED: "bodies passed into each other",
    Status.MOTION_UNEXPLAINED: "closing contacts or joints would move a body farther than the tolerances allow",
    Status.QUATERNION_UNEXPLAINED: "the length of a quaternion differs from one by more than the tolerances allow",
    Status.PARADOX_REFUSED: "sliding has no contact force (Painleve), and the option painleve is 'refuse'",
    Status.NO_SLOT: "more contacts came near each other than a system of this size has room for",
    Status.STALLED: "the run stalls: a contact has more than a hundred events within a hundredth of its contact time",
}
"""Why a run ended, by status."""

ENUMERATIONS = (Mode, Cause, Phase, Truncation, ImpactOutcome, Painleve, Status, Limit)
"""All enumerations of this module. Signatures of kernels use their names."""


def word(a: list[int], b: list[int], c: list[int]) -> str:
    """Mode word of a system by Eq. (29): bits a (closed), b (approaches), c (slips), first contact rightmost in each.

    >>> word([1, 0], [0, 0], [1, 0])
    '{01,00,01}'
    """
    return "{" + ",".join("".join(str(bit) for bit in reversed(bits)) for bits in (a, b, c)) + "}"
