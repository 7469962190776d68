"""The state of a contact in an impact, its phases, and its laws.

The state is (P_n, P_1, P_2, x, W, D, E, L): the impulses, the deformation, the work of the normal force, the energy
dissipated by friction, the stored energy, and the part of that which is lost when the contact opens. The laws give the
normal force as a function of x, and the efficiency of the energy transfer as a function of the gap rate.
"""

from __future__ import annotations

from typing import Protocol

from nonsmooth.engine.memory.layout import IMPACT_STATE
from nonsmooth.engine.memory.modes import Phase
from nonsmooth.engine.native.kernel import ActiveContact, Floats, Workspace, at, call_scalar, impact_state, kernel
from nonsmooth.engine.numerics.vectors import Pair

NOISE = 1e-12
"""Rate that does not switch a phase, relative to the largest speed of the impact. It is round-off."""
_SEPARATES = 1e-300
"""Least gap rate of an expansion [m/s]. At rate 0 a law returns :func:`returned_part`, not an efficiency."""


class ContactState(Protocol):
    """Numbers of an active contact in the state of an impact, or their slopes in pseudo-time."""

    impulse: Floats
    """Impulse along n, t1, t2 [N s]. The next two are parts of it."""
    normal_force: float
    """Normal impulse [N s]. It is named after its slope, the normal force [N]."""
    friction: Pair
    """Tangential impulse [N s]. It is named after its slope, the friction [N]."""
    deformation: float
    """Deformation x [m]."""
    work: float
    """Work W of the normal force on the bodies [J]."""
    dissipated: float
    """Energy D dissipated by friction [J]."""
    energy: float
    """Stored energy E [J]."""
    lost: float
    """Part L of the stored energy that is lost when the contact opens [J]."""


# --- the state --------------------------------------------------------------------------------------------------------


@kernel("i8(ws)")
def state_size(ws: Workspace) -> int:
    """Number of floats of the state of the active contacts."""
    return IMPACT_STATE * len(ws.actives)


@kernel("impact_state(ws, i8, ActiveContact)")
def state_at(ws: Workspace, y: int, active: ActiveContact) -> ContactState:
    """Numbers of an active contact in the state, or slope of a state, at offset ``y`` of the floats."""
    state: ContactState = impact_state(ws.floats, y, active.index)
    return state


@kernel("impact_state(ws, ActiveContact)")
def state_of(ws: Workspace, active: ActiveContact) -> ContactState:
    """Numbers of an active contact in the present state of the impact."""
    return state_at(ws, ws.impact.y.start, active)


@kernel("b1(ActiveContact)")
def is_loaded(active: ActiveContact) -> bool:
    """True if an active contact is in compression or in expansion: its force follows from its deformation."""
    return active.phase == Phase.COMPRESSION or active.phase == Phase.EXPANSION


@kernel("b1(ws, ActiveContact)")
def is_lone(ws: Workspace, active: ActiveContact) -> bool:
    """True if an active contact is the only one with a load, and its normal impulse the variable of integration."""
    return active.index == ws.impact.lone_contact


# --- laws -------------------------------------------------------------------------------------------------------------


@kernel("f8(ws, ActiveContact, f8)")
def normal_force(ws: Workspace, active: ActiveContact, deformation: float) -> float:
    """Normal force of an active contact at a ``deformation`` [m], Eq. (20) [N].

    It is 1 if its own impulse is the variable of integration, because force is the slope of impulse.
    """
    if is_lone(ws, active):
        return 1.0
    if deformation <= 0.0:
        return 0.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.impact_force_function, deformation, at(ws.floats, contact.impact_force_parameters))


@kernel("f8(ws, ActiveContact, f8)")
def efficiency(ws: Workspace, active: ActiveContact, rate: float) -> float:
    """Efficiency of the energy transfer of an active contact at a gap ``rate`` [m/s], Eq. (28) [1].

    It is 1 if the contact is to have no loss, whatever its law. At rate 0 laws return the part of the stored energy
    that the contact returns before it opens.
    """
    if active.is_lossless:
        return 1.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.efficiency_function, rate, at(ws.floats, contact.efficiency_parameters))


@kernel("f8(ws, ActiveContact, f8)")
def expansion_efficiency(ws: Workspace, active: ActiveContact, rate: float) -> float:
    """Efficiency of the expansion of an active contact at a gap ``rate`` [m/s], Eq. (28) [1]."""
    # at rate 0 a law returns another number: the part of the energy that is returned before the contact opens
    return efficiency(ws, active, max(rate, _SEPARATES))


@kernel("f8(ws, ActiveContact)")
def returned_part(ws: Workspace, active: ActiveContact) -> float:
    """Part of the stored energy that an active contact returns before it opens [1].

    Below 1 it opens under load: while energy, and so force, is left, which is then lost. A loss that is spread over the
    expansion is in :func:`expansion_efficiency` instead.
    """
    # by convention of the laws, their value at rate 0 is this part
    return efficiency(ws, active, rate=0.0)


@kernel("f8(ws, ActiveContact)")
def least_efficiency(ws: Workspace, active: ActiveContact) -> float:
    """Smaller one of returned part and efficiency of a slow expansion [1]. Below 1 an active contact loses energy."""
    # _SEPARATES: as slow as an expansion can be, but not rate 0, at which laws return the returned part
    return min(returned_part(ws, active), efficiency(ws, active, _SEPARATES))
