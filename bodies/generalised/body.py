"""GeneralisedBody: a mechanism in coordinates of the user's own."""

from __future__ import annotations

import dataclasses
import functools
import keyword
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import NamesAndUnits, Vector
from nonsmooth.parameters import Value, parameter

from ..values import Word, read_start
from .checks import GRAVITY, Sampler, check_equations, check_signatures
from .coordinate import Coordinate
from .equations import Equations, UserFunction, evaluator, own_names
from .example import cart_pendulum
from .frames import Function, MovingFrame

_TAKEN = ("t", "q", "u", "out", "gravity_x", "gravity_y", "gravity_z")


@final
@dataclass(frozen=True)
class GeneralisedBody(Body):
    """A mechanism M(q) u' = h(t, q, u) + contact forces, q' = u, given by plain functions.

    The functions are compiled: they use ``out[i]``, numbers and :mod:`math` only.  What they take behind the arguments
    below are constants of the body, by name, and gravity_x, gravity_y, gravity_z [m/s^2].  Entries that stay zero need
    not be written.  They must be smooth within a hundredth of the coordinates' scales around the start, where they are
    checked against each other by finite differences.

    Attributes
    ----------
    coordinates : tuple of Coordinate
        The n coordinates.
    mass : callable
        ``mass(q, out, ...)`` writes the mass matrix, row by row [n n].
    force : callable
        ``force(t, q, u, out, ...)`` writes h [n]: all forces but those of contacts and loads, and the terms quadratic
        in u.
    potential : callable
        ``potential(q, ...)`` returns the potential energy of these forces [J].
    moving_frames : tuple of MovingFrame
        Points and parts that carry shapes.
    constants : mapping of str to float or tuple of float
        The constants; a function takes a tuple as a block to be indexed.
    power : callable, optional
        ``power(t, q, u, ...)`` returns the power of those forces in h that have no potential, dampers and motors [W];
        without it h must be that of Lagrange's equations.  With it the body has one more coordinate, the last: the work
        of these forces [J].  In the energy account it comes off the potential energy.
    drawn : callable, optional
        ``drawn(q, ...)`` returns the ends of lines [m], shape [m, 2, 3], that stand for the mechanism in pictures.  It
        is not compiled.
    forcing_period : float, optional
        Shortest time over which h changes by itself [s].

    Raises
    ------
    InvalidInput
        If a function takes other arguments, writes beyond its size or a number that is not finite; if M is not
        symmetric and positive definite, a Jacobian not the derivative of its pose, a bias not that of Jacobian times u,
        or if forces and energies contradict each other.
    UnknownName
        If a function asks for a constant that is not given.
    """

    coordinates: tuple[Coordinate, ...]
    mass: Function
    force: Function
    potential: Callable[..., float]
    moving_frames: tuple[MovingFrame, ...] = ()
    constants: Mapping[str, Value] = field(default_factory=dict)
    power: Callable[..., float] | None = None
    drawn: Callable[..., ArrayLike] | None = None
    forcing_period: float | None = parameter(
        None, doc="shortest time over which the forces change by themselves", unit="s", above=0.0
    )

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a cart with a pendulum."""
        return cart_pendulum()

    def _check(self) -> None:
        object.__setattr__(self, "coordinates", _members("coordinates", self.coordinates, Coordinate))
        object.__setattr__(self, "moving_frames", _members("moving_frames", self.moving_frames, MovingFrame))
        object.__setattr__(self, "constants", MappingProxyType(_constants(self.constants)))
        names = [coordinate.name for coordinate in self.coordinates]
        if not names or len(set(names)) != len(names):
            raise InvalidInput(
                "GeneralisedBody.coordinates",
                "must be at least one, each of another name",
                names,
                "Give Coordinate objects.",
            )
        check_signatures("GeneralisedBody", self._equations.parts(), {**self.constants, **GRAVITY})
        if self.drawn is not None:
            check_signatures(
                "GeneralisedBody", [UserFunction("drawn", "drawn", "drawn", self.drawn, 0)], self.constants
            )

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields; a read-only view of constants cannot be pickled."""
        fields = {one.name: getattr(self, one.name) for one in dataclasses.fields(self)}
        return fields | {"constants": dict(self.constants)}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        vars(self).update(state, constants=MappingProxyType(state["constants"]))

    @functools.cached_property
    def _equations(self) -> Equations:
        bare = tuple(dataclasses.replace(frame, carried=()) for frame in self.moving_frames)
        return Equations(len(self.coordinates), self.mass, self.force, self.potential, self.power, bare)

    @functools.cached_property
    def _sample(self) -> Sampler:
        return Sampler("GeneralisedBody", self._equations, self.constants)

    def parameters(self) -> Mapping[str, Value]:
        """Return the constants."""
        return self.constants

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """The shapes of every moving frame."""
        return tuple(frame.carried for frame in self.moving_frames)

    def strokes(self, q: Vector) -> Vector:
        """Return what ``drawn`` returns."""
        if self.drawn is None:
            return super().strokes(q)
        own = {name: self.constants[name] for name in own_names(self.drawn, "drawn")}
        return np.asarray(self.drawn(q, **own), dtype=float).reshape(-1, 2, 3)

    @property
    def q_labels(self) -> NamesAndUnits:
        """The coordinates and, with a power, its work."""
        known = tuple((one.name, one.unit) for one in self.coordinates)
        return known if self.power is None else (*known, ("work", "J"))

    @property
    def u_labels(self) -> NamesAndUnits:
        """One velocity per coordinate."""
        return tuple((f"{one.name} rate", f"{one.unit}/s") for one in self.coordinates)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The functions, put together."""
        return evaluator(self._equations)

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """Scales of the coordinates q and of the velocities u, in the units of these.

        If the body has a ``power``, the last coordinate is the work of this power.  The scale of the work is the
        kinetic energy at the velocity scales [J].
        """
        q = np.array([coordinate.scale for coordinate in self.coordinates])
        u = np.array([coordinate.rate_scale for coordinate in self.coordinates])
        if self.power is None:
            return q, u
        mass = self._sample(np.array([coordinate.start for coordinate in self.coordinates]), u)["mass"]
        return np.append(q, 0.5 * u @ mass.reshape(len(u), len(u)) @ u), u

    @property
    def time_scale(self) -> float:
        """The forcing period [s]; infinite without one."""
        return math.inf if self.forcing_period is None else self.forcing_period

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u of a start, shape [n] each, from q and u; by default the starts of the coordinates.

        Raises
        ------
        InvalidInput
            If a shape is wrong, a number is not finite, or the functions contradict each other there.
        """
        words: dict[str, Word] = {
            "q": (self.n_u, [coordinate.start for coordinate in self.coordinates], "units of the coordinates"),
            "u": (self.n_u, [coordinate.rate for coordinate in self.coordinates], "units of the coordinates per s"),
        }
        values = read_start("GeneralisedBody", words, start)
        q, u = values["q"], values["u"]
        q_scale, u_scale = self.scales
        check_equations(self._sample, q, u, q_scale[: self.n_u], u_scale)
        return np.append(q, np.zeros(self.n_q - self.n_u)), u


