"""Bodies that carry any shapes, for tests of shapes and contact pairs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import FreeBody, Rest
from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import NamesAndUnits
from nonsmooth.model.assembly import assemble
from nonsmooth.parameters import Value
from tests.bodies.every_pair import all_features

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Carrier(FreeBody):
    """A free body with the shapes, mass [kg] and principal moments [kg m^2] given."""

    carried: tuple[Shape, ...]
    mass: float = 1.0
    moments: tuple[float, float, float] = (0.1, 0.1, 0.1)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """Those given."""
        return self.carried

    @property
    def total_mass(self) -> float:
        """The one given."""
        return self.mass

    @property
    def inertia(self) -> tuple[float, float, float]:
        """The one given."""
        return self.moments

    @property
    def scales(self) -> tuple[Array, Array]:
        """A metre, as a plane has no length."""
        return np.ones(7), np.ones(6)


@final
@dataclass(frozen=True)
class Stand(Body):
    """A body at rest with the shapes given."""

    carried: tuple[Shape, ...]

    def parameters(self) -> Mapping[str, Value]:
        """Return those of the rest."""
        return Rest().parameters()

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with those given."""
        return (self.carried,)

    @property
    def q_labels(self) -> NamesAndUnits:
        """0: at rest."""
        return ()

    @property
    def u_labels(self) -> NamesAndUnits:
        """0: at rest."""
        return ()

    @property
    def quaternion(self) -> int:
        """None."""
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        """The rest's."""
        return Rest().evaluator

    @property
    def scales(self) -> tuple[Array, Array]:
        """Empty."""
        return np.zeros(0), np.zeros(0)

    @property
    def time_scale(self) -> float:
        """Infinite [s]."""
        return np.inf

    def state(self, **start: Any) -> tuple[Array, Array]:
        """Return nothing."""
        return np.zeros(0), np.zeros(0)


class Rig:
    """Two free bodies, one shape each, that can be put anywhere; gives what the engine makes of their contacts.

    Every pair of features is a contact of its own.  With a ``margin`` [m], contacts whose features are searched for are
    those of pairs within this distance.
    """

    def __init__(self, shapes: tuple[Shape, Shape], laws: dict[str, Any], margin: float | None = None) -> None:
        self._bodies = Carrier((shapes[0],)), Carrier((shapes[1],))
        self._system = ns.System(self._bodies)
        with all_features() if margin is None else nullcontext():
            self.contacts = self._system.contact(*self._bodies, **laws)
        margin = 1e9 if margin is None else margin
        self._system.place(self._bodies[1], position=(0.0, 0.0, 50.0))
        self._model = assemble(self._system, EventDriven())
        # polyhedra have so many contacts that only those of near bodies are listed
        self._model.memory[owners.Island.list_margin] = self._model.memory[owners.Options.widest_margin] = margin
        # nor are contacts of shapes that are apart
        self._model.memory[owners.Pair.is_guarded] = self._model.memory[owners.Pair.is_apart] = False
        self._model.list_contacts()

    def listed(self) -> float:
        """List the contacts near each other; return how far others are at least [m]."""
        self._model.list_contacts()
        return float(self._model.memory[owners.Island.list_margin])

    def put(self, poses: Any, u: Any) -> None:
        """Put the bodies at (position, quaternion) each, with velocities u [12]."""
        q = np.concatenate([np.concatenate(pose) for pose in poses])
        self._model.memory[owners.Island.y][:26] = np.concatenate([q, u])
        call_entry("evaluate_at", self._model.memory)

    def _rows(self, declared: Any) -> Array:
        memory = self._model.memory
        return np.array(memory[declared][: memory[owners.Island.n_contacts]])

    @property
    def geometry(self) -> Array:
        """Geometry blocks, shape [n_contacts, 30]."""
        return self._rows(owners.ContactRecord.geometry)

    @property
    def axes(self) -> Array:
        """Normal and tangents, shape [n_contacts, 3, 3]."""
        return self._rows(owners.ContactRecord.axes).reshape(-1, 3, 3)

    @property
    def rate(self) -> Array:
        """Gap rate and slip velocity, shape [n_contacts, 3]."""
        return self._rows(owners.ContactRecord.rate)

    @property
    def bias(self) -> Array:
        """Their derivatives while u' = 0, shape [n_contacts, 3]."""
        return self._rows(owners.ContactRecord.bias)
