"""Conformance checks of normal laws, rigid and compliant.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.interfaces import CompliantNormalLaw, NormalLaw, RigidNormalLaw
from nonsmooth.problems.contact import solve_contact
from nonsmooth.system.materials import ContactLaws
from nonsmooth.testing.claims import FEWEST, Claims, rows, wrong_verdict
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.functions import CheckedFunction, all_rows, plain_caller
from nonsmooth.testing.inputs import Drawn, DrawnNumber, number
from nonsmooth.testing.outcome import NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.puck import Puck, run
from nonsmooth.testing.reference import ReferenceFriction, followed, point
from nonsmooth.types import Array

_SIZE = number("size", 1e-3, 1e3, 1.0, is_log=True)
_LOAD = number("load", -1e3, 1e3, -1.0)
_TOLERANCE = 1e-9
_DRAWS, _DRAWS_COMPLIANT = 12, 8
_RIGID = Claims()
_DEPTH = number("depth", 1e-2, 1e2, 1.0, is_log=True)
"""Drawn indentation of the contact, relative to the indentation at which the law's force is 1 N at rest."""
_SPEED = number("closing_rate", 1e-3, 10.0, 1.0, is_log=True)
_SHARE = number("share", 0.01, 1.0, 1.0)
_FACTOR = number("factor", 1.001, 3.0, 2.0)
_RATE = number("rate", -1.0, 1.0)
_RATE_BACK = number("rate_back", 0.01, 3.0, 1.0, is_log=True)
_WAVE = Drawn(
    (DrawnNumber("second", -0.4, 0.4), DrawnNumber("phase", -3.1, 3.1)),
    lambda case: _wave(case["second"], case["phase"]),
)
_NEAREST, _FARTHEST = 1e-15, 1e3
"""Bounds between which the indentation under 1 N is searched [m]."""
_PAST = 1e-6
"""Distance past the law's reach at which the force is evaluated [m], because a step of the engine may end there.

The reach is the gap at which the contact opens.
"""
_NOTHING = 1e-9
"""Largest force that is taken as zero [N]."""
_POINTS = 2048
_GAIN = 1e-4
"""Energy that a contact may give off in a cycle, relative to the exchanged energy. It allows for the error with which
the energy is summed over the steps of the cycle."""
_SAME = 1e-6
"""Allowed difference of two integrations of an impact: of the indentation in units of the depth, and of the rate in
units of the approach speed. It is ten times the error of the engine."""
_LONGEST = 30.0
"""Duration of an impact that is integrated by the engine and independently, in units of depth divided by approach
speed. A linear spring rebounds after pi such units; with large damping an impact takes longer."""
_COMPLIANT = Claims()


def check_normal_law(law: NormalLaw) -> list[Property]:
    """Return the properties of a normal law.

    For a rigid law its ``is_fulfilled`` is checked. For a compliant law its force, its ``is_fulfilled`` and the impacts
    of a mass are checked.

    Parameters
    ----------
    law : NormalLaw
        The law, with parameters.
    """
    return properties(law, _compliant_rows if isinstance(law, CompliantNormalLaw) else _rows)


def _rows(law: RigidNormalLaw) -> list[Row]:
    return [*component_rows(law), *rows(_RIGID, lambda: variants(law), _DRAWS)]


@_RIGID.claim(_LOAD)
def _accepts_sustained_contact(law: RigidNormalLaw, load: float) -> str:
    """The law accepts acceleration and force that the engine finds for a closed contact under a load of either sign."""
    p = point((0.0, 0.0, 0.0))
    result = solve_contact(p.mass, p.normal, p.tangential, [0.0, 0.0, load], [ReferenceFriction(0.0)])
    g, force = float(result.contact_acceleration[0, 0]), float(result.normal_force[0])
    if law.is_fulfilled(g, force, _TOLERANCE * abs(load) + _TOLERANCE):
        return ""
    return f"is_fulfilled refuses acceleration {g:g} m/s^2 with force {force:g} N"


def _accepted(law: RigidNormalLaw, acceleration: float, force: float, size: float) -> str:
    """Return a message if a law accepts an acceleration and a force that it must refuse; "" if it refuses them."""
    g, f = acceleration * size, force * size
    if not law.is_fulfilled(g, f, _TOLERANCE * size):
        return ""
    return f"is_fulfilled accepts acceleration {g:g} m/s^2 with force {f:g} N"


@_RIGID.claim(_SIZE)
def _no_penetration(law: RigidNormalLaw, size: float) -> str:
    """The law refuses a closed contact whose bodies accelerate into one another."""
    return _accepted(law, -1.0, 0.0, size)


@_RIGID.claim(_SIZE)
def _no_tension(law: RigidNormalLaw, size: float) -> str:
    """The law refuses a normal force that pulls."""
    return _accepted(law, 0.0, -1.0, size)


@_RIGID.claim(_SIZE)
def _complementarity(law: RigidNormalLaw, size: float) -> str:
    """The law refuses a normal force on a contact that opens."""
    return _accepted(law, 1.0, 1.0, size)


