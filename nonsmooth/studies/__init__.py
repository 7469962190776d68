"""Studies: many runs over parameters, attractors, periodic orbits, derivatives, and fits."""

from nonsmooth.lazy_names import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
