"""Pictures of any run: functions from a solution to matplotlib axes, to be composed; it comes with ``nonsmooth[full]``.

Each takes axes to draw on, or makes some of its own, and returns them.  Contacts, bodies and coordinates are asked for
by their names.
"""

from nonsmooth.plot.energy import energies
from nonsmooth.plot.force import forces
from nonsmooth.plot.gap import gaps
from nonsmooth.plot.impulse import impulses
from nonsmooth.plot.mode import modes
from nonsmooth.plot.portrait import phase_portrait
from nonsmooth.plot.route import path
from nonsmooth.plot.velocity import velocities

__all__ = ["energies", "forces", "gaps", "impulses", "modes", "path", "phase_portrait", "velocities"]
