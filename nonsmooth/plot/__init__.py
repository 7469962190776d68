"""Pictures of any run: functions from a solution to matplotlib axes, which can be composed (``nonsmooth[full]``).

Each function takes axes to draw on, or makes new axes, and returns the axes.  Contacts, bodies and coordinates are
given by their names.  Charts of other numbers than those of a solution are in :mod:`nonsmooth.charts`.
"""

from nonsmooth.plot.contacts import forces, gaps, impulses, velocities
from nonsmooth.plot.energies import energies
from nonsmooth.plot.modes import modes
from nonsmooth.plot.path import path
from nonsmooth.plot.portrait import phase_portrait

__all__ = ["energies", "forces", "gaps", "impulses", "modes", "path", "phase_portrait", "velocities"]
