"""Properties of the dynamics of a body: mass, energy, momentum, and a short run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.runs.simulate import simulate
from nonsmooth.system.system import System
from nonsmooth.testing import block
from nonsmooth.testing.block import OBLIQUE, WEIGHTLESS, Block, state, state_space, written
from nonsmooth.testing.draws import Case
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.property import Broken, NotChecked, Row

Array = NDArray[np.float64]
_DRAWS = 12
_STEP = 1e-3
_SAME = 1e-6
_FALLS = 20


def free_rows(body: Body) -> list[Row]:
    """Return the properties of a body with coordinates."""

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: examine(name, [body], state_space(body), trial, _DRAWS)

    rows = [
        row("mass matrix", "M is symmetric and positive definite", _mass),
        row("kinetic energy", "it is u . M u / 2", _kinetic),
        row("energy in free flight", "kinetic and potential energy change by nothing else than each other", _conserved),
        ("free flight", "a short run of the body alone closes its energy account", lambda: _check_flight(body)),
    ]
    if body.quaternion >= 0:
        row_of_quaternion = row("unit quaternion", "the rates of a unit quaternion keep its length", _unit)
        rows.append(row_of_quaternion)
    if body.spin >= 0:
        rows.append(row("spin", "its quaternion's rates are half the product with (0, spin)", _spun))
    if body.n_u == 6 and len(body.frames) == 1:
        rows.append(row("momentum", "without gravity momentum and angular momentum stay, in free flight", _momentum))
    return rows


def _look(body: Body, t: float, q: Array, u: Array, gravity: Mapping[str, float] = OBLIQUE) -> Block:
    return Block(body, written(body, block.compiled(body, gravity), t, q, u))


def _mass(body: Body, case: Case) -> str:
    inverse = _look(body, *state(body, case)).inverse
    # entries may have different units: they are judged by their diagonals
    size = np.sqrt(np.abs(np.diag(inverse)))
    if not np.all(size > 0.0):
        return f"the diagonal of M^-1 is {np.diag(inverse).tolist()}"
    scaled = inverse / np.outer(size, size)
    if np.max(np.abs(scaled - scaled.T)) > 1e-12:
        return f"M^-1 is not symmetric: {inverse.tolist()}"
    least = float(np.linalg.eigvalsh(scaled)[0])
    return f"M^-1 is not positive definite: {inverse.tolist()}" if least <= 1e-14 else ""


def _kinetic(body: Body, case: Case) -> str:
    t, q, u = state(body, case)
    here = _look(body, t, q, u)
    expected = 0.5 * float(u @ np.linalg.solve(here.inverse, u))
    given = float(here.energy[0])
    return (
        f"it is {given:g} J, u . M u / 2 is {expected:g} J" if abs(given - expected) > 1e-8 * expected + 1e-300 else ""
    )


def _along(
    body: Body, case: Case, gravity: Mapping[str, float], value: Callable[[Block, Array, Array], Array]
) -> Array:
    """Return the derivative in time of a value along the free motion, at fixed time of prescribed changes."""
    t, q, u = state(body, case)
    here = _look(body, t, q, u, gravity)
    acceleration = here.inverse @ here.force
    q_scale, u_scale = body.scales
    speed = max(float(np.max(np.abs(here.rates) / q_scale)), float(np.max(np.abs(acceleration) / u_scale)), 1e-3)
    dt = _STEP / speed

    def at(i: int) -> Array:
        # straight lines: only the first derivative is asked for
        moved, faster = q + i * dt * here.rates, u + i * dt * acceleration
        return np.array(value(_look(body, t, moved, faster, gravity), moved, faster))

    one, two, four = ((at(i) - at(-i)) / (2.0 * i * dt) for i in (1, 2, 4))
    # two steps of Richardson's extrapolation
    first, second = (4.0 * one - two) / 3.0, (4.0 * two - four) / 3.0
    return np.asarray((16.0 * first - second) / 15.0)


def _conserved(body: Body, case: Case) -> str:
    rates = _along(body, case, OBLIQUE, lambda b, q, u: b.energy)
    t, q, u = state(body, case)
    here = _look(body, t, q, u)
    size = (
        float(np.sum(np.abs(rates))) + float(np.abs(u) @ np.abs(here.force)) + 1e-9 * float(np.sum(np.abs(here.energy)))
    )
    if abs(float(np.sum(rates))) > _SAME * size:
        return f"the kinetic energy changes by {rates[0]:g} W, the potential by {rates[1]:g} W"
    return ""


def _unit(body: Body, case: Case) -> str:
    t, q, u = state(body, case)
    at = slice(body.quaternion, body.quaternion + 4)
    rates = _look(body, t, q, u).rates[at]
    change = float(q[at] @ rates)
    return f"its length changes at {change:g} 1/s" if abs(change) > 1e-9 * float(np.linalg.norm(rates)) else ""


def _spun(body: Body, case: Case) -> str:
    t, q, u = state(body, case)
    (a, *axis), spin = q[body.quaternion : body.quaternion + 4], u[body.spin : body.spin + 3]
    expected = 0.5 * np.append(-np.dot(axis, spin), a * spin + np.cross(axis, spin))
    rates = _look(body, t, q, u).rates[body.quaternion : body.quaternion + 4]
    wrong = float(np.max(np.abs(rates - expected)))
    return f"they are {rates.tolist()}" if wrong > 1e-9 * float(np.linalg.norm(spin)) else ""


def _momentum(body: Body, case: Case) -> str:
    def value(b: Block, q: Array, u: Array) -> Array:
        frame, mass = b.frame(0), np.linalg.inv(b.inverse)
        # M u = J^T (p, L), L about the origin of the frame
        wrench = np.linalg.solve(b.jacobian(0).T, mass @ u)
        return np.append(wrench[:3], wrench[3:] + np.cross(frame[:3], wrench[:3]))

    t, q, u = state(body, case)
    here = _look(body, t, q, u, WEIGHTLESS)
    if abs(np.linalg.det(here.jacobian(0))) < 1e-12:
        raise NotChecked(f"{type(body).__name__}: its frame does not move freely")
    change = _along(body, case, WEIGHTLESS, value)
    total = value(here, q, u)
    speed = max(float(np.max(np.abs(here.rates) / body.scales[0])), 1e-3)
    for name, part in (("momentum", slice(0, 3)), ("angular momentum", slice(3, 6))):
        if np.max(np.abs(change[part])) > _SAME * speed * float(np.max(np.abs(total[part]))):
            return f"the {name} {total[part].tolist()} changes by {change[part].tolist()} per second"
    return ""


def _check_flight(body: Body) -> None:
    case = {variable.name: 0.4 * variable.high for variable in state_space(body)}
    _, q, u = state(body, case | {"t": 0.0})
    system = System([body], gravity=9.81)
    system.set_start(body, q, u)
    rates = np.abs(_look(body, 0.0, q, u).rates) / body.scales[0]
    duration = min(_FALLS / max(float(np.max(rates)), 1e-3), 1.0)
    solution = simulate(system, duration, sample_interval=duration)
    residual = solution.energy.residual
    if not (math.isfinite(residual) and residual <= 1e-7):
        raise Broken(f"after {duration:g} s the account leaves {residual:g} of the energy unexplained")
