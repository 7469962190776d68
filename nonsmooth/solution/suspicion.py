"""Checks of a run that reached its end: energy account and length of quaternions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body, Engine
from nonsmooth.parameters import rules
from nonsmooth.solution.energy import EnergyAccount

_EXPLAINED = 1e3
"""Largest sum of residuals of steps and impacts that tolerances explain, in tolerances; or one for each step."""
_MOST = 1e-3
"""Part of the energy exchanged by which no account may be open, however many steps there were."""
_REMEDY = "Smaller tolerances tell whether the run can be relied on: EventDriven(tolerance=..., impact_tolerance=...)"
_OF_IMPACTS = 0.1
"""Part of the tolerance of impacts that adds up like that of steps."""
_ROUND_OFF = 1e-12
"""Part of the potential energy that its difference does not tell from none."""


def suspicions(
    engine: Engine,
    worst_event: tuple[float, float, float],
    jump: tuple[float, float],
    rubbed: float,
    energy: EnergyAccount,
    bodies: Mapping[str, Body],
    samples: tuple[NDArray[np.float64], NDArray[np.float64]],
    tolerances: tuple[float, float],
    steps: int,
    scale: float,
    floor: float,
    span: Callable[[], str],
) -> str:
    """Sentence about the check that a run fails, "" if it passes all.

    ``engine`` is what integrated it; what it promises takes the place of what tolerances explain.
    ``worst_event`` has time [s], energy [J] and share of what is explained, ``jump`` time [s] of the last spring that
    began inside of a body and the energy [J] that springs gained so; ``rubbed`` is what friction brought in where no
    law stores it [J]; ``bodies`` are those of the system by name;
    ``samples`` t and q; ``tolerances`` are those of a step and of an impact, ``steps`` their number; ``scale`` is
    the kinetic energy of velocities as large as their scales [J], ``floor`` an energy of which the bodies exchange a
    part where they hardly move, as weight times size [J].  ``span`` returns a sentence on when an open account of the
    run came about.
    """
    promised, name = engine.promised_residual, type(engine).__name__
    if promised is None:
        tolerance, remedy = max(tolerances[0], _OF_IMPACTS * tolerances[1]), _REMEDY
        account, off = open_run(energy, tolerance, steps, scale, floor), _EXPLAINED * tolerances[0]
    else:
        account, off, remedy = broken_promise(energy, promised, name, floor), promised, _remedy_of(engine)
    given = pushed(rubbed, energy, floor)
    found = open_event(*worst_event), account, given, long_quaternion(bodies, *samples, off)
    said = "; ".join(filter(None, (jumped(*jump, energy, floor), *found)))
    # what springs gain in jumps names a remedy of its own
    more = span() if account else "", remedy if any(found) else ""
    return " ".join(filter(None, (f"{said}.", *more))) if said else ""


def _remedy_of(engine: Engine) -> str:
    options = ", ".join(f"{name}=..." for name in rules(type(engine)))
    other = f"one by other options, {type(engine).__name__}({options}), or by" if options else "one by"
    return f"Compare the run with {other} nonsmooth.EventDriven()"


def broken_promise(energy: EnergyAccount, promised: float, name: str, floor: float = 0.0) -> str:
    """Sentence about the energy account of a run by an engine that promises a residual, "" if it is closed.

    The residual counts in parts of what is exchanged, or of ``floor`` [J] where that is more.
    """
    potential = max(abs(energy.potential_start), abs(energy.potential_end))
    if energy.unexplained <= promised * max(energy.scale, floor) + _ROUND_OFF * potential:
        return ""
    return (
        f"the energy account of the run is open by {energy.unexplained:.3g} J, {energy.residual:.3g} of what was "
        f"exchanged, of which {name} promises {promised:.3g} at most"
    )


def open_event(time: float, energy: float, share: float) -> str:
    """Sentence about the event with the largest residual: ``share`` of the residual that tolerances explain, or ""."""
    if share <= 1.0:
        return ""
    return (
        f"at the event at t = {time:.9g} s {abs(energy):.3g} J {'appear' if energy > 0.0 else 'vanish'} that no work "
        f"and no loss accounts for, {share:.3g} times what the tolerances explain"
    )


def jumped(time: float, gained: float, energy: EnergyAccount, floor: float = 0.0) -> str:
    """Sentence about springs that began inside of bodies and gained an energy [J], or ""."""
    if gained <= _MOST * max(energy.scale, floor):
        return ""
    return (
        f"springs that began inside of bodies, the last one at t = {time:.9g} s, brought {gained:.3g} J that no work "
        "accounts for: bodies so deep in each other jump from feature to feature, stiffer or rounded ones do not"
    )


def pushed(gained: float, energy: EnergyAccount, floor: float = 0.0) -> str:
    """Sentence about friction that added an energy [J], or ""."""
    if gained <= _MOST * max(energy.scale, floor):
        return ""
    return (
        f"friction brought in {gained:.3g} J, {gained / energy.scale:.3g} of what was exchanged, as averaged forces may"
    )


def open_run(energy: EnergyAccount, tolerance: float, steps: int, scale: float = 0.0, floor: float = 0.0) -> str:
    """Sentence about the energy account of a run of a number of steps of a relative tolerance, or "".

    Of slow motion the tolerance is a part of the scale of velocities, which have the kinetic energy ``scale`` [J].  In
    all no more is explained than a thousandth of what is exchanged, or of ``floor`` [J] where that is more; an engine
    with larger tolerances promises less, a thousand of them.
    """
    slow = steps * tolerance * math.sqrt(energy.scale * scale)
    potential = max(abs(energy.potential_start), abs(energy.potential_end))
    most = max(_MOST, _EXPLAINED * tolerance) * max(energy.scale, floor)
    explained = min(max(_EXPLAINED, steps) * tolerance * energy.scale + slow, most) + _ROUND_OFF * potential
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
    """Sentence about the quaternion whose length differs most from 1 at the samples, "" if round-off explains it."""
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
