"""NormalLaw: what the normal direction of a closed contact obeys."""

from __future__ import annotations

from abc import ABC, abstractmethod

from nonsmooth.parameters import Component


class NormalLaw(Component, ABC):
    """A law between gap and normal force in sustained contact.

    The engine of this version solves unilateral contact, Eqs. (14)-(16); the certificate below is
    what a law of this kind must confirm of every solution.
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
