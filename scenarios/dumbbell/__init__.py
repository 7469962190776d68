"""The paper's scenario: a dumbbell on a vibrating plate.

To be read in this order:

1. ``scenario.py``: the paper's numbers, the system, the numbers by which a run is judged;
2. ``coordinates.py``: the paper's coordinates, and the motion in them;
3. ``attractor.py``: which of the paper's motions a run settled into;
4. ``figures.py``, with ``portraits.py`` and ``trace.py``: Figs. 2 to 11.
"""

from .scenario import DumbbellScenario

__all__ = ["DumbbellScenario"]
