"""NormalLaw: what the normal direction of a contact obeys, rigid or compliant."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from nonsmooth.parameters import Component


class NormalLaw(Component, ABC):
    """A law between gap and normal force.  Authors subclass :class:`RigidNormalLaw` or :class:`CompliantNormalLaw`."""


class RigidNormalLaw(NormalLaw, ABC):
    """A law of bodies that do not deform: the force is whatever keeps them apart.

    The engine of this version solves unilateral contact, Eqs. (14)-(16), and needs an impact law beside it; the
    certificate below is what a law of this kind must confirm of every solution.
    """

    @abstractmethod
    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        """Tell whether a closed contact (g = g' = 0) obeys the law.

        Parameters
        ----------
        acceleration : float
            Normal relative acceleration g'' [m/s^2].
        force : float
            Normal force [N].
        tolerance : float
            Deviation that counts as zero, in both.
        """


class CompliantNormalLaw(NormalLaw, ABC):
    """A law that gives the normal force of a closed contact; it takes the place of an impact law as well.

    The contract:

    1. ``force(indentation, rate, closing_rate, ...)`` is a plain function of the indentation x = -g [m], its rate
       x' = -g' [m/s] and the rate at which the contact closed [m/s] (0 if it was closed from the start); its further
       arguments are parameters of the law.  A positive force [N] presses, a negative one pulls.
    2. A contact closes when its gap falls to zero, and opens when its gap grows to ``reach`` [m]: zero, but for laws
       that pull.  A step may end past that: the force must be finite there, best what it is at the end.
    3. Round a cycle of compression and expansion the force takes energy out, or none.
    """

    @property
    @abstractmethod
    def force(self) -> Callable[..., float]:
        """The function of point 1."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """The gap of point 2 [m]."""

    @abstractmethod
    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """Tell whether indentation [m], its rates [m/s] and the normal force [N] of a closed contact obey the law."""
