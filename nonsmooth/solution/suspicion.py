"""Checks of a run that reached its end: energy account and length of quaternions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.numerics.tolerances import ALLOWED
from nonsmooth.interfaces import Body, Engine
from nonsmooth.parameters import rules
from nonsmooth.solution.energy import EnergyAccount

_MOST = 1e-3
"""Largest unexplained energy that a run may have, however many steps it takes, relative to its scale of energy."""
_REMEDY = "Smaller tolerances tell whether the run can be relied on: EventDriven(tolerance=..., impact_tolerance=...)"
_OF_IMPACTS = 0.1
"""Fraction of the impact tolerance that replaces the step tolerance in the check of the energy account, if larger.

At the default tolerances (impact 1e-8, step 1e-9) both are equal.
"""
_ROUND_OFF = 1e-12
"""Round-off in a difference of potential energies, relative to the potential energy."""


def suspicions(
    engine: Engine,
    worst_event: tuple[float, float, float],
    jump: tuple[float, float],
    added: float,
    energy: EnergyAccount,
    bodies: Mapping[str, Body],
    samples: tuple[NDArray[np.float64], NDArray[np.float64]],
    tolerances: tuple[float, float],
    steps: int,
    scale: float,
    floor: float,
    span: Callable[[], str],
) -> str:
    """Sentences about the checks that a run fails, with a remedy; "" if it passes all.

    Parameters
    ----------
    engine : Engine
        Engine of the run.  If it promises a largest residual of the energy account (:attr:`Engine.promised_residual`),
        a run with a larger residual fails the check.  Otherwise the largest residual follows from the tolerances.
    worst_event : tuple of float
        Event with the largest residual of its energy balance: time [s], this residual [J], and its ratio to the largest
        residual that the tolerances allow.
    jump : tuple of float
        Last time at which a compliant contact began with overlapping bodies [s], and the energy that all contacts
        gained in this way [J].
    added : float
        Energy that sustained friction and averaged normal forces added (:mod:`nonsmooth.solution.checks`) [J], without
        that of friction if a friction law of the system can store energy, because it may return this energy.
    energy : EnergyAccount
        Energy account of the run.
    bodies : mapping of str to Body
        Bodies of the system by name.
    samples : tuple of array
        Times [s] and coordinates of the samples.
    tolerances : tuple of float
        Relative tolerances of a step and of an impact.
    steps : int
        Number of steps.
    scale : float
        Kinetic energy if each velocity had the size of its scale [J].
    floor : float
        Weight times size of the bodies [J].  A residual is compared with it if bodies hardly move.
    span : callable
        Returns a sentence about the time in which the unexplained energy arose.
    """
    promised, name = engine.promised_residual, type(engine).__name__
    if promised is None:
        tolerance, remedy = max(tolerances[0], _OF_IMPACTS * tolerances[1]), _REMEDY
        account, off = open_run(energy, tolerance, steps, scale, floor), ALLOWED * tolerances[0]
    else:
        account, off, remedy = broken_promise(energy, promised, name, floor), promised, _remedy_of(engine)
    given = pushed(added, energy, floor)
    found = open_event(*worst_event), account, given, long_quaternion(bodies, *samples, off)
    said = "; ".join(filter(None, (jumped(*jump, energy, floor), *found)))
    # the sentence of `jumped`, about contacts that began with overlap, has its own remedy
    more = span() if account else "", remedy if any(found) else ""
    return " ".join(filter(None, (f"{said}.", *more))) if said else ""


def _remedy_of(engine: Engine) -> str:
    options = ", ".join(f"{name}=..." for name in rules(type(engine)))
    other = f"one by other options, {type(engine).__name__}({options}), or by" if options else "one by"
    return f"Compare the run with {other} nonsmooth.EventDriven()"


def broken_promise(energy: EnergyAccount, promised: float, name: str, floor: float = 0.0) -> str:
    """Sentence if the residual of the energy account exceeds the largest one that the engine promises, else "".

    ``promised`` is the promised residual, relative to the scale of the account, or to ``floor`` [J] if that is larger.
    ``name`` is the name of the engine.
    """
    potential = max(abs(energy.potential_start), abs(energy.potential_end))
    if energy.unexplained <= promised * max(energy.scale, floor) + _ROUND_OFF * potential:
        return ""
    return (
        f"the energy account of the run is open by {energy.unexplained:.3g} J, {energy.residual:.3g} of what was "
        f"exchanged, of which {name} promises {promised:.3g} at most"
    )


def open_event(time: float, energy: float, share: float) -> str:
    """Sentence about the event with the largest unexplained energy ``energy`` [J]; "" if the tolerances allow it.

    ``share`` is the ratio of this energy to the largest one that the tolerances allow.
    """
    if share <= 1.0:
        return ""
    return (
        f"at the event at t = {time:.9g} s {abs(energy):.3g} J {'appear' if energy > 0.0 else 'vanish'} that no work "
        f"and no loss accounts for, {share:.3g} times what the tolerances explain"
    )


def jumped(time: float, gained: float, energy: EnergyAccount, floor: float = 0.0) -> str:
    """Sentence about compliant contacts that began with overlap and so gained an energy [J], "" if it is negligible."""
    if gained <= _MOST * max(energy.scale, floor):
        return ""
    return (
        f"springs that began inside of bodies, the last one at t = {time:.9g} s, brought {gained:.3g} J that no work "
        "accounts for: bodies so deep in each other jump from feature to feature, stiffer or rounded ones do not"
    )


def pushed(gained: float, energy: EnergyAccount, floor: float = 0.0) -> str:
    """Sentence about contacts that added an energy [J], "" if it is negligible."""
    if gained <= _MOST * max(energy.scale, floor):
        return ""
    return (
        f"contacts brought in {gained:.3g} J, {gained / energy.scale:.3g} of what was exchanged, as averaged forces may"
    )


def open_run(energy: EnergyAccount, tolerance: float, steps: int, scale: float = 0.0, floor: float = 0.0) -> str:
    """Sentence about a run with more unexplained energy than the tolerances allow, else "".

    With the scale E of the account [J] and the relative ``tolerance`` of a step, the allowed energy is the lesser of

        max(1000, steps) tolerance E + steps tolerance sqrt(E scale)    and
        max(1e-3, 1000 tolerance) max(E, floor).

    The term with ``scale`` counts in slow motion: the tolerances are then relative to the scales of the velocities.
    ``scale`` is the kinetic energy [J] if each velocity equals its scale.  Round-off of the potential energy is added.
    """
    slow = steps * tolerance * math.sqrt(energy.scale * scale)
    potential = max(abs(energy.potential_start), abs(energy.potential_end))
    most = max(_MOST, ALLOWED * tolerance) * max(energy.scale, floor)
    explained = min(max(ALLOWED, steps) * tolerance * energy.scale + slow, most) + _ROUND_OFF * potential
    if energy.unexplained <= explained:
        return ""
    part = explained / energy.scale if energy.scale > 0.0 else explained
    return (
        f"the energy account of the run is open by {energy.unexplained:.3g} J, {energy.residual:.3g} of what was "
        f"exchanged, of which the tolerances explain {part:.3g}"
    )


def long_quaternion(
    bodies: Mapping[str, Body], t: NDArray[np.float64], q: NDArray[np.float64], explained: float
) -> str:
    """Sentence about the quaternion whose length differs most from 1 at the samples.

    It is "" if the difference is at most ``explained``.
    """
    most, found, first = explained, "", 0
    for name, body in bodies.items():
        if body.quaternion >= 0 and len(t) > 0:
            start = first + body.quaternion
            four = q[:, start : start + 4]
            off = np.abs(np.sqrt(np.einsum("ij,ij->i", four, four)) - 1.0)
            worst = int(np.argmax(off))
            if off[worst] > most:
                most = float(off[worst])
                found = f"the quaternion of {name!r} is off unit length by {most:.3g} at t = {float(t[worst]):.9g} s"
        first += body.n_q
    return found
