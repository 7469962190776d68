"""The unknowns of the contact problem: components of forces, and the turns of directions."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, kernel, unknown_at


@kernel("void(S, F, I, i8, i8, i8, i8)")
def list_unknown(S: Scalars, w: Floats, k: Integers, i: int, a: int, r: int, turn: int) -> None:
    """Let unknown ``i`` be the force of the active contact ``a`` along direction ``r``, or its turn (1)."""
    unknown = unknown_at(S, w, k, i)
    unknown.contact, unknown.direction, unknown.turn = a, r, turn


@kernel("f8(S, F, I, i8)")
def force_of(S: Scalars, w: Floats, k: Integers, i: int) -> float:
    """Return the force that unknown ``i`` is."""
    unknown = unknown_at(S, w, k, i)
    return float(active_at(S, w, k, unknown.contact).force[unknown.direction])


@kernel("void(S, F, I, i8, f8)")
def set_force(S: Scalars, w: Floats, k: Integers, i: int, value: float) -> None:
    """Set the force that unknown ``i`` is."""
    unknown = unknown_at(S, w, k, i)
    active_at(S, w, k, unknown.contact).force[unknown.direction] = value
