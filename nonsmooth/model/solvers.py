"""The solvers of the contact problem: their names, their numbers in the engine, and the rule that chooses."""

from __future__ import annotations

from nonsmooth.errors import UnknownName

AUTO, ENUMERATION, LEMKE, GAUSS_SEIDEL, NEWTON = range(5)
SOLVERS = ("auto", "enumeration", "lemke", "gauss_seidel", "newton")
"""Names by number."""
MOST_ENUMERATED = 8
"""Contacts that enumeration takes: 3^8 = 6561 combinations of modes."""
MOST_PIVOTED = 16
"""Contacts up to which "auto" may fall back on Lemke, whose tableau has room for no more then."""


def solver_number(name: str) -> int:
    """Return the number of a solver.

    Raises
    ------
    UnknownName
        If there is no such solver.
    """
    if name not in SOLVERS:
        raise UnknownName("solver", name, SOLVERS)
    return SOLVERS.index(name)


def pivoted_contacts(solver: int, n_contacts: int) -> int:
    """Return for how many contacts Lemke's tableau is laid out."""
    return n_contacts if solver == LEMKE else min(n_contacts, MOST_PIVOTED) if solver == AUTO else 0
