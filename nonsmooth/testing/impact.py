"""Properties of impact laws, processes and maps alike."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.testing.claims import FEWEST, GIVEN, Claim, Claims, claim, rows
from nonsmooth.testing.component import accepted, numbers_of, variants
from nonsmooth.testing.functions import CheckedFunction, all_rows, plain_caller, scalar_function
from nonsmooth.testing.impact_map import MAP, is_alone, map_functions
from nonsmooth.testing.impact_process import PROCESS
from nonsmooth.testing.inputs import number
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.reference import ImpactProblem, ImpactResponse, point, problem_of, respond

_MU = number("friction", 0.02, 0.6, 0.2)
_ROUGH = number("friction", 0.02, 1.2, 0.2)
_OTHER_MU = number("other_friction", 0.02, 0.6, 0.4)
_FACTOR = number("factor", 1e-2, 1e2, 2.0, is_log=True)
_HEADING = number("heading", -3.1, 3.1)
_TURN = number("turn", -3.1, 3.1, 1.0)
_SPEED = number("speed", 1e-2, 1e2, 1.0, is_log=True)
_ONE = problem_of(1)
_DRAWS, _DRAWS_BY_KIND = 10, 6
_AFTER = "the velocities after are"
_NEAR = 1e-6
"""Agreement of velocities after impacts that should be the same, relative to the largest."""
_INDENTATIONS = (0.0, *np.geomspace(1e-9, 1e2, 12).tolist())
_RATES = (*(-np.geomspace(1e-9, 1e2, 6)).tolist(), 0.0, *np.geomspace(1e-9, 1e2, 12).tolist())
_SHARED = Claims()


def check_impact_law(law: ImpactLaw, *, restitution: str = "restitution") -> list[Property]:
    """Return the properties of an impact law.

    Parameters
    ----------
    law : ImpactLaw
        The law, with parameters.
    restitution : str
        Its parameter, between 0 and 1, with which it goes from the plastic impact to the elastic one; the two limits
        are not checked if it has no parameter of that name.
    """
    return properties(law, _rows, restitution=restitution)


def _rows(law: ImpactLaw, restitution: str) -> list[Row]:
    most = _ONE if is_alone(law) else problem_of(2)
    table = functools.partial(rows, components=lambda: variants(law), given=[most])
    found = table(_SHARED, count=_DRAWS)
    if isinstance(law, ImpactProcess):
        found += table(PROCESS, count=_DRAWS_BY_KIND)
    if isinstance(law, ImpactMap):
        found += table(MAP, count=4)
    found += [
        Row("limit e -> 0", _plastic.says, lambda: _check_limit(law, restitution, 0.0, _plastic)),
        Row("limit e -> 1", _elastic.says, lambda: _check_limit(law, restitution, 1.0, _elastic)),
    ]
    return all_rows(law, lambda: [f for one in variants(law) for f in _functions(one)], found)


def _functions(law: ImpactLaw) -> list[CheckedFunction]:
    if isinstance(law, ImpactProcess):
        return [
            scalar_function(law, "force", _INDENTATIONS, law.parameters()),
            scalar_function(law, "efficiency", _RATES, law.parameters()),
        ]
    return map_functions(law) if isinstance(law, ImpactMap) else []


def _check_limit(law: ImpactLaw, restitution: str, value: float, limit: Claim) -> None:
    if restitution not in numbers_of(law):
        raise NotChecked(f"{type(law).__name__}: it has no parameter {restitution!r}")
    at = accepted(law, **{restitution: value})
    if at is None:
        raise Broken("the limit is refused", restitution, value)
    limit.examine([at], _DRAWS)


def _respond(law: ImpactLaw, p: ImpactProblem, mu: float) -> ImpactResponse:
    return respond([law] * p.n, [mu] * p.n, p)


@_SHARED.claim(GIVEN, _MU, fewest=FEWEST)
def _no_approach_after(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """After the impact no contact approaches."""
    r = _respond(law, p, mu)
    least = float(np.min(r.after[:, 0]))
    return f"a gap closes at {-least:g} m/s afterwards" if least < -1e-7 * r.size else ""


@_SHARED.claim(GIVEN, _MU, fewest=FEWEST)
def _cone(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """Normal impulses push, tangential ones lie in the cone of the friction coefficient."""
    r = _respond(law, p, mu)
    small = 1e-8 * r.size
    for normal, *across in r.impulse:
        if normal < -small:
            return f"a contact pulls with {-normal:g} N s"
        if math.hypot(*across) > mu * normal + small:
            return f"the impulse {math.hypot(*across):g} N s across leaves the cone of {normal:g} N s along"
    return ""


def _gain(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    r = _respond(law, p, mu)
    if np.any(r.before[:, 0] > 0.0):
        return ""
    gain = p.energy(r.velocity) - p.energy(p.velocity)
    return f"the kinetic energy rises by {gain:g} J" if gain > 1e-7 * r.size**2 else ""


@_SHARED.claim(GIVEN, fewest=FEWEST)
def _dissipation(law: ImpactLaw, p: ImpactProblem) -> str:
    """Without friction no impact of approaching contacts gains energy."""
    return _gain(law, p, 0.0)


@_SHARED.claim(GIVEN, _ROUGH, fewest=FEWEST)
def _dissipation_with_friction(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """Nor does an impact with friction gain energy."""
    # one contact alone too, with slip in and against the lean of the body
    one = ImpactProblem(p.mass, p.normal[:, :1], p.tangential[:, :1], p.velocity)
    back = ImpactProblem(p.mass, one.normal, one.tangential, p.velocity * np.array([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0]))
    return _gain(law, one, mu) or _gain(law, back, mu) or _gain(law, p, mu)


@_SHARED.claim(_ONE, _MU, _FACTOR, fewest=FEWEST)
def _scaling_of_masses(law: ImpactLaw, p: ImpactProblem, mu: float, c: float) -> str:
    """Masses times c: the same velocities, impulses times c."""
    one, other = (_respond(law, q, mu) for q in (p, ImpactProblem(c * p.mass, p.normal, p.tangential, p.velocity)))
    if _apart(one.velocity, other.velocity, one.size):
        return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} with {c:g} times the mass"
    return "impulses are not proportional" if _apart(c * one.impulse, other.impulse, c * one.size) else ""


@_SHARED.claim(GIVEN, _MU, _FACTOR, fewest=FEWEST)
def _scaling_of_velocities(law: ImpactLaw, p: ImpactProblem, mu: float, c: float) -> str:
    """Velocities times c before: times c after."""
    if isinstance(law, ImpactProcess) and not _is_homogeneous(law):
        raise NotChecked(f"{type(law).__name__}: its force is no power or its efficiency depends on the rate")
    one, other = (_respond(law, q, mu) for q in (p, ImpactProblem(p.mass, p.normal, p.tangential, c * p.velocity)))
    if not _apart(c * one.velocity, other.velocity, c * one.size):
        return ""
    return f"{_AFTER} {_list(one.velocity)}, and of {c:g} times those before {_list(other.velocity / c)} times {c:g}"


def _is_homogeneous(law: ImpactProcess) -> bool:
    force, efficiency = (plain_caller(f, "scalar", law.parameters()) for f in (law.force, law.efficiency))
    powers = [math.log(force(2.0 * x) / force(x)) for x in (1e-4, 1e-2, 1.0)]
    shares = [efficiency(rate) for rate in _RATES if rate > 0.0]
    return max(powers) - min(powers) < 1e-9 and max(shares) - min(shares) < 1e-12


@_SHARED.claim(GIVEN, _MU, _TURN, fewest=FEWEST)
def _frame_invariance(law: ImpactLaw, p: ImpactProblem, mu: float, turn: float) -> str:
    """Turning the tangents of the contacts changes no velocity."""
    one, other = _respond(law, p, mu), _respond(law, p.turned(turn), mu)
    if not _apart(one.velocity, other.velocity, one.size):
        return ""
    return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} in tangents turned by {turn:g} rad"


@_SHARED.claim(GIVEN, _MU, _OTHER_MU, fewest=FEWEST)
def _permutation(law: ImpactLaw, p: ImpactProblem, mu: float, other_mu: float) -> str:
    """The order of the contacts does not matter."""
    if is_alone(law):
        raise NotChecked(f"{type(law).__name__}: it is a law of one contact")
    swapped = ImpactProblem(p.mass, p.normal[:, ::-1].copy(), p.tangential[:, ::-1].copy(), p.velocity)
    one, other = respond([law] * 2, (mu, other_mu), p), respond([law] * 2, (other_mu, mu), swapped)
    if not _apart(one.velocity, other.velocity, one.size):
        return ""
    return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} in the other order"


@_SHARED.claim(GIVEN, name="limit mu -> 0", fewest=FEWEST)
def _smooth(law: ImpactLaw, p: ImpactProblem) -> str:
    """Without friction no tangential impulse; with next to none, next to none."""
    for mu in (0.0, 1e-8):
        r = _respond(law, p, mu)
        across = float(np.max(np.abs(r.impulse[:, 1:])))
        if across > mu * float(np.max(r.impulse[:, 0])) + 1e-9 * r.size:
            return f"with the coefficient {mu:g} the tangential impulse is {across:g} N s"
    return ""


@_SHARED.claim(_MU, _HEADING, fewest=FEWEST)
def _force_and_impact_level(law: ImpactLaw, mu: float, heading: float) -> str:
    """An impact too slight to end the slip rubs as sustained contact does."""
    slip = np.array([math.cos(heading), math.sin(heading)])
    r = _respond(law, point((*slip, -1e-4)), mu)
    ratio = r.impulse[0, 1:] / r.impulse[0, 0]
    if np.max(np.abs(ratio + mu * slip)) > 1e-6:
        return f"impulses have the ratio {_list(ratio)}, sliding friction has {_list(-mu * slip)}"
    return ""


@_SHARED.claim()
def _contact_time(law: ImpactLaw) -> str:
    """The contact time is a finite number >= 0."""
    time = law.contact_time
    return "" if math.isfinite(time) and time >= 0.0 else f"it is {time} s, and not a finite number >= 0"


@claim(_SPEED, _MU)
def _plastic(law: ImpactLaw, speed: float, mu: float) -> str:
    """Without restitution the bodies do not part."""
    after = _respond(law, point((0.0, 0.0, -speed)), mu).after[0, 0]
    return f"it leaves at {after:g} m/s" if abs(after) > _NEAR * speed else ""


@claim(_SPEED, _MU)
def _elastic(law: ImpactLaw, speed: float, mu: float) -> str:
    """With full restitution a slow impact gives back all."""
    slow = 1e-9 * speed
    after = float(_respond(law, point((0.0, 0.0, -slow)), mu).after[0, 0])
    return f"of {slow:g} m/s it leaves {after:g} m/s" if abs(after - slow) > 1e-4 * slow else ""


def _apart(one: Any, other: Any, size: float) -> bool:
    return not np.allclose(one, other, rtol=0.0, atol=_NEAR * size)


def _list(values: Any) -> str:
    return np.array2string(np.asarray(values), precision=6, separator=", ", suppress_small=True).replace("\n", "")
