"""Solver of one impact, given by matrices, without a run."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import check_kind, floats, is_finite
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import ImpactOutcome
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.interfaces import FrictionLaw, ImpactProcess
from nonsmooth.problems.matrices import (
    check_friction,
    check_mass,
    columns_of,
    law_without_value,
    memory_of,
    read_arrays,
    write_delassus,
)
from nonsmooth.watch import Watch

Floats = NDArray[np.float64]


_PROCESSES = "Laws that are maps, as NewtonImpact, need a run: build a System and call simulate. EnergeticImpact works."


@dataclass(frozen=True)
class ImpactResult:
    """Velocity, impulses and energies after an impact.

    Attributes
    ----------
    velocity : array
        Generalised velocities u after the impact, shape [n_u].
    normal_impulse : array
        Normal impulse of every contact [N s], shape [n].
    tangential_impulse : array
        Friction impulse of every contact [N s], shape [n, 2].
    stored, returned : array
        Energy stored in compression and returned in expansion [J], shape [n].  A contact may end wedged: at rest under
        load, because joints or other contacts hold its point.  The energy that it then keeps is not returned.
    friction_loss : array
        Energy lost to friction [J], shape [n].
    phases : int
        Number of phases: starts of compression, turns to expansion, ends, changes between stick and slip.
    steps : int
        Integration steps.
    truncated : bool
        Whether a cascade of ever smaller compressions was cut short, below the tolerance.
    """

    velocity: Floats
    normal_impulse: Floats
    tangential_impulse: Floats
    stored: Floats
    returned: Floats
    friction_loss: Floats
    phases: int
    steps: int
    truncated: bool

    @property
    def restitution_loss(self) -> Floats:
        """Energy lost to restitution [J], shape [n]."""
        return self.stored - self.returned


def solve_impact(
    mass: ArrayLike,
    normal: ArrayLike,
    tangential: ArrayLike,
    velocity: ArrayLike,
    impact: Sequence[ImpactProcess],
    friction: Sequence[FrictionLaw],
    *,
    prescribed: ArrayLike | None = None,
    tolerance: float = 1e-10,
) -> ImpactResult:
    """Solve one multiple impact with friction, Eqs. (19)-(28).

    The matrices may be those of jointed bodies, in coordinates that satisfy the joints.  The 3 x 3 block of a contact
    in [W N]^T M^-1 [W N] may then be singular.

    Parameters
    ----------
    mass : array
        Mass matrix M, symmetric positive definite, shape [n_u, n_u].
    normal : array
        W, column i the generalised normal direction of contact i, shape [n_u, n].
    tangential : array
        N, two columns per contact, shape [n_u, n, 2].
    velocity : array
        u before the impact, shape [n_u].
    impact : sequence of ImpactProcess
        Impact law of every contact, length n.
    friction : sequence of FrictionLaw
        Friction law of every contact, length n.
    prescribed : array, optional
        Part of gap rate and slip velocity that is due to driven bodies, which ``velocity`` does not include [m/s],
        shape [n, 3].
    tolerance : float
        Relative error of a step.

    Raises
    ------
    InvalidInput
        If a shape is wrong, a number not finite, or M not symmetric positive definite.
    RunFailed
        If a law returns numbers that do not end the impact.
    """
    for name, laws in (("impact", impact), ("friction", friction)):
        check_kind(f"solve_impact: {name}", laws, Collection, f"Give one {name} law per contact.")
    for law in impact:
        check_kind("solve_impact: impact", law, ImpactProcess, _PROCESSES)
    if not (is_finite(tolerance) and tolerance > 0.0):
        raise InvalidInput("solve_impact: tolerance", "must be positive and finite", tolerance, "For example 1e-10.")
    n_u, n = floats("solve_impact: velocity", velocity).size, len(impact)
    m, w, t, z_driven, u = read_arrays(
        "solve_impact",
        "Give one impact law per contact.",
        mass=(mass, (n_u, n_u)),
        normal=(normal, (n_u, n)),
        tangential=(tangential, (n_u, n, 2)),
        prescribed=(prescribed, (n, 3)),
        velocity=(velocity, (n_u,)),
    )
    if len(friction) != n or n == 0:
        rule = f"must have one law for each of {n} contacts"
        raise InvalidInput("solve_impact: friction", rule, len(friction), "Give one per contact.")
    check_friction("solve_impact: friction", friction)
    check_mass("solve_impact", m)
    columns = columns_of(w, t)
    response = np.linalg.solve(m, columns)
    delassus = columns.T @ response
    rates = columns.T @ u + z_driven.ravel()
    functions: dict[str, list[tuple[Any, Any]]] = {
        "impact_force": [(law, law.force) for law in impact],
        "efficiency": [(law, law.efficiency) for law in impact],
        "friction": [(law, law.coefficient) for law in friction],
    }
    memory = memory_of(n, functions)
    memory[owners.Tolerance.impact] = tolerance
    write_delassus(memory, delassus)
    memory[owners.Impact.rates_before][: 3 * n] = rates
    outcome = int(ImpactOutcome.FINISHED)
    if np.any(rates[::3] < 0.0):
        with Watch(memory) as watch:
            outcome = int(watch.call("energetic_impact", 0.0))
    if outcome != ImpactOutcome.FINISHED:
        reason = law_without_value(memory, [*zip(friction, impact, strict=True)])
        raise RunFailed(f"The impact did not end. {reason or 'A force or efficiency is not positive.'}")
    impulse = memory[owners.Impact.impulse][: 3 * n].reshape(n, 3).copy()
    return ImpactResult(
        velocity=u + response @ impulse.ravel(),
        normal_impulse=impulse[:, 0],
        tangential_impulse=impulse[:, 1:],
        stored=memory[owners.ActiveContact.energy_stored][:n].copy(),
        returned=memory[owners.ActiveContact.energy_returned][:n].copy(),
        friction_loss=memory[owners.ActiveContact.energy_dissipated][:n].copy(),
        phases=int(memory[owners.Event.n_phases]),
        steps=int(memory[owners.Totals.n_impact_steps]),
        truncated=bool(memory[owners.Event.truncation]),
    )
