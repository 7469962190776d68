"""One impact by itself, on matrices."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.binding.compile import bind
from nonsmooth.binding.law_failure import first_without_value, without_value
from nonsmooth.binding.law_functions import law_functions
from nonsmooth.checks import check_kind, floats, is_finite
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Heap, Memory, allocate
from nonsmooth.engine.memory.modes import ImpactOutcome
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.interfaces import FrictionLaw, ImpactProcess
from nonsmooth.problems.contact import check_friction
from nonsmooth.problems.delassus import write_delassus
from nonsmooth.watch import Watch

Floats = NDArray[np.float64]


_PROCESSES = "Laws that are maps, as NewtonImpact, need a run: build a System and call simulate. EnergeticImpact works."


@dataclass(frozen=True)
class ImpactResult:
    """What an impact did.

    Attributes
    ----------
    velocity : array
        u after the impact, shape [n_u].
    normal_impulse : array
        [N s], shape [n].
    tangential_impulse : array
        [N s], shape [n, 2].
    stored, returned : array
        Energy stored in compression and returned in expansion [J], shape [n].  What a contact keeps that ends wedged,
        at rest under load because joints or other contacts hold its point, is not returned.
    friction_loss : array
        Energy lost to friction [J], shape [n].
    phases : int
        Number of phases: compressions begun, turns, ends, changes between stick and slip.
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

    The matrices may be those of jointed bodies in coordinates that keep the joints; a contact's own three rows of
    [W N]^T M^-1 [W N] may be singular then.

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
        Gap rate and slip velocity that the driven sides add [m/s], shape [n, 3].
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
    m, w = floats("solve_impact: mass", mass), floats("solve_impact: normal", normal)
    t, u = floats("solve_impact: tangential", tangential), floats("solve_impact: velocity", velocity)
    n_u, n = u.size, len(impact)
    z_driven = np.zeros((n, 3)) if prescribed is None else floats("solve_impact: prescribed", prescribed)
    for name, array, shape in (
        ("mass", m, (n_u, n_u)),
        ("normal", w, (n_u, n)),
        ("tangential", t, (n_u, n, 2)),
        ("prescribed", z_driven, (n, 3)),
        ("velocity", u, (n_u,)),
    ):
        if array.shape != shape or not np.all(np.isfinite(array)):
            raise InvalidInput(
                f"solve_impact: {name}",
                f"must be finite with shape {shape}",
                array.shape,
                "Give one impact law per contact.",
            )
    if len(friction) != n or n == 0:
        raise InvalidInput(
            "solve_impact: friction",
            f"must have one law for each of {n} contacts",
            len(friction),
            "Give one per contact.",
        )
    check_friction("solve_impact: friction", friction)
    if not np.allclose(m, m.T, rtol=1e-12, atol=0.0) or np.linalg.eigvalsh(m)[0] <= 0.0:
        raise InvalidInput("solve_impact: mass", "must be symmetric positive definite", m.tolist(), "Check M.")
    columns = np.concatenate([w[:, :, None], t], axis=2).reshape(n_u, 3 * n)
    response = np.linalg.solve(m, columns)
    delassus = columns.T @ response
    rates = columns.T @ u + z_driven.ravel()
    memory = _memory(impact, friction, tolerance)
    write_delassus(memory, delassus)
    memory[owners.Impact.rates_before][: 3 * n] = rates
    outcome = int(ImpactOutcome.FINISHED)
    if np.any(rates[::3] < 0.0):
        with Watch(memory) as watch:
            outcome = int(watch.call("energetic_impact", 0.0))
    if outcome != ImpactOutcome.FINISHED:
        raise RunFailed(f"The impact did not end. {_culprit(memory, impact, friction)}")
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


def _culprit(memory: Memory, impact: Sequence[ImpactProcess], friction: Sequence[FrictionLaw]) -> str:
    findings = (
        without_value(memory.floats[int(memory[part.parameters][i]) :], part, (), f"contact {i}")
        for i, laws in enumerate(zip(friction, impact, strict=True))
        for part in law_functions(*laws)
    )
    return first_without_value(findings) or "A force or efficiency is not positive."


def _memory(impact: Sequence[ImpactProcess], friction: Sequence[FrictionLaw], tolerance: float) -> Memory:
    n = len(impact)
    blocks = []
    for i in range(n):
        for name, law, function in (
            ("impact_force", impact[i], impact[i].force),
            ("efficiency", impact[i], impact[i].efficiency),
            ("friction", friction[i], friction[i].coefficient),
        ):
            blocks.append((i, name, *bind(function, "scalar", law.parameters(), type(law).__name__)))
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n, "n_articulations": 0})
    memory[owners.Model.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active] = n
    memory[owners.Tolerance.impact] = tolerance
    memory[owners.Problem.active][:n] = np.arange(n)
    memory[owners.Contact.direction][:, 0] = 1.0
    heap = Heap(memory)
    for i, name, address, values in blocks:
        memory[getattr(owners.Contact, f"{name}_function")][i] = address
        memory[getattr(owners.Contact, f"{name}_parameters")][i] = heap.store(values)
    return heap.close()
