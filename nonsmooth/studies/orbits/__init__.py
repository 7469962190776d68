"""Periodic orbits and their continuation, bifurcation and itinerary diagrams, Lyapunov exponents."""

from nonsmooth.studies.orbits.continuation import Branch, Special, continuation
from nonsmooth.studies.orbits.diagram import Diagram, bifurcation
from nonsmooth.studies.orbits.exponents import Lyapunov, lyapunov
from nonsmooth.studies.orbits.grazing import GrazingDistance
from nonsmooth.studies.orbits.hysteresis import Hysteresis, hysteresis
from nonsmooth.studies.orbits.itinerary import ItineraryDiagram, itinerary_diagram, itinerary_of_run
from nonsmooth.studies.orbits.linear import NonDifferentiablePoint
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit, orbit
from nonsmooth.studies.orbits.sections import PoincareSection, StroboscopicSection
from nonsmooth.studies.orbits.symmetries import Spin, Turn

__all__ = [
    "Branch",
    "Diagram",
    "GrazingDistance",
    "Hysteresis",
    "ItineraryDiagram",
    "Lyapunov",
    "NoOrbit",
    "NonDifferentiablePoint",
    "Orbit",
    "PoincareSection",
    "Special",
    "Spin",
    "StroboscopicSection",
    "Turn",
    "bifurcation",
    "continuation",
    "hysteresis",
    "itinerary_diagram",
    "itinerary_of_run",
    "lyapunov",
    "orbit",
]
