"""Solver of one problem of sustained contact, given by matrices, without a run."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.checks import check_kind, floats
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED, Solver, solver_of
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.problems.contact_result import ContactMode, ContactResult
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


def solve_contact(
    mass: ArrayLike,
    normal: ArrayLike,
    tangential: ArrayLike,
    force: ArrayLike,
    friction: Sequence[FrictionLaw],
    *,
    slip: ArrayLike | None = None,
    bias: ArrayLike | None = None,
    solver: str = "auto",
) -> ContactResult:
    """Solve for forces and modes of closed contacts, M u' = h + W lambda_N + N lambda_T with Eqs. (14)-(18).

    Every contact has zero gap and gap rate.  A contact with slip slides, with friction against the slip, or opens.  A
    contact without slip sticks within its static coefficient, starts to slide with its kinetic coefficient, or opens.
    Friction then acts against the slip acceleration.  Modes of the past are not used.

    Parameters
    ----------
    mass : array
        Mass matrix M, symmetric positive definite, shape [n_u, n_u].
    normal : array
        W, column i the generalised normal direction of contact i, shape [n_u, n].
    tangential : array
        N, two columns per contact, shape [n_u, n, 2]; zeros for a direction that does not exist, as in the plane.
    force : array
        h, the generalised force on the system without contacts, shape [n_u].
    friction : sequence of FrictionLaw
        Friction law of every contact, length n.
    slip : array, optional
        Slip velocity [m/s], shape [n, 2]; zero by default. A contact with a slip of exactly zero is at rest.
    bias : array, optional
        Accelerations of the contacts while u' = 0, S of Eq. (13) [m/s^2], shape [n, 3]; zero by default.
    solver : str
        "auto", "enumeration" (at most eight contacts), "lemke", "gauss_seidel" or "newton"; see
        :mod:`nonsmooth.engine.memory.solvers` for the rule of "auto".

    Raises
    ------
    InvalidInput
        If a shape is wrong, a number is not finite, M is not symmetric positive definite, a column of W is zero, or
        there are too many contacts to enumerate.
    UnknownName
        If no solver has the name ``solver``.
    RunFailed
        If the solver finds no forces that fulfil the laws. This may occur in Painlevé's paradox and, for mu_s > mu, if
        friction would have to be between its bounds mu lambda_N and mu_s lambda_N.
    """
    check_kind("solve_contact: solver", solver, str, 'For example "auto".')
    number = solver_of(solver)
    check_kind("solve_contact: friction", friction, Collection, "Give one friction law per contact.")
    n_u, n = floats("solve_contact: force", force).size, len(friction)
    h, m, w, t, v, s = read_arrays(
        "solve_contact",
        "Give one friction law per contact.",
        force=(force, (n_u,)),
        mass=(mass, (n_u, n_u)),
        normal=(normal, (n_u, n)),
        tangential=(tangential, (n_u, n, 2)),
        slip=(slip, (n, 2)),
        bias=(bias, (n, 3)),
    )
    if n == 0:
        raise InvalidInput(
            "solve_contact: friction", "must have a law for at least one contact", n, "Give one per contact."
        )
    check_friction("solve_contact: friction", friction)
    if number == Solver.ENUMERATION and n > MOST_ENUMERATED:
        raise InvalidInput(
            "solve_contact: solver",
            f"enumerates at most {MOST_ENUMERATED} contacts",
            n,
            "Take another solver; they find the same answer.",
        )
    check_mass("solve_contact", m)
    columns = columns_of(w, t)
    # with M = L L^T, the Delassus matrix is scaled^T scaled
    scaled = np.linalg.solve(np.linalg.cholesky(m), columns)
    if np.any(np.linalg.norm(scaled[:, ::3], axis=0) == 0.0):
        raise InvalidInput("solve_contact: normal", "must have no column of zeros", w.tolist(), "Leave it out.")
    free = np.linalg.solve(m, h)
    memory = _memory(friction, number)
    write_delassus(memory, scaled.T @ scaled)
    memory[owners.Problem.free_accelerations][: 3 * n] = s.ravel() + columns.T @ free
    memory[owners.Problem.acceleration_scale] = max(np.max(np.abs(s)), np.max(np.abs(columns.T @ free)))
    memory[owners.ContactRecord.rate][:n][:, 1:] = v
    with Watch(memory) as watch:
        solved = watch.call("solve_from_rates")
    if solved == 0:
        reason = law_without_value(memory, [(law,) for law in friction])
        raise RunFailed(f"The solver {solver!r} finds no contact forces that fulfil the laws. {reason}".strip())
    f = memory[owners.Problem.forces][: 3 * n].reshape(n, 3).copy()
    return ContactResult(
        normal_force=f[:, 0],
        tangential_force=f[:, 1:],
        acceleration=np.asarray(free + np.linalg.solve(m, columns @ f.ravel()), dtype=np.float64),
        contact_acceleration=memory[owners.ActiveContact.acceleration][:n].copy(),
        modes=tuple(tuple(ContactMode)[mode] for mode in memory[owners.ActiveContact.mode_tried][:n]),
        _memory=memory,
        _scaled=scaled,
    )


def _memory(friction: Sequence[FrictionLaw], solver: Solver) -> Memory:
    """Memory of a contact problem with a solver. No mode of a contact is known."""
    n = len(friction)
    memory = memory_of(n, {"friction": [(law, law.coefficient) for law in friction]}, n_pivoted=n)
    memory[owners.Options.solver], memory[owners.ActiveContact.mode_tried][:n] = solver, Mode.UNKNOWN
    return memory
