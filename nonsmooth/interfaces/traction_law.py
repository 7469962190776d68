"""TractionLaw: tangential force and moment of a compliant contact as a function of its motion."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from nonsmooth.interfaces.tangential_law import TangentialLaw


class TractionLaw(TangentialLaw, ABC):
    """Friction without a stick mode, by force and moment: bristles, lubricants, rolling and drilling resistance.

    It asks for a compliant normal law: the normal force must be known before the friction, and there is no impact in
    which a smooth function of slip could be anything but frictionless.

    The contract:

    1. ``traction(normal_force, motion, state, out, ...)`` is a plain function of the normal force [N] and of
       ``motion``, five numbers: slip velocity v1, v2 [m/s], and the angular velocity of the second body relative to the
       first about both tangents, w1, w2 (rolling), and about the normal, w3 (drilling) [rad/s].
    2. It writes to ``out``: the force T1, T2 [N] and the moment M1, M2, M3 [N m] on the second body, then the
       time derivative of every inner state.  Every entry must be written, and be continuous in all arguments.
    3. The states start from ``initial_state`` whenever the contact closes, () if there are none, and stand still while
       it is open.
    """

    @property
    @abstractmethod
    def traction(self) -> Callable[..., None]:
        """The function of point 1."""

    @property
    @abstractmethod
    def initial_state(self) -> tuple[float, ...]:
        """The values of point 3."""

    @property
    @abstractmethod
    def state_scale(self) -> tuple[float, ...]:
        """A usual size of every state, positive, to which the tolerance of the integration is relative."""

    @abstractmethod
    def is_fulfilled(
        self,
        motion: tuple[float, float, float, float, float],
        state: tuple[float, ...],
        normal_force: float,
        traction: tuple[float, float, float, float, float],
        tolerance: float,
    ) -> bool:
        """Tell whether motion, states, normal force and the five numbers of force and moment obey the law."""
