"""The woodpecker toy: a bird, joined by a spring to a sleeve, steps down a pole by pecking it.

The module ``scenario`` has the scenario, ``toy`` the equations of motion.
"""

from .scenario import Woodpecker

__all__ = ["Woodpecker"]
