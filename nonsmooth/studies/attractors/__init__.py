"""Attractors of a study, their basins, and how both change along a parameter."""

from nonsmooth.lazy_names import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