@_RIGID.claim(_SIZE, _LOAD)
def _scaling(law: RigidNormalLaw, size: float, load: float) -> str:
    """The law accepts or refuses an acceleration and a force regardless of their units."""
    for g, f in ((max(load, 0.0), max(-load, 0.0)), (load, 1.0)):
        one, other = (bool(law.is_fulfilled(c * g, c * f, c * _TOLERANCE)) for c in (1.0, size))
        if one is not other:
            return f"is_fulfilled says {one} of ({g:g}, {f:g}) and {other} of {size:g} times that"
    return ""


def _compliant_rows(law: CompliantNormalLaw) -> list[Row]:
    """Return the properties of a compliant normal law: of its force, its ``is_fulfilled`` and the impacts of a mass."""
    found = rows(_COMPLIANT, lambda: variants(law), _DRAWS_COMPLIANT)
    return all_rows(law, lambda: [_force(one) for one in variants(law)], found)


def _force(law: CompliantNormalLaw) -> CheckedFunction:
    # include a gap past the reach, the gap at which the contact opens: a step of the engine may end there before the
    # engine locates the opening
    places = (0.0, 1e-300, *np.geomspace(1e-12, 1e-1, 6).tolist(), -_PAST - max(law.reach, 0.0))
    if 0.0 < law.reach < math.inf:
        places += (-0.5 * law.reach, -law.reach)
    given = itertools.product(places, (0.0, -3.0, 1e-6, 3.0), (0.0, 1.0))
    inputs = [(f"{x:g}, {rate:g}, {first:g}", (x, rate, first)) for x, rate, first in given]
    return CheckedFunction(law, "force", "compliance", law.parameters(), inputs)


def _plain(law: CompliantNormalLaw) -> Callable[..., Any]:
    return plain_caller(law.force, "compliance", law.parameters())


def _unit(law: CompliantNormalLaw) -> float:
    """Return the indentation under 1 N at rest [m]; NaN if the force stays below 1 N."""
    force, low, high = _plain(law), math.log(_NEAREST), math.log(_FARTHEST)
    if force(_FARTHEST, 0.0, 1.0) < 1.0:
        return math.nan
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if force(math.exp(middle), 0.0, 1.0) >= 1.0 else (middle, high)
    return math.exp(high)


def _depth(law: CompliantNormalLaw, depth: float) -> float:
    """Return an indentation [m] that is given in units of the indentation under 1 N."""
    unit = _unit(law)
    if not math.isfinite(unit):
        raise NotChecked(f"not checked, as its force at rest does not come to 1 N within {_FARTHEST:g} m")
    return unit * depth


@_COMPLIANT.claim()
def _reach(law: CompliantNormalLaw) -> str:
    """The reach, the gap at which the contact opens, is finite and not negative."""
    return "" if 0.0 <= law.reach < math.inf else f"it is {law.reach:g} m"


@_COMPLIANT.claim(_SPEED)
def _nothing_at_zero(law: CompliantNormalLaw, speed: float) -> str:
    """Without indentation and without a rate of indentation, the force is zero."""
    force = _plain(law)(0.0, 0.0, speed)
    return f"the force is {force:g} N" if abs(force) > _NOTHING else ""


@_COMPLIANT.claim(_DEPTH, _FACTOR, _SPEED, n_inputs=24)
def _rises(law: CompliantNormalLaw, depth: float, factor: float, speed: float) -> str:
    """At rest the force never falls as the indentation rises, and at some indentation it reaches 1 N."""
    unit, force = _unit(law), _plain(law)
    if not math.isfinite(unit) and _pulling(law, speed):
        raise NotChecked("not checked, as it pulls where it is pressed")
    if not math.isfinite(unit):
        return f"it is {force(_FARTHEST, 0.0, speed):g} N at {_FARTHEST:g} m"
    x, deeper = depth * unit, factor * depth * unit
    less, more = force(x, 0.0, speed), force(deeper, 0.0, speed)
    if more < less - _NOTHING * (1.0 + abs(less)):
        return f"it is {less:g} N at {x:g} m and {more:g} N at {deeper:g} m"
    return ""


def _pulling(law: CompliantNormalLaw, speed: float) -> str:
    """Return a message if the force pulls at the largest indentation that is tried; "" if it does not pull."""
    force = _plain(law)(_FARTHEST, 0.0, speed)
    if force >= 0.0:
        return ""
    return f"it is {force:g} N at an indentation of {_FARTHEST:g} m, and a negative force pulls: it has the wrong sign"


@_COMPLIANT.claim(_DEPTH, _SHARE, _SPEED)
def _pulls_within_its_reach(law: CompliantNormalLaw, depth: float, share: float, speed: float) -> str:
    """At rest the force never pushes while there is a gap, and never pulls while there is an indentation."""
    if not math.isfinite(_unit(law)) and (found := _pulling(law, speed)):
        return found
    inside, gap = _depth(law, depth), share * law.reach
    pressed = _plain(law)(inside, 0.0, speed)
    if pressed < -_NOTHING:
        return f"at {inside:g} m it pulls with {-pressed:g} N"
    apart = _plain(law)(-gap, 0.0, speed) if gap > 0.0 else 0.0
    return f"across a gap of {gap:g} m it pushes with {apart:g} N" if apart > _NOTHING else ""


