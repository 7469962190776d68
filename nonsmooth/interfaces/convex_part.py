"""ConvexPart: a convex set of points of a body in numbers, for the engine's look at pairs of bodies."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import final

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class ConvexPart:
    """The hull of circles and points, with an ellipsoid, or a norm of other powers, and a ball added.

    All sizes are in axes of its own.  Its support function is
    h(n) = max over circles of (c . n + r |n across the third axis|) + |n|_(semi, powers) + ball |n|, with the norm
    ((|a n_x|^q + |b n_y|^q)^(p/q) + |c n_z|^p)^(1/p), or with what a function gives in place of it.

    Attributes
    ----------
    rings : Vector
        Centres and radii of circles about the third axis [m], shape [n, 4]; points have no radius.
    semi : tuple of float
        Semi-axes a, b, c of what is added [m]; 0 for nothing.
    powers : tuple of float
        Powers p and q, above 1; 2 and 2 for an ellipsoid.
    ball : float
        Radius of the ball that is added [m].
    place, axes : Vector
        Its origin [m], shape [3], and its axes as columns, shape [3, 3], in the frame of the body.
    function : tuple of float
        Address and parameters of a function of the form ``support`` that gives the farthest point of what is added;
        none if empty.
    reach : float
        Radius of a ball about the origin that holds what the function gives [m].
    protrusion : float
        Largest distance by which the contacts of the shape extend beyond the part [m]: feet are no part.
    """

    rings: Vector = field(default_factory=lambda: np.zeros((0, 4)))
    semi: tuple[float, float, float] = (0.0, 0.0, 0.0)
    powers: tuple[float, float] = (2.0, 2.0)
    ball: float = 0.0
    place: Vector = field(default_factory=lambda: np.zeros(3))
    axes: Vector = field(default_factory=lambda: np.eye(3))
    function: tuple[float, ...] = ()
    reach: float = 0.0
    protrusion: float = 0.0

    @classmethod
    def of_points(cls, points: Vector, ball: float = 0.0) -> ConvexPart:
        """Return the hull of points [m], shape [n, 3], within a distance ``ball`` of which it ends [m]."""
        place = np.mean(points, axis=0)
        return cls(np.column_stack([points - place, np.zeros(len(points))]), ball=ball, place=place)

    @classmethod
    def below(cls, height: float) -> ConvexPart:
        """Return the half-space below a height over the origin of the body frame [m]."""
        return cls(place=np.array([0.0, 0.0, height]), reach=math.inf)

    @property
    def is_half_space(self) -> bool:
        """Whether it is unbounded."""
        return math.isinf(self.reach)

    @property
    def is_ball(self) -> bool:
        """Whether it is a ball or a point, of which every distance is known in closed form."""
        a, b, c = self.semi
        return not (len(self.rings) > 1 or np.any(self.rings[:, 3:]) or self.function) and a == b == c

    @property
    def is_flat(self) -> bool:
        """Whether it is a single circle or point: two such sets cannot overlap by any depth."""
        return len(self.rings) == 1 and self.ball == 0.0 and max(self.semi) == 0.0 and not self.function

    @property
    def is_disc(self) -> bool:
        """Whether it is a disc without thickness."""
        return self.is_flat and bool(self.rings[0, 3] > 0.0)

    @property
    def radius(self) -> float:
        """Radius of a ball about its origin that holds it [m]."""
        rings = np.linalg.norm(self.rings[:, :3], axis=1) + self.rings[:, 3]
        # of a norm the sum of the semi-axes is a bound, whatever its powers are
        semi = max(self.semi) if self.powers == (2.0, 2.0) else sum(self.semi)
        return float(np.max(rings, initial=0.0)) + semi + self.ball + self.reach

    def height(self, direction: Vector) -> float:
        """Return h(n) in the frame of the body, for a direction of any length [m times that]; not of functions."""
        return float(self.heights(np.asarray(direction)[None])[0])

    def heights(self, directions: Vector) -> Vector:
        """Return h(n) for several directions, shape [m, 3]; shape [m]."""
        n = directions @ self.axes
        across = np.hypot(n[:, 0], n[:, 1])
        (a, b, c), (p, q) = self.semi, self.powers
        wide = (np.abs(a * n[:, 0]) ** q + np.abs(b * n[:, 1]) ** q) ** (1.0 / q)
        added = (wide**p + np.abs(c * n[:, 2]) ** p) ** (1.0 / p) + self.ball * np.linalg.norm(n, axis=1)
        hull = np.max(n @ self.rings[:, :3].T + np.outer(across, self.rings[:, 3]), axis=1) if len(self.rings) else 0.0
        return np.asarray(directions @ self.place + hull + added)
