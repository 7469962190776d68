"""What averaged forces do to the energy."""

from __future__ import annotations

from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel()
def book_mean_forces(ws: Workspace) -> None:
    """Book the work of averaged normal forces so far, geometry being at hand: as gaps close it is taken back."""
    for c in range(ws.n_contacts):
        contact = ws.contacts[c]
        if contact.averaged != OPEN and contact.normal_function == 0:
            ws.closing_loss -= contact.mean_force[0] * (contact.gap - contact.mean_gap)
            contact.mean_gap = contact.gap
