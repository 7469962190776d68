"""Periodic orbits: found, followed along a parameter, and what happens to them there; Lyapunov exponents."""

from nonsmooth.studies.orbits.branch import Branch, Special
from nonsmooth.studies.orbits.diagram import Diagram, bifurcation
from nonsmooth.studies.orbits.exponents import Lyapunov, lyapunov
from nonsmooth.studies.orbits.following import continuation
from nonsmooth.studies.orbits.hysteresis import Hysteresis, hysteresis
from nonsmooth.studies.orbits.margins import Margins
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit, orbit
from nonsmooth.studies.orbits.sections import Crossing
from nonsmooth.studies.orbits.symmetries import Spin, Turn

__all__ = [
    "Branch",
    "Crossing",
    "Diagram",
    "Hysteresis",
    "Lyapunov",
    "Margins",
    "NoOrbit",
    "Orbit",
    "Special",
    "Spin",
    "Turn",
    "bifurcation",
    "continuation",
    "hysteresis",
    "lyapunov",
    "orbit",
]
