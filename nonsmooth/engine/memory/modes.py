"""Enumerations of the engine, with their texts: modes of contacts, causes of events, limits of steps, status."""

from __future__ import annotations

from enum import IntEnum


class Limit(IntEnum):
    """Cause that limited the length of a step."""

    NO_STEP = 0
    """No step was taken: an event follows another one at once, or the neighbour list was renewed."""
    ERROR = 1
    """A longer step would exceed the tolerance of the integrator's estimated error."""
    LARGEST_STEP = 2
    """The step has the largest length that the engine's option ``largest_step`` allows."""
    NEIGHBOUR_LIST = 3
    """The neighbour list is valid only up to the end of the step."""
    SAMPLES = 4
    """The buffer of samples is full at the end of the step."""
    FIRST_STEP = 5
    """The first step after an event is short, to resolve the end of a bounce or the start of a compliant force."""
    CLOSING_GAP = 6
    """The step ends shortly before a gap is expected to close."""
    SINGULARITY = 7
    """The step ends shortly before sliding reaches Painleve's singularity."""
    STOPPING_SLIP = 8
    """The step ends shortly before a slip is expected to stop."""
    EVENT = 9
    """The step ends at an event, or at the time at which bodies in ballistic motion are expected to touch."""
    CROWDED_EVENTS = 10
    """The step was shortened to a quarter, because its first event could not be located, for example among many."""
    END = 11
    """The step ends at the end time of the run."""
    AVERAGING = 12
    """The step ends with the time-stepping fallback, or was shortened because gaps deviate too far in the fallback."""
    TURN = 13
    """The step ends as a body in ballistic motion has turned by half a radian: bounds of gaps hold up to this angle."""


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
    """The bodies do not touch, or they separate."""
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
"""Value of the field ``release`` of a contact that keeps its constraints at a jump of its contact point.

The jump may end the contact (``LIFT_OFF``) or its sticking (``STICK_TO_SLIP``): the field then holds this cause.
``START`` is never such a cause.
"""


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
    """The impact was not cut short: it ended, or the integration failed."""
    SLOW = 1
    """The remaining approach of contacts is negligible, relative to the fastest approach before the impact."""
    FAST = 2
    """A heavy body approaches, and the compressions of light bodies between it and others stop it gradually."""


class ImpactOutcome(IntEnum):
    """How the integration of an impact ended."""

    FINISHED = 1
    """The impact has ended: no contact has a force."""
    ENDLESS = 2
    """The integration was stopped: too many steps, or an interrupt."""
    INVALID = 3
    """A law gave a number that is not finite, or its force is not positive, so that it has no scale."""
    MOVED = 4
    """The impact continues in another window, because a contact at the border of this window has become active.

    A window is the part of the contacts that is integrated at a time.
    """


class Painleve(IntEnum):
    """What the engine does if sliding has no contact force (Painleve's paradox)."""

    BY_LAW = 0
    """An impact without collision, by the impact law of the contact."""
    COMPLIANT = 1
    """An impact without collision and without loss of energy, as by a stiff spring."""
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
    """Contacts near each other need more candidates, blocks or entries of a matrix than the workspace can hold."""
    PARADOX_REFUSED = 11
    """Sliding has no contact force, and the option ``painleve`` is "refuse"."""
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
    PASSED = 18
    """Bodies passed into each other."""
    LIST_FULL = 20
    """More contacts are near than there are slots for active contacts. The memory grows, and the run continues."""


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
    Status.PASSED: "bodies passed into each other",
    Status.MOTION_UNEXPLAINED: "closing contacts or joints would move a body farther than the tolerances allow",
    Status.QUATERNION_UNEXPLAINED: "the length of a quaternion differs from one by more than the tolerances allow",
    Status.PARADOX_REFUSED: "sliding has no contact force (Painleve), and the option painleve is 'refuse'",
    Status.NO_SLOT: "more contacts came near each other than a system of this size has room for",
    Status.LIST_FULL: "more contacts came near each other than there were places for",
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
