"""ImpactLaw: what happens to the colliding set, as a process in pseudo-time or as a map of velocities."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar

from nonsmooth.parameters import Component
from nonsmooth.types import Array


class ImpactLaw(Component, ABC):
    """A law for impacts.  Law authors subclass :class:`ImpactProcess` or :class:`ImpactMap`.

    All contacts of one system follow one kind of law, because an impact owns the whole colliding set.
    """

    @property
    @abstractmethod
    def contact_time(self) -> float:
        """Duration of a contact T_c [s], below which bounces count as closed, Eq. (33)."""


class ImpactProcess(ImpactLaw, ABC):
    """An impact law integrated by the engine, Eqs. (19)-(28).

    The contract: plain functions whose further arguments are parameters of the law,

    1. ``force(indentation, ...)``: normal force, zero at zero, increasing, Eq. (20);
    2. ``efficiency(rate, ...)``: share of the stored energy that the gap rate [m/s] gives back, Eq. (28);
       1 for rates below zero, between 0 and 1 above.  At rate 0 it is the share that the contact gives back before it
       opens: 1 where it opens without a force, less where it opens under load and what is left is lost.
    """

    @property
    @abstractmethod
    def force(self) -> Callable[..., float]:
        """The function of point 1."""

    @property
    @abstractmethod
    def efficiency(self) -> Callable[..., float]:
        """The function of point 2."""

    @abstractmethod
    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether the energies [J] stored and returned at a contact obey the law."""


class ImpactMap(ImpactLaw, ABC):
    """An impact law that maps the rates before the impact to its impulses.

    The contract: ``impulses(n, delassus, rates, out, friction, ...)`` is a plain function of the number of
    contacts, the Delassus matrix [1/kg] (row by row, shape [3 n, 3 n], rows n, t1, t2 of each contact), the
    rates before [m/s, 3 n] and the impulses to be written [N s, 3 n]; ``friction`` and its further
    arguments, parameters of the law, are vectors over the contacts.

    A law of one contact sets ``one_contact`` and raises in its function where it is given more; the conformance kit
    then asks it for no more.
    """

    one_contact: ClassVar[bool] = False

    @property
    @abstractmethod
    def impulses(self) -> Callable[..., None]:
        """The function of the contract."""

    @abstractmethod
    def is_fulfilled(self, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float) -> bool:
        """Tell whether the impulses of contacts that all have this law obey it.

        Parameters
        ----------
        delassus : array
            Delassus matrix [1/kg], shape [3 n, 3 n].
        before : array
            Rates (n, t1, t2) of each contact before the impact [m/s], shape [3 n].
        impulses : array
            What is judged [N s], shape [3 n].
        friction : array
            Friction coefficients, shape [n].
        tolerance : float
            Deviation that counts as zero [m/s].
        """
