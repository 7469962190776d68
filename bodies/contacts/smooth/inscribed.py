"""Proof, by inscribed balls, that no translation shorter than the overlap d separates two smooth bodies.

A search has found contact points with the gap -d.  Inscribe a ball in each body that touches its surface at the contact
point.  In every direction, the gap between the bodies is at most the gap between the balls, because the balls lie
inside.  If the sum of the radii is d or more, the gap between the balls is at most -d in every direction.

The radius of a ball follows from a function that is 1 on the surface of its body and less inside.  Let G be the
function's gradient at the contact point, L a bound of its second derivative in the ball of radius d that touches the
surface there from inside.  In the ball of the radius G / L, at most d, the function stays below 1.
"""

from __future__ import annotations

from nonsmooth.compiled import compiled

from ...rotations import rotated_back
from ...shapes.support_function import OF_FUNCTION, Core, gauge_of
from ...vectors import Vector3, dot, minus, opposite, plus_scaled, vector_at
from .dual_newton import gap_by_normal
from .smooth_core import POINT, POWERS, Cores, NearestPoint, largest_semi_axis, spread


@compiled
def is_least_overlap(cores: Cores, solution: NearestPoint) -> bool:
    """Return True if inscribed balls prove that no translation shorter than the overlap separates the cores.

    ``solution`` is the gap, below 0 [m], the second core's contact point and the normal.
    """
    g, q, n = solution
    radius = _inscribed_radius(cores.first, -g, plus_scaled(q, -g, n), n)
    if radius >= -g:
        return True
    point, normal = rotated_back(cores.turn, minus(q, cores.center)), rotated_back(cores.turn, opposite(n))
    return bool(radius + _inscribed_radius(cores.second, -g, point, normal) >= -g)


@compiled
def _inscribed_radius(core: Core, limit: float, point: Vector3, normal: Vector3) -> float:
    """Return the radius [m] of a ball that lies inside the core and touches the core's surface at a point.

    The point is in the axes of the core, from its centre [m].  ``normal`` is the outward unit normal there.  The radius
    is a lower bound of the largest possible radius, and at most ``limit`` [m].  It is 0 if no ball was found.
    """
    a, b, c = vector_at(core, 0)
    height = dot(normal, point)
    if core[POWERS] == OF_FUNCTION or min(a, min(b, c)) <= 0.0 or height <= 0.0:
        return 0.0
    # the function is r^j + |z / c|^j, with r^k = |x / a|^k + |y / b|^k. First: bounds of |x / a|^k, |y / b|^k and
    # |z / c| in a cube that contains the ball of radius ``limit``, and bounds of the parts s and t of x and y in r^k
    j, k = core[POWERS] / (core[POWERS] - 1.0), core[POWERS + 1] / (core[POWERS + 1] - 1.0)
    x, y, z = plus_scaled(point, -limit, normal)
    x, y, z = abs(x), abs(y), abs(z)
    low_x, low_y, low_z = (max(x - limit, 0.0) / a) ** k, (max(y - limit, 0.0) / b) ** k, max(z - limit, 0.0) / c
    high_x, high_y, high_z = ((x + limit) / a) ** k, ((y + limit) / b) ** k, (z + limit) / c
    low_s, low_t = low_x / (low_x + high_y), low_y / (high_x + low_y)
    high_s, high_t = 1.0 - low_t, 1.0 - low_s
    # r^(j - 2) and |z / c|^(j - 2) are bounded by the upper bounds of r^k and |z / c| if j >= 2, else by the lower ones
    r_k, w = high_x + high_y, high_z
    if j < 2.0:
        r_k, w = low_x + low_y, low_z
    s, t = (high_s, high_t) if k >= 2.0 else (low_s, low_t)
    if min(min(r_k, w), min(s, t)) == 0.0:
        # the second derivative has no bound in this cube: the radius is 0
        return 0.0
    # bounds of the second derivative divided by j: across the third axis, by the changes of r (radial) and of the
    # direction of (x, y), and along it. The function is homogeneous: G = j / height; L is j times the larger bound
    power = 1.0 - 2.0 / k
    radial = (j - 1.0) * (high_s ** (power + 1.0) / (a * a) + high_t ** (power + 1.0) / (b * b))
    around = (k - 1.0) * (s**power * high_t / (a * a) + t**power * high_s / (b * b))
    across, up = r_k ** ((j - 2.0) / k) * (radial + around), (j - 1.0) * w ** (j - 2.0) / (c * c)
    return float(min(limit, 1.0 / (height * max(across, up))))


@compiled
def gauge(core: Core, point: Vector3) -> float:
    """Return the gauge of a point, given in the axes of a core [m]: 1 on its surface, more outside, less inside.

    A core given by a support function has no gauge in closed form.  There the result is 1 + signed distance / size, or
    nan if no normal was found.
    """
    if core[POWERS] != OF_FUNCTION:
        return float(gauge_of(core, point))
    size, no_axis = largest_semi_axis(core), (0.0, 0.0, 0.0)
    # near the centre the direction to it is lost in round-off
    if spread(point) <= 1e-9 * size:
        return 0.0
    identity = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    g, _, _ = gap_by_normal(Cores(POINT, core, identity, opposite(point)), no_axis, opposite(point))
    return float(1.0 + g / size)