def _members(name: str, given: Any, kind: type) -> tuple[Any, ...]:
    if not isinstance(given, (tuple, list)) or not all(isinstance(item, kind) for item in given):
        raise InvalidInput(
            f"GeneralisedBody.{name}", f"must be a tuple of {kind.__name__}", given, "Mind the comma: (item,)."
        )
    return tuple(given)


def _constants(given: Any) -> dict[str, Value]:
    if not isinstance(given, Mapping):
        raise InvalidInput("GeneralisedBody.constants", "must be a mapping", given, "For example {'length': 0.2}.")
    found: dict[str, Value] = {}
    for name, value in given.items():
        thing = f"GeneralisedBody.constants[{name!r}]"
        if not str(name).isidentifier() or keyword.iskeyword(name) or name in _TAKEN:
            raise InvalidInput(thing, "must have the name of a variable of its own", name, f"Not {', '.join(_TAKEN)}.")
        try:
            numbers = np.array(value, dtype=float)
        except (TypeError, ValueError):
            numbers = np.full(1, np.nan)
        if numbers.ndim > 1 or numbers.size == 0 or not np.all(np.isfinite(numbers)):
            raise InvalidInput(thing, "must be a finite number or a tuple of such", value, "Give it in SI units.")
        found[name] = float(numbers) if numbers.ndim == 0 else tuple(numbers.tolist())
    return found
