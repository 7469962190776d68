"""A soft contact through which a vertex comes out behind a thin wedge: the gap jumps, which the run must tell."""

from __future__ import annotations

import pytest

import nonsmooth as ns
from bodies import HullBody
from laws import Frictionless, LinearCompliant

WEDGE = (
    (0.0, -0.02, 0.0),
    (0.0, 0.02, 0.0),
    (-0.02, -0.02, 0.004),
    (-0.02, 0.02, 0.004),
    (-0.02, -0.02, -0.004),
    (-0.02, 0.02, -0.004),
)
TIP = ((0.0, 0.0, 0.0), (0.006, 0.0, -0.01), (-0.003, 0.005, -0.01), (-0.003, -0.005, -0.01))


def _end(stiffness: float) -> ns.Solution:
    """Shoot the tip of a tetrahedron at a wedge, 0.5 mm from its edge, where it is 0.2 mm thick."""
    wedge, tip = HullBody(WEDGE, density=7800.0), HullBody(TIP, density=2700.0)
    system = ns.System([wedge, tip], gravity=0.0)
    system.contact(wedge, tip, normal=LinearCompliant(stiffness=stiffness, damping=0.0), friction=Frictionless())
    system.place(wedge, position=(-0.04 / 3.0, 0.0, 0.0))
    system.place(tip, position=(-0.0005, 0.0, -0.0085), velocity=(0.0, 0.0, 1.0))
    return ns.simulate(system, 0.01)


def test_a_vertex_that_comes_through_ends_the_run() -> None:
    """A spring too soft to hold the tip lets it out behind the wedge, where the least way out is another one."""
    with pytest.raises(ns.RunFailed, match=r"The contact .* the gap is .* of which tolerances explain"):
        _end(1e4)


def test_one_that_is_held_does_not() -> None:
    """A stiff spring throws the tip back before it is through."""
    assert _end(1e5).status == "done"
