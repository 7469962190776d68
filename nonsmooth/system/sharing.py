"""Where compliant contacts could share the friction that holds them in more ways than one."""

from __future__ import annotations

from nonsmooth.certificates import coefficient_of
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CompliantNormalLaw, FrictionLaw
from nonsmooth.system.materials import ContactLaws

_MOST = 2
"""Of so many contacts the share is followed through all changes of their loads; of more it is not, yet."""


def check_sharing(where: str, laws: ContactLaws, n: int) -> None:
    """Raise InvalidInput, naming ``where``, if ``n`` compliant contacts of two bodies hold by static friction.

    That friction is rigid, and not unique, while each contact has a bound of its own that vibrates with its load.
    """
    if n <= _MOST or not isinstance(laws.normal, CompliantNormalLaw):
        return
    friction = laws.friction
    if isinstance(friction, FrictionLaw) and coefficient_of(friction)(0.0) > 0.0:
        raise InvalidInput(
            f"{where}: {type(friction).__name__}",
            f"can hold at most {_MOST} compliant contacts between two bodies",
            n,
            "Take bristles, which share the load by their stiffness (bristle, coulomb_contensou), or rigid contacts.",
        )
