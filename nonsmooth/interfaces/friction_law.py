"""FrictionLaw: the friction coefficient as a function of the slip speed, and what it may depend on besides."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Literal

from nonsmooth.interfaces.tangential_law import TangentialLaw


class FrictionLaw(TangentialLaw, ABC):
    """Friction that opposes slip, bounded by a disc while sticking.

    The contract:

    1. ``coefficient`` is a plain function ``coefficient(speed, ...) >= 0`` of the slip speed [m/s]; its
       further arguments are parameters of the law.
    2. The value at speed 0 is the static limit; the limit from above is the coefficient of incipient slip.
    """

    @property
    @abstractmethod
    def coefficient(self) -> Callable[..., float]:
        """The function of point 1."""

    @abstractmethod
    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """Tell whether slip velocity [m/s], normal and tangential force [N] obey the law."""


class AnisotropicFrictionLaw(FrictionLaw, ABC):
    """Friction whose bound is not a disc: two half ellipses, fixed to one of the bodies.

    With the slip velocity (v1, v2), v1 forward along an axis of the body and v2 across it, and ratios r, the slip that
    counts is s = (r_1 v1, r_2 v2); the force is T = -mu(|s|) N (r_1 s1, r_2 s2) / |s|, so that forces lie in an ellipse
    with the semi-axes mu r N, and slip is normal to it, where friction takes most energy out.  r_1 may be
    another backward than forward.

    The contract: that of :class:`FrictionLaw` for mu(|s|), and

    3. ``body`` says which body of the contact the axis is fixed to, and ``axis`` its direction in that body's frame;
       what counts is its projection on the tangent plane.  Where it stands along the normal, to 1e-7 rad, it has none:
       the axis x, y or z of the body's frame that is least along it takes its place, the first of equals.
    4. ``ratios`` are r forward, backward and across, positive, the largest of them 1.
    5. The certificate takes slip and force along the axis and across it.
    """

    @property
    @abstractmethod
    def body(self) -> Literal["first", "second"]:
        """The body of point 3."""

    @property
    @abstractmethod
    def axis(self) -> tuple[float, float, float]:
        """The direction of point 3."""

    @property
    @abstractmethod
    def ratios(self) -> tuple[float, float, float]:
        """The ratios of point 4."""


class StatefulFrictionLaw(FrictionLaw, ABC):
    """Friction that depends on its history through inner states that are integrated with the motion.

    The contract: that of :class:`FrictionLaw`, and

    3. ``coefficient`` and ``rates`` take the vector ``state`` among the arguments that follow the speed.
    4. ``rates(speed, state, out, ...)`` writes the time derivative of every state to ``out``.
    5. The states start from ``initial_state`` whenever the contact closes, and stand still while it is open.
    6. The certificate takes the states; without them it judges a contact that has just closed.
    """

    @property
    @abstractmethod
    def rates(self) -> Callable[..., None]:
        """The function of point 4."""

    @property
    @abstractmethod
    def initial_state(self) -> tuple[float, ...]:
        """The values of point 5."""

    @property
    @abstractmethod
    def state_scale(self) -> tuple[float, ...]:
        """A usual size of every state, positive, to which the tolerance of the integration is relative."""

    @abstractmethod
    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
        state: tuple[float, ...] | None = None,
    ) -> bool:
        """Tell whether slip velocity [m/s], normal and tangential force [N] obey the law in a state."""
