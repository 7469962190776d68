"""The solvers of the contact problem: their names, their numbers in the engine, and the rule that chooses.

"auto" chooses by the number n of contacts that act on one another, and takes the first verified solution:

=========  ==================================================================
n          solvers, in this order
=========  ==================================================================
1 to 5     newton, gauss_seidel, lemke, enumeration
6 to 16    newton, gauss_seidel, lemke
above 16   newton, gauss_seidel
=========  ==================================================================

Newton comes first because it was the fastest or level with the fastest at every size from four contacts on, with no
problem unsolved (``python -m tests.benchmarks.solvers``); the others follow because they fail elsewhere.  Enumeration
comes last, and for few contacts only: its time grows like 3^n.  Any other name selects that solver alone.
"""

from __future__ import annotations

from enum import IntEnum

from nonsmooth.errors import UnknownName


class Solver(IntEnum):
    """A solver of the contact problem, or the rule that chooses among them."""

    AUTO = 0
    ENUMERATION = 1
    LEMKE = 2
    GAUSS_SEIDEL = 3
    NEWTON = 4


SOLVERS = tuple(one.name.lower() for one in Solver)
"""Names of the solvers."""
MOST_ENUMERATED = 8
"""Most contacts of enumeration: 3^8 = 6561 combinations of modes."""
ENUMERATED_AT_LAST = 5
"""Most contacts for which "auto" may try enumeration: 3^5 = 243 combinations of modes."""
MOST_PIVOTED = 16
"""Most contacts for which "auto" may try Lemke; its tableau is allocated for no more."""


def solver_of(name: str) -> Solver:
    """Solver of a name.

    Raises
    ------
    UnknownName
        If there is no such solver.
    """
    if name not in SOLVERS:
        raise UnknownName("solver", name, SOLVERS)
    return Solver[name.upper()]


def pivoted_contacts(solver: Solver, n_contacts: int) -> int:
    """Number of contacts for which Lemke's tableau is allocated, of a system with ``n_contacts`` at most."""
    # "auto" tries Lemke for few contacts only, and the other solvers never do
    return n_contacts if solver == Solver.LEMKE else min(n_contacts, MOST_PIVOTED) if solver == Solver.AUTO else 0
