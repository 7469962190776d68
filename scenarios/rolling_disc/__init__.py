"""Euler's disk: a disc that rolls on its rim.

``scenario.py`` is the scenario, ``steady.py`` has closed forms to compare with, ``figures.py`` draws the figures.
``air_film.py`` is the load that lets the disc settle, ``tilt_guard.py`` the guard that ends its run.
"""

from .scenario import RollingDisc

__all__ = ["RollingDisc"]
