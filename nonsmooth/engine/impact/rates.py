"""Rates of the multiple impact in pseudo-time: forces, impulses, deformation, energies.

For every active contact the state holds (P_N, P_1, P_2, x, W, D, E, L): impulses, deformation, work of the
normal force, work rubbed away by friction, stored energy, and the part of it that is lost when the contact opens.
With F_i = f_i(x_i), Eqs. (23)-(28) divided by a common clock s read
dP_i/ds = (F_i, T_i),  dx_i/ds = -g'_i / efficiency(g'_i),  z = z_0 + G P.
A lone contact needs no deformation, only its energy: with F = 1 the clock is its impulse, and every phase is
a polynomial that the integrator follows exactly.
"""

from __future__ import annotations

from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.problem import follow_slip
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_scalar, kernel, room

IDLE, COMPRESSION, EXPANSION, HELD = 0, 1, 2, 3
"""Phase of a contact in an impact; HELD: closed without restitution, a unilateral constraint."""

IMPULSE, DEFORMATION, WORK, RUBBED, ENERGY, LOST = 0, 3, 4, 5, 6, 7
"""Where these stand in the state of an impact, of every contact."""
STRIDE = 8
"""Floats of one contact in that state."""

NOISE = 1e-12
"""Rates below this, relative to the impact speed, do not switch a phase."""


@kernel("f8(S, F, I, i8, f8)")
def normal_force(S: Scalars, w: Floats, k: Integers, a: int, x: float) -> float:
    """Return the force of the active contact ``a`` at the deformation ``x``, Eq. (20)."""
    if a == S.lone:
        return 1.0
    if x <= 0.0:
        return 0.0
    c = k[S.active + a]
    return call_scalar(k[S.force_function + c], x, at(w, k[S.force_parameters + c]))


@kernel("f8(S, F, I, i8, f8)")
def efficiency(S: Scalars, w: Floats, k: Integers, a: int, rate: float) -> float:
    """Return the efficiency of the energy transfer of the active contact ``a``, Eq. (28)."""
    if S.lossless == 1:
        return 1.0
    c = k[S.active + a]
    return call_scalar(k[S.efficiency_function + c], rate, at(w, k[S.efficiency_parameters + c]))


@kernel("void(S, F, I, i8)")
def evaluate_impact_rates(S: Scalars, w: Floats, k: Integers, y: int) -> None:
    """Write z = z_0 + G P: gap rates and slip velocities at the impact state ``y``."""
    for a in range(S.n_active):
        z = S.impact_z0 + 3 * a
        z0, z1, z2 = w[z], w[z + 1], w[z + 2]
        row = S.block_start + S.first_grouped + a
        for block in range(k[row], k[row + 1]):
            p = y + STRIDE * k[S.block_column + block] + IMPULSE
            p0, p1, p2 = w[p], w[p + 1], w[p + 2]
            g = S.delassus + 9 * block
            z0 += w[g] * p0 + w[g + 1] * p1 + w[g + 2] * p2
            z1 += w[g + 3] * p0 + w[g + 4] * p1 + w[g + 5] * p2
            z2 += w[g + 6] * p0 + w[g + 7] * p1 + w[g + 8] * p2
        z = S.impact_z + 3 * a
        w[z], w[z + 1], w[z + 2] = z0, z1, z2


@room("void(S, F, I, i8)")
def evaluate_impact_forces(S: Scalars, w: Floats, k: Integers, y: int) -> None:
    """Write the forces ``f`` of the active contacts at the impact state ``y`` in the present phases."""
    evaluate_impact_rates(S, w, k, y)
    held = 0
    for a in range(S.n_active):
        phase = k[S.phase + a]
        if phase == COMPRESSION or phase == EXPANSION:
            w[S.f + 3 * a] = normal_force(S, w, k, a, w[y + STRIDE * a + DEFORMATION])
        else:
            w[S.f + 3 * a] = 0.0
        k[S.normal_held + a] = 1 if phase == HELD else 0
        held += k[S.normal_held + a] + k[S.tangent_held + a]
        if k[S.tangent_held + a] == 0:
            follow_slip(S, w, k, a, S.impact_z + 3 * a + 1, w[S.rest_slip + a])
            friction_of_slip(S, w, a)
    if held > 0:
        for i in range(3 * S.n_active):
            w[S.b + i] = 0.0
        resolve(S, w, k)


@kernel("void(S, F, I, i8, i8)")
def impact_slope(S: Scalars, w: Floats, k: Integers, y: int, out: int) -> None:
    """Write d(P, x, W, D, E)/ds of all active contacts at the impact state ``y``."""
    evaluate_impact_forces(S, w, k, y)
    write_impact_slope(S, w, k, out)


@kernel("void(S, F, I, i8)")
def write_impact_slope(S: Scalars, w: Floats, k: Integers, out: int) -> None:
    """Write the slope where rates and forces are evaluated."""
    for a in range(S.n_active):
        f, z, o = S.f + 3 * a, S.impact_z + 3 * a, out + STRIDE * a
        rate = w[z]
        for r in range(3):
            w[o + IMPULSE + r] = w[f + r]
        phase = k[S.phase + a]
        w[o + DEFORMATION] = 0.0
        if phase == COMPRESSION:
            w[o + DEFORMATION] = -rate
        elif phase == EXPANSION:
            w[o + DEFORMATION] = -rate / efficiency(S, w, k, a, max(rate, 1e-300))
        w[o + ENERGY] = w[f] * w[o + DEFORMATION]
        if a == S.lone:
            w[o + DEFORMATION] = 0.0
        w[o + WORK] = w[f] * rate
        w[o + RUBBED] = -(w[f + 1] * w[z + 1] + w[f + 2] * w[z + 2])
        w[o + LOST] = 0.0
