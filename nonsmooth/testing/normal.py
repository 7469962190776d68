"""Properties of normal laws."""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces import CompliantNormalLaw, NormalLaw, RigidNormalLaw
from nonsmooth.problems.contact import solve_contact
from nonsmooth.testing.compliance import compliant_properties
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.property import Property, Row, properties
from nonsmooth.testing.reference import Constant

_SIZE = Variable("size", 1e-3, 1e3, 1.0, log=True)
_TOLERANCE = 1e-9
_DRAWS = 12


def check_normal_law(law: NormalLaw) -> list[Property]:
    """Return the properties of a normal law.

    Those of a rigid law are about its certificate, those of a compliant one about its force, its certificate and the
    impacts of a mass.

    Parameters
    ----------
    law : NormalLaw
        The law, with parameters.
    """
    if isinstance(law, CompliantNormalLaw):
        return compliant_properties(law)

    def row(name: str, says: str, trial: Trial, *space: Variable) -> Row:
        return name, says, lambda: examine(name, variants(law), space or (_SIZE,), trial, _DRAWS)

    load = Variable("load", -1e3, 1e3, -1.0)
    return properties(
        law,
        [
            *component_rows(law),
            row(
                "accepts sustained contact",
                "accelerations and forces that the engine finds for closed contacts, pressed or pulled, obey it",
                _accepts,
                load,
            ),
            row(
                "no penetration",
                "a closed contact whose bodies accelerate into one another does not obey it",
                _refuses(-1, 0),
            ),
            row("no tension", "a normal force that pulls does not obey it", _refuses(0, -1)),
            row("complementarity", "a force on a contact that opens does not obey it", _refuses(1, 1)),
            row("scaling", "other units, and tolerances with them, do not change its verdict", _scales, _SIZE, load),
        ],
    )


def _accepts(law: RigidNormalLaw, case: Case) -> str:
    result = solve_contact(
        np.eye(3), np.eye(3)[:, 2:], np.eye(3)[:, None, :2], [0.0, 0.0, case["load"]], [Constant(0.0)]
    )
    g, force = float(result.contact_acceleration[0, 0]), float(result.normal_force[0])
    if law.is_fulfilled(g, force, _TOLERANCE * abs(case["load"]) + _TOLERANCE):
        return ""
    return f"is_fulfilled refuses acceleration {g:g} m/s^2 with force {force:g} N"


def _refuses(acceleration: int, force: int) -> Trial:
    def trial(law: RigidNormalLaw, case: Case) -> str:
        g, f = acceleration * case["size"], force * case["size"]
        if not law.is_fulfilled(g, f, _TOLERANCE * case["size"]):
            return ""
        return f"is_fulfilled accepts acceleration {g:g} m/s^2 with force {f:g} N"

    return trial


def _scales(law: RigidNormalLaw, case: Case) -> str:
    size = case["size"]
    for g, f in ((max(case["load"], 0.0), max(-case["load"], 0.0)), (case["load"], 1.0)):
        one, other = (bool(law.is_fulfilled(c * g, c * f, c * _TOLERANCE)) for c in (1.0, size))
        if one is not other:
            return f"is_fulfilled says {one} of ({g:g}, {f:g}) and {other} of {size:g} times that"
    return ""
