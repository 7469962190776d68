"""Modes of a contact, causes of events, reasons to stop: the engine's codes and their words."""

from __future__ import annotations

from enum import IntEnum


class Mode(IntEnum):
    """Mode of a contact between events."""

    OPEN = 0
    """The bodies are apart, or separate."""
    STICK = 1
    """The contact is closed, and friction holds it."""
    SLIDE = 2
    """The contact is closed and slips, or is about to."""


OPEN, STICK, SLIDE = (int(mode) for mode in Mode)
BEFORE, DURING, AFTER = 0, 3, 6
"""The bits at which a contact's three codes begin in the integer that is kept of them with an event,"""
CODE = 7
"""and all bits of one code."""


class Cause(IntEnum):
    """What makes an instant an event."""

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


START, IMPACT, LIFT_OFF, SLIP_TO_STICK, STICK_TO_SLIP, CLOSING, PAINLEVE, END, JAM, GUARD, TOUCH, FEATURE_END = (
    int(cause) for cause in list(Cause)[:12]
)
FEATURE_CHANGE, AVERAGING, STEP = (int(cause) for cause in list(Cause)[12:])

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

NO_RELEASE = 0
"""Cause of the release of a contact that no jump of its contact point released."""


class Truncation(IntEnum):
    """How an impact ended that was cut short."""

    NONE = 0
    """It was not cut short, or has no end."""
    SLOW = 1
    """The approach that remains is negligible, relative to the fastest rate before the impact."""
    FAST = 2
    """A heavy body approaches, and the compressions of light bodies between it and others stop it gradually."""


BY_LAW, COMPLIANT, REFUSE = range(3)
"""What to do where sliding has no contact force."""
POLICIES = ("impact", "compliant", "refuse")
"""Their names."""

RUNNING, DONE, PAUSED = 0, 1, 2
STEP_TOO_SMALL, NOT_FINITE, IMPACT_ENDLESS, NO_CONTACT_SOLUTION, UPDATE_ENDLESS, STALLED = range(3, 9)
STOPPED, NO_SLOT, PARADOX_REFUSED, JOINTS_APART = range(9, 13)
GAP_UNEXPLAINED, MOTION_UNEXPLAINED, QUATERNION_UNEXPLAINED = range(13, 16)
CONDITION_MET = 16
GAP_UNDECIDED, PASSED = 17, 18
"""Status of the engine."""

REASONS = {
    STOPPED: "a guard of the scenario ended the run",
    DONE: "the end time was reached",
    CONDITION_MET: "the condition that was given was met",
    PAUSED: "the run was interrupted",
    STEP_TOO_SMALL: "the step size fell below the time tolerance",
    NOT_FINITE: "a law or a body returned a number that is not finite",
    IMPACT_ENDLESS: "an impact did not end within its steps",
    NO_CONTACT_SOLUTION: "the contact forces have no solution, and no impulse without collision leads to one",
    UPDATE_ENDLESS: "impacts at one instant did not settle into a mode",
    JOINTS_APART: "joints contradict each other: there is no motion that keeps all of them closed",
    GAP_UNEXPLAINED: "a gap is none that the tolerances explain",
    GAP_UNDECIDED: "whether a gap closes within a step is not decided after ten thousand looks at it",
    PASSED: "bodies passed into each other",
    MOTION_UNEXPLAINED: "closing contacts or joints would move a body farther than the tolerances explain",
    QUATERNION_UNEXPLAINED: "a quaternion has left unit length by more than the tolerances explain",
    PARADOX_REFUSED: "sliding has no contact force (Painleve), and the option painleve is 'refuse'",
    NO_SLOT: "more contacts came near each other than a system of this size has room for",
    STALLED: "the run stalls: a contact has more than a hundred events within a hundredth of its contact time",
}


def word(a: list[int], b: list[int], c: list[int]) -> str:
    """Write a mode word from the bits of Eq. (29), first contact rightmost in every group.

    >>> word([1, 0], [0, 0], [1, 0])
    '{01,00,01}'
    """
    return "{" + ",".join("".join(str(bit) for bit in reversed(bits)) for bits in (a, b, c)) + "}"
