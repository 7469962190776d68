"""Work of forces averaged over time: they act while their gaps change, so they do work that exact forces do not."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel()
def account_for_mean_forces(ws: Workspace) -> None:
    """Subtract the work of averaged normal forces since the last call from the closing loss [J].

    ``mean_gap`` becomes the present gap [m], up to which the work is accounted for. The geometry must be evaluated. The
    work of compliant forces is no loss.
    """
    for contact in ws.contacts:
        if contact.is_averaged and not contact.is_compliant:
            # a force that pushes while the gap opens gives energy, which is a negative loss
            ws.totals.closing_loss -= contact.mean_force[0] * (contact.gap - contact.mean_gap)
            contact.mean_gap = contact.gap
