"""What averaged forces do to the energy."""

from __future__ import annotations

from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, kernel


@kernel("void(S, F, I)")
def book_mean_forces(S: Scalars, w: Floats, k: Integers) -> None:
    """Book the work of averaged normal forces so far, geometry being at hand: as gaps close it is taken back."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.averaged != OPEN and contact.normal_function == 0:
            S.closing_loss -= contact.mean_force[0] * (contact.gap - contact.mean_gap)
            contact.mean_gap = contact.gap
