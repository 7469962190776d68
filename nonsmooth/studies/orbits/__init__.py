"""Periodic orbits and their continuation, bifurcation and itinerary diagrams, Lyapunov exponents."""

from nonsmooth.lazy_names import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
