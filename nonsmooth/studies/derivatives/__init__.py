"""Derivatives of motions by parameters and starts, and parameters fitted to measurements."""

from nonsmooth.lazy_names import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
