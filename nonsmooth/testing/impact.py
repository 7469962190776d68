"""Conformance checks of impact laws: processes, which the engine integrates, and maps from rates to impulses.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from typing import Any

import numpy as np

from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.testing.claims import FEWEST, GIVEN, Claim, Claims, claim, rows, wrong_verdict
from nonsmooth.testing.component import accepted, numbers_of, variants
from nonsmooth.testing.functions import OLD, CheckedFunction, all_rows, plain_caller, scalar_function, written
from nonsmooth.testing.inputs import draws, number
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.reference import ImpactProblem, ImpactResponse, point, problem_of, respond, vectors_of
from nonsmooth.types import Array

_MU = number("friction", 0.02, 0.6, 0.2)
_ROUGH = number("friction", 0.02, 1.2, 0.2)
_OTHER_MU = number("other_friction", 0.02, 0.6, 0.4)
_FACTOR = number("factor", 1e-2, 1e2, 2.0, is_log=True)
_HEADING = number("heading", -3.1, 3.1)
_TURN = number("turn", -3.1, 3.1, 1.0)
_SPEED = number("speed", 1e-2, 1e2, 1.0, is_log=True)
_ONE = problem_of(1)
_DRAWS, _DRAWS_BY_KIND = 10, 6
_NEAR = 1e-6
"""Allowed difference of velocities after impacts that must be the same, relative to the largest speed."""
_INDENTATIONS = (0.0, *np.geomspace(1e-9, 1e2, 12).tolist())
_RATES = (*(-np.geomspace(1e-9, 1e2, 6)).tolist(), 0.0, *np.geomspace(1e-9, 1e2, 12).tolist())
_INDENTATION = number("indentation", 1e-6, 1e1, 1.0, is_log=True)
_RATE = number("rate", 1e-6, 1e2, 1.0, is_log=True)
_STORED = number("stored", 1e-3, 1e3, 1.0, is_log=True)
_GRID = tuple(np.geomspace(1e-9, 1e2, 23).tolist())
_ANY_MU = number("friction", 0.0, 0.6)
_OF_FUNCTION = 0.3
"""Friction coefficient of the contacts for which the function ``impulses`` of an impact map is called: a usual value.
An impact map is a law that computes impulses directly from the velocities before an impact."""
_SHARED, _PROCESS, _MAP = Claims(fewest=FEWEST), Claims(fewest=FEWEST), Claims()
"""Claims about all impact laws, about processes and about maps, respectively; ``fewest`` limits inputs in plain
mode."""


def check_impact_law(law: ImpactLaw, *, restitution: str = "restitution") -> list[Property]:
    """Return the properties of an impact law.

    Parameters
    ----------
    law : ImpactLaw
        The law, with parameters.
    restitution : str
        Name of the parameter that is 0 for a plastic impact and 1 for an elastic impact. If the law has no parameter of
        this name, the two limits are not checked.
    """
    return properties(law, _rows, restitution=restitution)


def _rows(law: ImpactLaw, restitution: str) -> list[Row]:
    most = _ONE if _is_alone(law) else problem_of(2)
    table = functools.partial(rows, components=lambda: variants(law), given=[most])
    found = table(_SHARED, count=_DRAWS)
    if isinstance(law, ImpactProcess):
        found += table(_PROCESS, count=_DRAWS_BY_KIND)
    if isinstance(law, ImpactMap):
        found += table(_MAP, count=4)
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
    return _map_functions(law) if isinstance(law, ImpactMap) else []


def _check_limit(law: ImpactLaw, restitution: str, value: float, limit: Claim) -> None:
    if restitution not in numbers_of(law):
        raise NotChecked(f"{type(law).__name__}: it has no parameter {restitution!r}")
    at = accepted(law, **{restitution: value})
    if at is None:
        raise Broken("the limit is refused", restitution, value)
    limit.examine([at], _DRAWS)


def _respond(law: ImpactLaw, p: ImpactProblem, mu: float) -> ImpactResponse:
    return respond([law] * p.n, [mu] * p.n, p)


@_SHARED.claim(GIVEN, _MU)
def _no_approach_after(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """After an impact, the bodies approach at no contact."""
    r = _respond(law, p, mu)
    least = float(np.min(r.after[:, 0]))
    return f"a gap closes at {-least:g} m/s afterwards" if least < -1e-7 * r.size else ""


@_SHARED.claim(GIVEN, _MU)
def _cone(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """No normal impulse pulls, and no tangential impulse exceeds the friction coefficient times the normal one."""
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


@_SHARED.claim(GIVEN)
def _dissipation(law: ImpactLaw, p: ImpactProblem) -> str:
    """An impact of approaching contacts without friction does not raise the energy."""
    return _gain(law, p, 0.0)


@_SHARED.claim(GIVEN, _ROUGH)
def _dissipation_with_friction(law: ImpactLaw, p: ImpactProblem, mu: float) -> str:
    """An impact of approaching contacts with friction does not raise the energy."""
    # also the first contact alone, with the velocity along x as drawn and reversed
    one = replace(p, normal=p.normal[:, :1], tangential=p.tangential[:, :1])
    back = replace(one, velocity=p.velocity * np.array([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0]))
    return _gain(law, one, mu) or _gain(law, back, mu) or _gain(law, p, mu)


@_SHARED.claim(_ONE, _MU, _FACTOR)
def _scaling_of_masses(law: ImpactLaw, p: ImpactProblem, mu: float, c: float) -> str:
    """If all masses are multiplied by c, impulses are multiplied by c and velocities do not change."""
    one, other = _respond(law, p, mu), _respond(law, replace(p, mass=c * p.mass), mu)
    if fault := _difference(one, other.velocity, f"with {c:g} times the mass"):
        return fault
    return "impulses are not proportional" if _apart(c * one.impulse, other.impulse, c * one.size) else ""


@_SHARED.claim(GIVEN, _MU, _FACTOR)
def _scaling_of_velocities(law: ImpactLaw, p: ImpactProblem, mu: float, c: float) -> str:
    """If all velocities before an impact are c times as large, so are all velocities after it."""
    if isinstance(law, ImpactProcess) and not _is_homogeneous(law):
        raise NotChecked(f"{type(law).__name__}: its force is no power or its efficiency depends on the rate")
    one, other = _respond(law, p, mu), _respond(law, replace(p, velocity=c * p.velocity), mu)
    return _difference(one, other.velocity / c, f"times {c:g} with {c:g} times those before")


def _is_homogeneous(law: ImpactProcess) -> bool:
    force, efficiency = (plain_caller(f, "scalar", law.parameters()) for f in (law.force, law.efficiency))
    powers = [math.log(force(2.0 * x) / force(x)) for x in (1e-4, 1e-2, 1.0)]
    shares = [efficiency(rate) for rate in _RATES if rate > 0.0]
    return max(powers) - min(powers) < 1e-9 and max(shares) - min(shares) < 1e-12


@_SHARED.claim(GIVEN, _MU, _TURN)
def _frame_invariance(law: ImpactLaw, p: ImpactProblem, mu: float, turn: float) -> str:
    """If the tangents of the contacts are turned, the velocities after an impact do not change."""
    one, other = _respond(law, p, mu), _respond(law, p.turned(turn), mu)
    return _difference(one, other.velocity, f"in tangents turned by {turn:g} rad")


@_SHARED.claim(GIVEN, _MU, _OTHER_MU)
def _permutation(law: ImpactLaw, p: ImpactProblem, mu: float, other_mu: float) -> str:
    """The velocities after an impact do not depend on the order of the contacts."""
    if _is_alone(law):
        raise NotChecked(f"{type(law).__name__}: it is a law of one contact")
    swapped = replace(p, normal=p.normal[:, ::-1].copy(), tangential=p.tangential[:, ::-1].copy())
    one, other = respond([law] * 2, (mu, other_mu), p), respond([law] * 2, (other_mu, mu), swapped)
    return _difference(one, other.velocity, "in the other order")


@_SHARED.claim(GIVEN, name="limit mu -> 0")
def _smooth(law: ImpactLaw, p: ImpactProblem) -> str:
    """Tangential impulses are zero without friction, and at most mu times the normal impulse with a small mu."""
    for mu in (0.0, 1e-8):
        r = _respond(law, p, mu)
        across = float(np.max(np.abs(r.impulse[:, 1:])))
        if across > mu * float(np.max(r.impulse[:, 0])) + 1e-9 * r.size:
            return f"with the coefficient {mu:g} the tangential impulse is {across:g} N s"
    return ""


@_SHARED.claim(_MU, _HEADING)
def _force_and_impact_level(law: ImpactLaw, mu: float, heading: float) -> str:
    """In a slight impact, which does not end the slip, the ratio of friction to normal impulse is that of sliding."""
    slip = np.array([math.cos(heading), math.sin(heading)])
    r = _respond(law, point((*slip, -1e-4)), mu)
    ratio = r.impulse[0, 1:] / r.impulse[0, 0]
    if np.max(np.abs(ratio + mu * slip)) > 1e-6:
        return f"impulses have the ratio {_list(ratio)}, sliding friction has {_list(-mu * slip)}"
    return ""


@_SHARED.claim()
def _contact_time(law: ImpactLaw) -> str:
    """The contact time of the law is finite and not negative."""
    time = law.contact_time
    return "" if math.isfinite(time) and time >= 0.0 else f"it is {time} s, and not a finite number >= 0"


@claim(_SPEED, _MU)
def _plastic(law: ImpactLaw, speed: float, mu: float) -> str:
    """Without restitution the bodies do not separate after an impact."""
    after = _respond(law, point((0.0, 0.0, -speed)), mu).after[0, 0]
    return f"it leaves at {after:g} m/s" if abs(after) > _NEAR * speed else ""


@claim(_SPEED, _MU)
def _elastic(law: ImpactLaw, speed: float, mu: float) -> str:
    """With full restitution a slow impact does not change the energy."""
    slow = 1e-9 * speed
    after = float(_respond(law, point((0.0, 0.0, -slow)), mu).after[0, 0])
    return f"of {slow:g} m/s it leaves {after:g} m/s" if abs(after - slow) > 1e-4 * slow else ""


def _difference(one: ImpactResponse, other: Array, words: str) -> str:
    """Compare the velocities after an impact with ``other`` velocities; return a message, "" if they agree.

    ``words`` tells in the message how the other velocities arise.
    """
    if not _apart(one.velocity, other, one.size):
        return ""
    return f"the velocities after are {_list(one.velocity)}, and {_list(other)} {words}"


def _apart(one: Any, other: Any, size: float) -> bool:
    return not np.allclose(one, other, rtol=0.0, atol=_NEAR * size)


def _list(values: Any) -> str:
    return np.array2string(np.asarray(values), precision=6, separator=", ", suppress_small=True).replace("\n", "")


@_PROCESS.claim(_INDENTATION)
def _force(law: ImpactProcess, indentation: float) -> str:
    """The force is zero without indentation and rises with the indentation."""
    force = plain_caller(law.force, "scalar", law.parameters())
    if force(0.0) != 0.0:
        return f"force(0) is {force(0.0):g}"
    for less in (indentation, *_GRID):
        low, high = force(less), force(1.5 * less)
        if not high > low > 0.0:
            return f"force({less:g}) is {low:g} and force({1.5 * less:g}) {high:g}"
    return ""


@_PROCESS.claim(_RATE)
def _efficiency(law: ImpactProcess, drawn: float) -> str:
    """The efficiency (returned part of the stored energy) is 1 if the gap rate is negative, and 0 to 1 otherwise."""
    efficiency = plain_caller(law.efficiency, "scalar", law.parameters())
    for rate in (0.0, drawn, *_GRID):
        if rate > 0.0 and efficiency(-rate) != 1.0:
            return f"efficiency({-rate:g}) is {efficiency(-rate):g}"
        if not 0.0 <= efficiency(rate) <= 1.0:
            return f"efficiency({rate:g}) is {efficiency(rate):g}"
    return ""


@_PROCESS.claim(problem_of(2), _ANY_MU, name="certificate")
def _certificate_of_energies(law: ImpactProcess, p: ImpactProblem, mu: float) -> str:
    """The law accepts the energies that its contacts store and return in an impact computed by the engine."""
    r = respond([law] * 2, [mu] * 2, p)
    size = float(np.max(r.stored, initial=0.0))
    for stored, returned in zip(r.stored.tolist(), r.returned.tolist(), strict=True):
        if not law.is_fulfilled(stored, returned, 1e-7 * size + 1e-12):
            return f"is_fulfilled refuses {returned:g} J back of {stored:g} J"
    return ""


@_PROCESS.claim(_STORED)
def _no_gain_accepted(law: ImpactProcess, stored: float) -> str:
    """The law refuses an impact that returns more energy than was stored."""
    if law.is_fulfilled(stored, 1.01 * stored, 1e-6 * stored):
        return f"is_fulfilled accepts {1.01 * stored:g} J back of {stored:g} J"
    return ""


def _is_alone(law: ImpactLaw) -> bool:
    """True for a law that solves impacts of a single contact only."""
    return isinstance(law, ImpactMap) and law.one_contact


def _map_functions(law: ImpactMap) -> list[CheckedFunction]:
    """Return the function ``impulses`` of an impact map, to be checked with one contact and with two contacts.

    A law of a single contact is checked with one contact only.
    """
    return [_of_contacts(law, 1)] if _is_alone(law) else [_of_contacts(law, 1), _of_contacts(law, 2)]


def _of_contacts(law: ImpactMap, n: int) -> CheckedFunction:
    drawn, words = problem_of(n), f"{n} contact{'s' * (n > 1)}"
    inputs = [(words, _given(drawn.made(case))) for case in draws([drawn], 3)]
    return CheckedFunction(law, "impulses", "map", vectors_of([law] * n, [_OF_FUNCTION] * n), inputs, 3 * n)


def _given(p: ImpactProblem) -> tuple[int, Array, Array]:
    """Return the arguments of the function ``impulses`` for an impact.

    They are the number of contacts, the Delassus matrix row by row, and gap rates with slip velocities before [m/s].
    """
    return p.n, np.ascontiguousarray(p.delassus).ravel(), p.rates


def _impulses(law: ImpactMap, p: ImpactProblem, mu: float, old: float = 0.0) -> Array:
    call = plain_caller(law.impulses, "map", vectors_of([law] * p.n, [mu] * p.n))
    return written(lambda out: call(*_given(p), out), 3 * p.n, old)[: 3 * p.n]


@_MAP.claim(GIVEN, _ANY_MU)
def _writes_its_block(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """The function `impulses` writes every impulse, whatever its output array held before, and nothing beyond it."""
    clean, used = (_impulses(law, p, mu, old) for old in (0.0, OLD))
    return "" if np.allclose(clean, used, rtol=1e-9, atol=1e-12) else "numbers that stood there before are left"


@_MAP.claim(GIVEN, _ANY_MU, name="certificate")
def _certificate_of_impulses(law: ImpactMap, p: ImpactProblem, mu: float) -> str:
    """The law accepts the impulses that it computes; it refuses larger impulses, other friction, and zero impulses."""
    obeying, delassus, before = _impulses(law, p, mu), p.delassus, p.rates
    tolerance = _NEAR * float(np.max(np.abs(before)))
    across = obeying * np.tile([0.0, 1.0, 1.0], p.n)
    wrong = {
        "1.1 times its impulses": 1.1 * obeying,
        "1.2 times its friction": obeying + 0.2 * across,
        "no impulses": 0.0 * obeying,
    }
    # impulses that lead to the same velocities after the impact also obey the law: do not try them as wrong ones
    others = {k: v for k, v in wrong.items() if np.max(np.abs(delassus @ (v - obeying))) > 1e3 * tolerance}
    friction = vectors_of([law] * p.n, [mu] * p.n)["friction"]
    for words, impulses in {"its impulses": obeying, **others}.items():
        is_accepted = law.is_fulfilled(delassus, before, impulses, friction, tolerance)
        if verdict := wrong_verdict(is_accepted, impulses is obeying):
            return f"{verdict} {words}"
    return ""
