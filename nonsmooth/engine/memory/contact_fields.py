"""The fields of a contact in a slot: arrays of the memory with one number, or a few, for every slot.

``contact_at(S, w, k, c)`` (:mod:`nonsmooth.engine.native.kernel`) gives contact ``c`` with these fields:
``contact.gap_rate`` is ``w[S.gap_rate + c]``, ``contact.mode`` is ``k[S.mode + c]``, and where a field has several
numbers they stand behind one another, ``contact.rate[1]`` is ``w[S.rate + 3 * c + 1]``.  The memory is the same.
"""

from __future__ import annotations

from nonsmooth.engine.memory.tables import COUNTS, FLOAT_ARRAYS, INTEGER_ARRAYS

_NAMES = (
    # what it is
    "normal_function",
    "traction_function",
    "frame_a",
    "frame_b",
    "body_a",
    "body_b",
    "lever_a",
    "lever_b",
    "size",
    "reach",
    "contact_time",
    "identity",
    # where it stands
    "geometry",
    "axes",
    "rate",
    "bias",
    "touching",
    "compliant_force",
    # its mode, and the forces that it holds by
    "mode",
    "mode_agreed",
    "direction",
    "direction_agreed",
    "force",
    "null_space_force",
    "tied",
    "holds",
    "static_margin",
    "small_force_of",
    "mobility",
    "least_force",
    # its gap at both ends of a step, and how it can change
    "gap_rate",
    "gap_rate_first",
    "gap_rate_end",
    "gap_end",
    "rate_end",
    "past_first",
    "past_end",
    "speed_first",
    "speed_end",
    "fall_first",
    "fall_end",
    "arm_first",
    "arm_end",
    "feature",
    # what an event does to it
    "code_before",
    "code_during",
    "event_impulse",
    "prescribed_rate",
    "closes",
    "member",
    "impacting",
)
_ARRAYS = FLOAT_ARRAYS | INTEGER_ARRAYS
NUMBERS = {name: _ARRAYS[name]({**dict.fromkeys(COUNTS, 0), "n_slots": 1}) for name in _NAMES}
"""How many numbers a field has."""
