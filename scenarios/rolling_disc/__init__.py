"""Euler's disk: a disc that rolls on its rim.

``scenario.py`` is the scenario, ``steady.py`` has the closed forms by which it is judged, ``figures.py`` its figures.
``air_film.py`` is the load by which the disc settles, ``tilt_guard.py`` the guard that ends its run.
"""

from .scenario import RollingDisc

__all__ = ["RollingDisc"]
