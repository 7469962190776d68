"""The solvers of the contact problem: their names, their numbers in the engine, and the rule that chooses.

"auto" goes by the number n of contacts that act on one another, and takes the first verified answer:

=========  ==================================================================
n          solvers, in this order
=========  ==================================================================
1 to 5     newton, gauss_seidel, lemke, enumeration
6 to 16    newton, gauss_seidel, lemke
above 16   newton, gauss_seidel
=========  ==================================================================

Newton comes first because it was the fastest or level with the fastest at every size from four contacts on, with no
problem unsolved (``python -m tests.benchmarks.solvers``); the others follow because they fail elsewhere.  Enumeration
comes last, and for few contacts only: its time grows like 3^n.  A name takes that solver alone.
"""

from __future__ import annotations

from nonsmooth.errors import UnknownName

AUTO, ENUMERATION, LEMKE, GAUSS_SEIDEL, NEWTON = range(5)
SOLVERS = ("auto", "enumeration", "lemke", "gauss_seidel", "newton")
"""Names by number."""
MOST_ENUMERATED = 8
"""Contacts that enumeration takes: 3^8 = 6561 combinations of modes."""
ENUMERATED_AT_LAST = 5
"""Contacts up to which "auto" may fall back on enumeration."""
MOST_PIVOTED = 16
"""Contacts up to which "auto" may fall back on Lemke, whose tableau has room for no more then."""


def solver_number(name: str) -> int:
    """Number of a solver.

    Raises
    ------
    UnknownName
        If there is no such solver.
    """
    if name not in SOLVERS:
        raise UnknownName("solver", name, SOLVERS)
    return SOLVERS.index(name)


def pivoted_contacts(solver: int, n_contacts: int) -> int:
    """Number of contacts that Lemke's tableau has room for."""
    return n_contacts if solver == LEMKE else min(n_contacts, MOST_PIVOTED) if solver == AUTO else 0
