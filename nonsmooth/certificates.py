"""What laws of one kind have in common when they tell whether a force obeys them."""

from __future__ import annotations

import inspect
import math

from nonsmooth.interfaces import FrictionLaw

Pair = tuple[float, float]


def opposes_slip(law: FrictionLaw, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float) -> bool:
    """Tell whether a force lies in the disc of a friction law and, under slip, on its edge against the slip.

    Parameters
    ----------
    law : FrictionLaw
        Gives the coefficient at this slip speed; at rest that of speed 0.
    slip : tuple of float
        Slip velocity [m/s], shape (2,); at rest up to the tolerance.
    normal_force : float
        Normal force [N].
    tangential_force : tuple of float
        Tangential force [N], shape (2,).
    tolerance : float
        Deviation that counts as zero [m/s, N].
    """
    speed = math.hypot(*slip)
    offered = law.parameters()
    names = list(inspect.signature(law.coefficient).parameters)[1:]
    rests = speed <= tolerance
    bound = law.coefficient(0.0 if rests else speed, **{name: offered[name] for name in names}) * normal_force
    if rests:
        return math.hypot(*tangential_force) <= bound + tolerance
    # a distance, so that the verdict is the same in any axes
    return math.dist(tangential_force, [-bound * v / speed for v in slip]) <= tolerance
