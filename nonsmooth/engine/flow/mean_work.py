"""What averaged forces do to the energy."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel()
def account_for_mean_forces(ws: Workspace) -> None:
    """Book the work of averaged normal forces so far, geometry being at hand: as gaps close it is taken back."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_averaged and not contact.is_compliant:
            ws.totals.closing_loss -= contact.mean_force[0] * (contact.gap - contact.mean_gap)
            contact.mean_gap = contact.gap
