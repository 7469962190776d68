"""Properties of normal laws."""

from __future__ import annotations

from nonsmooth.interfaces import CompliantNormalLaw, NormalLaw, RigidNormalLaw
from nonsmooth.problems.contact import solve_contact
from nonsmooth.testing.claims import Claims, rows
from nonsmooth.testing.compliance import compliant_rows
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.inputs import number
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.reference import ReferenceFriction, point

_SIZE = number("size", 1e-3, 1e3, 1.0, is_log=True)
_LOAD = number("load", -1e3, 1e3, -1.0)
_TOLERANCE = 1e-9
_DRAWS = 12
_RIGID = Claims()


def check_normal_law(law: NormalLaw) -> list[Property]:
    """Return the properties of a normal law.

    Those of a rigid law are about its certificate, those of a compliant one about its force, its certificate and the
    impacts of a mass.

    Parameters
    ----------
    law : NormalLaw
        The law, with parameters.
    """
    return properties(law, compliant_rows if isinstance(law, CompliantNormalLaw) else _rows)


def _rows(law: RigidNormalLaw) -> list[Row]:
    return [*component_rows(law), *rows(_RIGID, lambda: variants(law), _DRAWS)]


@_RIGID.claim(_LOAD)
def _accepts_sustained_contact(law: RigidNormalLaw, load: float) -> str:
    """Accelerations and forces that the engine finds for closed contacts, pressed or pulled, obey it."""
    p = point((0.0, 0.0, 0.0))
    result = solve_contact(p.mass, p.normal, p.tangential, [0.0, 0.0, load], [ReferenceFriction(0.0)])
    g, force = float(result.contact_acceleration[0, 0]), float(result.normal_force[0])
    if law.is_fulfilled(g, force, _TOLERANCE * abs(load) + _TOLERANCE):
        return ""
    return f"is_fulfilled refuses acceleration {g:g} m/s^2 with force {force:g} N"


def _accepted(law: RigidNormalLaw, acceleration: float, force: float, size: float) -> str:
    """Return that the law accepts a pair which it must refuse; "" if it refuses it."""
    g, f = acceleration * size, force * size
    if not law.is_fulfilled(g, f, _TOLERANCE * size):
        return ""
    return f"is_fulfilled accepts acceleration {g:g} m/s^2 with force {f:g} N"


@_RIGID.claim(_SIZE)
def _no_penetration(law: RigidNormalLaw, size: float) -> str:
    """A closed contact whose bodies accelerate into one another does not obey it."""
    return _accepted(law, -1.0, 0.0, size)


@_RIGID.claim(_SIZE)
def _no_tension(law: RigidNormalLaw, size: float) -> str:
    """A normal force that pulls does not obey it."""
    return _accepted(law, 0.0, -1.0, size)


@_RIGID.claim(_SIZE)
def _complementarity(law: RigidNormalLaw, size: float) -> str:
    """A force on a contact that opens does not obey it."""
    return _accepted(law, 1.0, 1.0, size)


@_RIGID.claim(_SIZE, _LOAD)
def _scaling(law: RigidNormalLaw, size: float, load: float) -> str:
    """Other units, and tolerances with them, do not change its verdict."""
    for g, f in ((max(load, 0.0), max(-load, 0.0)), (load, 1.0)):
        one, other = (bool(law.is_fulfilled(c * g, c * f, c * _TOLERANCE)) for c in (1.0, size))
        if one is not other:
            return f"is_fulfilled says {one} of ({g:g}, {f:g}) and {other} of {size:g} times that"
    return ""