def _wave(second: float, phase: float) -> Array:
    """Return one period of a varying indentation, as values between 0 and 1, shape [_POINTS + 1].

    It is the sum of two sines, shifted and scaled. The check of dissipation moves a contact along it and back.
    The second sine has twice the frequency, the amplitude ``second`` and the phase ``phase`` [rad].
    """
    angle = np.linspace(0.0, 2.0 * math.pi, _POINTS + 1)
    wave = np.sin(angle) + second * np.sin(2.0 * angle + phase)
    return np.asarray((wave - np.min(wave)) / np.ptp(wave))


@_COMPLIANT.claim(_DEPTH, _SPEED, _RATE_BACK, _WAVE)
def _dissipation(law: CompliantNormalLaw, drawn: float, speed: float, rate_back: float, wave: Array) -> str:
    """The force adds no energy in a closed cycle of the indentation, and no energy in an impact."""
    depth = _depth(law, drawn)
    span, quarter = depth + law.reach, np.linspace(0.0, 0.5 * math.pi, _POINTS + 1)
    inward, outward = depth * np.sin(quarter), -law.reach + span * np.cos(quarter)
    strokes = {
        "a closed cycle": [(-law.reach + span * wave, speed)],
        "an impact": [(inward, speed), (outward, rate_back * speed)],
    }
    for words, parts in strokes.items():
        powers = np.concatenate([_energies(law, x, fastest, speed) for x, fastest in parts])
        taken, exchanged = float(np.sum(powers)), float(np.sum(np.abs(powers)))
        if taken < -_GAIN * exchanged:
            return f"{words} down to {depth:g} m gives {-taken:g} J, of {exchanged:g} J that go to and fro"
    return ""


def _energies(law: CompliantNormalLaw, x: Array, fastest: float, closing_rate: float) -> Array:
    """Return the energy that the contact absorbs in every step of a motion through the indentations ``x`` [J].

    The largest rate of the motion is ``fastest`` [m/s].
    """
    steps = np.diff(x)
    rates = steps * (fastest / np.max(np.abs(steps)))
    force, middles = _plain(law), 0.5 * (x[1:] + x[:-1])
    forces = [force(float(a), float(b), closing_rate) for a, b in zip(middles, rates, strict=True)]
    return np.asarray(forces * steps)


@_COMPLIANT.claim(_DEPTH, _SPEED, _RATE)
def _certificate(law: CompliantNormalLaw, depth: float, speed: float, share: float) -> str:
    """The law accepts the normal force that it computes, and refuses a force that differs by a hundredth."""
    x, rate = _depth(law, depth), share * speed
    force = _plain(law)(x, rate, speed)
    off = 0.01 * abs(force) + _NOTHING
    for given, expected in ((force, True), (force + off, False), (force - off, False)):
        if verdict := wrong_verdict(law.is_fulfilled(x, rate, speed, given, 0.1 * off), expected):
            return f"{verdict} {given:g} N at {x:g} m and {rate:g} m/s, where the law has {force:g} N"
    return ""


@_COMPLIANT.claim(_DEPTH, _SPEED, fewest=FEWEST)
def _impact(law: CompliantNormalLaw, drawn: float, speed: float) -> str:
    """In an impact, a mass moves in the engine as in an independent integration of m x'' = -F(x, x')."""
    depth, force = _depth(law, drawn), _plain(law)
    # the mass m is chosen so that the impact reaches about ``depth``: m v^2 = F depth. F is the largest of the forces
    # at small and at full indentation, at rest and at the approach speed v
    load = max(abs(force(x, rate, speed)) for x in (1e-9 * depth, depth) for rate in (0.0, speed))
    mass, unit = load * depth / speed**2, depth / speed

    def slope(y: Array) -> Array:
        """Return the rates in units of depth and speed; without a force once the contact has opened."""
        x, rate = float(y[0]), float(y[1])
        return np.array([rate, -force(depth * x, speed * rate, speed) / load if depth * x >= -law.reach else 0.0])

    x, rate = followed(slope, np.array([0.0, 1.0]), np.ones(2), [_LONGEST])[-1]
    puck, u = Puck(mass, mass * depth**2, length=depth, speed=speed), (0.0, 0.0, -speed, 0.0, 0.0, 0.0)
    solution = run(puck, depth, u, ContactLaws(law, ReferenceFriction(0.0)), (1.0 + _LONGEST) * unit)
    given = -float(solution.q_end[2]) / depth, -float(solution.u_end[2]) / speed
    if abs(given[1] - rate) <= _SAME and abs(given[0] - x) <= _SAME * max(1.0, abs(x)):
        return ""
    return (
        f"{_LONGEST * unit:g} s after it has struck with {speed:g} m/s, a mass of {mass:g} kg is "
        f"{given[0] * depth:.9g} m in, at {given[1] * speed:.9g} m/s; "
        f"by an independent integration {x * depth:.9g} m, at {rate * speed:.9g} m/s"
    )
