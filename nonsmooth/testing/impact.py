"""Properties of impact laws, processes and maps alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.testing.callers import plain_caller
from nonsmooth.testing.component import accepted, component_rows, numbers_of, variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.functions import Function, Functions, scalar_function
from nonsmooth.testing.impact_map import is_alone, map_function, map_rows
from nonsmooth.testing.impact_process import process_rows
from nonsmooth.testing.property import Broken, NotChecked, Property, Row, properties
from nonsmooth.testing.reference import Problem, point, problem, problem_space
from nonsmooth.testing.respond import Response, respond

_ONE, _TWO = problem_space(1), problem_space(2)
_MU = Variable("friction", 0.02, 0.6, 0.2)
_ROUGH = Variable("friction", 0.02, 1.2, 0.2)
_DRAWS = 10
_AFTER = "the velocities after are"
_NEAR = 1e-6
"""Agreement of velocities after impacts that should be the same, relative to the largest."""
_INDENTATIONS = (0.0, *np.geomspace(1e-9, 1e2, 12).tolist())
_RATES = (*(-np.geomspace(1e-9, 1e2, 6)).tolist(), 0.0, *np.geomspace(1e-9, 1e2, 12).tolist())


def check_impact_law(law: ImpactLaw, *, restitution: str = "restitution") -> list[Property]:
    """Return the properties of an impact law.

    Parameters
    ----------
    law : ImpactLaw
        The law, with parameters.
    restitution : str
        Its parameter, between 0 and 1, with which it goes from the plastic impact to that which gives back all; the two
        limits are not looked at if it has none of that name.
    """
    functions = Functions(lambda: [f for one in variants(law) for f in _functions(one)])

    def row(name: str, says: str, trial: Trial, space: Sequence[Variable]) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=FEWEST)

    def limit(name: str, value: float, trial: Trial) -> None:
        at = accepted(law, **{restitution: value}) if restitution in numbers_of(law) else None
        if restitution in numbers_of(law) and at is None:
            raise Broken("the limit is refused", restitution, value)
        if at is None:
            raise NotChecked(f"{type(law).__name__}: it has no parameter {restitution!r}")
        examine(name, [at], [Variable("speed", 1e-2, 1e2, 1.0, log=True), _MU], trial, _DRAWS)

    one, two = _ONE, _ONE if is_alone(law) else _TWO
    speed = Variable("factor", 1e-2, 1e2, 2.0, log=True)
    rows = [
        row("no approach after", "after the impact no contact approaches", _parts, [*two, _MU]),
        row(
            "cone",
            "normal impulses push, tangential ones lie in the cone of the friction coefficient",
            _cone,
            [*two, _MU],
        ),
        row("dissipation", "without friction no impact of approaching contacts gains energy", _dissipates, two),
        row("dissipation with friction", "nor does one with friction", _dissipates_rough, [*two, _ROUGH]),
        row("scaling of masses", "masses times c: the same velocities, impulses times c", _masses, [*one, _MU, speed]),
        row("scaling of velocities", "velocities times c before: times c after", _velocities, [*two, _MU, speed]),
        row(
            "frame invariance",
            "turning the tangents of the contacts changes no velocity",
            _turned,
            [*two, _MU, Variable("turn", -3.1, 3.1, 1.0)],
        ),
        row(
            "permutation",
            "the order of the contacts does not matter",
            _permuted,
            [*two, _MU, Variable("other_friction", 0.02, 0.6, 0.4)],
        ),
        row("limit mu -> 0", "without friction no tangential impulse; with next to none, next to none", _smooth, two),
        row(
            "force and impact level",
            "an impact too slight to end the slip rubs as sustained contact does",
            _levels,
            [_MU, Variable("heading", -3.1, 3.1)],
        ),
        ("contact time", "the contact time is a finite number >= 0", lambda: _contact_times(law)),
    ]
    if isinstance(law, ImpactProcess):
        rows += process_rows(law)
    if isinstance(law, ImpactMap):
        rows += map_rows(law)
    rows += [
        ("limit e -> 0", "without restitution the bodies do not part", lambda: limit("limit e -> 0", 0.0, _plastic)),
        (
            "limit e -> 1",
            "with full restitution a slow impact gives back all",
            lambda: limit("limit e -> 1", 1.0, _elastic),
        ),
    ]
    return properties(law, [*component_rows(law), *functions.rows(), *functions.guarded(rows)])


def _functions(law: ImpactLaw) -> list[Function]:
    if isinstance(law, ImpactProcess):
        return [
            scalar_function(law, "force", law.force, _INDENTATIONS, law.parameters()),
            scalar_function(law, "efficiency", law.efficiency, _RATES, law.parameters()),
        ]
    return [map_function(law)] if isinstance(law, ImpactMap) else []


def _respond(law: ImpactLaw, p: Problem, mu: float) -> Response:
    return respond([law] * p.n, [mu] * p.n, p)


def _problem(case: Case) -> Problem:
    return problem(case, 2 if "arm_x_2" in case else 1)


def _parts(law: ImpactLaw, case: Case) -> str:
    r = _respond(law, _problem(case), case["friction"])
    least = float(np.min(r.after[:, 0]))
    return f"a gap closes at {-least:g} m/s afterwards" if least < -1e-7 * r.size else ""


def _cone(law: ImpactLaw, case: Case) -> str:
    r, mu = _respond(law, _problem(case), case["friction"]), case["friction"]
    small = 1e-8 * r.size
    for normal, *across in r.impulse:
        if normal < -small:
            return f"a contact pulls with {-normal:g} N s"
        if math.hypot(*across) > mu * normal + small:
            return f"the impulse {math.hypot(*across):g} N s across leaves the cone of {normal:g} N s along"
    return ""


def _dissipates(law: ImpactLaw, case: Case) -> str:
    p, mu = _problem(case), case.get("friction", 0.0)
    r = _respond(law, p, mu)
    if np.any(r.before[:, 0] > 0.0):
        return ""
    gain = p.energy(r.velocity) - p.energy(p.velocity)
    return f"the kinetic energy rises by {gain:g} J" if gain > 1e-7 * r.size**2 else ""


def _dissipates_rough(law: ImpactLaw, case: Case) -> str:
    # one contact alone too, with slip in and against the lean of the body
    one = {name: value for name, value in case.items() if not name.endswith("_2")}
    return (
        _dissipates(law, one) or _dissipates(law, one | {"velocity_x": -case["velocity_x"]}) or _dissipates(law, case)
    )


def _masses(law: ImpactLaw, case: Case) -> str:
    p, c = _problem(case), case["factor"]
    heavy = Problem(c * p.mass, p.normal, p.tangential, p.velocity)
    one, other = (_respond(law, q, case["friction"]) for q in (p, heavy))
    if _apart(one.velocity, other.velocity, one.size):
        return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} with {c:g} times the mass"
    return "impulses are not proportional" if _apart(c * one.impulse, other.impulse, c * one.size) else ""


def _velocities(law: ImpactLaw, case: Case) -> str:
    if isinstance(law, ImpactProcess) and not _homogeneous(law):
        raise NotChecked(f"{type(law).__name__}: its force is no power or its efficiency depends on the rate")
    p, c = _problem(case), case["factor"]
    fast = Problem(p.mass, p.normal, p.tangential, c * p.velocity)
    one, other = (_respond(law, q, case["friction"]) for q in (p, fast))
    if _apart(c * one.velocity, other.velocity, c * one.size):
        return (
            f"{_AFTER} {_list(one.velocity)}, and of {c:g} times those before {_list(other.velocity / c)} times {c:g}"
        )
    return ""


def _homogeneous(law: ImpactProcess) -> bool:
    offered = law.parameters()
    force = plain_caller(law.force, "scalar", offered)
    efficiency = plain_caller(law.efficiency, "scalar", offered)
    powers = [math.log(force(2.0 * x) / force(x)) for x in (1e-4, 1e-2, 1.0)]
    shares = [efficiency(rate) for rate in _RATES if rate > 0.0]
    return max(powers) - min(powers) < 1e-9 and max(shares) - min(shares) < 1e-12


def _turned(law: ImpactLaw, case: Case) -> str:
    p = _problem(case)
    c, s = math.cos(case["turn"]), math.sin(case["turn"])
    turned = p.tangential @ np.array([[c, -s], [s, c]])
    one = _respond(law, p, case["friction"])
    other = _respond(law, Problem(p.mass, p.normal, turned, p.velocity), case["friction"])
    if _apart(one.velocity, other.velocity, one.size):
        turn = f"in tangents turned by {case['turn']:g} rad"
        return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} {turn}"
    return ""


def _permuted(law: ImpactLaw, case: Case) -> str:
    if is_alone(law):
        raise NotChecked(f"{type(law).__name__}: it is a law of one contact")
    p, mu = _problem(case), (case["friction"], case["other_friction"])
    swapped = Problem(p.mass, p.normal[:, ::-1].copy(), p.tangential[:, ::-1].copy(), p.velocity)
    one, other = respond([law] * 2, mu, p), respond([law] * 2, mu[::-1], swapped)
    if _apart(one.velocity, other.velocity, one.size):
        return f"{_AFTER} {_list(one.velocity)}, and {_list(other.velocity)} in the other order"
    return ""


def _smooth(law: ImpactLaw, case: Case) -> str:
    p = _problem(case)
    for mu in (0.0, 1e-8):
        r = _respond(law, p, mu)
        across = float(np.max(np.abs(r.impulse[:, 1:])))
        if across > mu * float(np.max(r.impulse[:, 0])) + 1e-9 * r.size:
            return f"with the coefficient {mu:g} the tangential impulse is {across:g} N s"
    return ""


def _levels(law: ImpactLaw, case: Case) -> str:
    c, s = math.cos(case["heading"]), math.sin(case["heading"])
    r = _respond(law, point((c, s, -1e-4)), case["friction"])
    ratio = r.impulse[0, 1:] / r.impulse[0, 0]
    expected = -case["friction"] * np.array([c, s])
    if np.max(np.abs(ratio - expected)) > 1e-6:
        return f"impulses have the ratio {_list(ratio)}, sliding friction has {_list(expected)}"
    return ""


def _contact_times(law: ImpactLaw) -> None:
    for one in variants(law):
        if not (math.isfinite(one.contact_time) and one.contact_time >= 0.0):
            raise Broken("it is not a finite number >= 0 [s]", "contact_time", one.contact_time)


def _plastic(law: ImpactLaw, case: Case) -> str:
    r = _respond(law, point((0.0, 0.0, -case["speed"])), case["friction"])
    return f"it leaves at {r.after[0, 0]:g} m/s" if abs(r.after[0, 0]) > _NEAR * case["speed"] else ""


def _elastic(law: ImpactLaw, case: Case) -> str:
    slow = 1e-9 * case["speed"]
    after = float(_respond(law, point((0.0, 0.0, -slow)), case["friction"]).after[0, 0])
    return f"of {slow:g} m/s it leaves {after:g} m/s" if abs(after - slow) > 1e-4 * slow else ""


def _apart(one: Any, other: Any, size: float) -> bool:
    return not np.allclose(one, other, rtol=0.0, atol=_NEAR * size)


def _list(values: Any) -> str:
    return np.array2string(np.asarray(values), precision=6, separator=", ", suppress_small=True).replace("\n", "")
