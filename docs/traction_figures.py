"""Figures of friction by direction, by history, by bristles and by turning."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from law_axes import DOTS, GREY, Falling, make_axes
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import laws
import nonsmooth as ns
from nonsmooth.bodies import Ball, Plate

_G, _RADIUS = 9.81, 0.01
_MASS = Ball(_RADIUS).total_mass
_STIFFNESS = 1e9


def _ball(contact: Mapping[str, Any], t_end: float, velocity: Any, spin: float = 0.0) -> ns.Solution:
    """Run a ball that lies on a plate, at first without rolling."""
    plate, ball = Plate(), Ball(_RADIUS)
    system = ns.System([plate, ball], _G)
    system.contact(plate, ball, **contact)
    depth = 0.0 if "impact" in contact else (_MASS * _G / _STIFFNESS) ** (2.0 / 3.0)
    system.place(
        ball, position=(0.0, 0.0, _RADIUS - depth), velocity=(*velocity, 0.0), angular_velocity=(0.0, 0.0, spin)
    )
    return ns.simulate(system, t_end, sample_interval=t_end / 400.0)


def _soft(friction: Any) -> dict[str, Any]:
    return {"normal": laws.HuntCrossley(_STIFFNESS, 1.0), "friction": friction}


def _force(law: Any, slip: np.ndarray) -> np.ndarray:
    """Return friction over normal force, along the axis and across it."""
    forward, backward, across = law.ratios
    ratios = np.array([forward if slip[0] > 0.0 else backward, across])
    counted = ratios * slip
    return np.asarray(-law.parameters()["strongest"] * ratios * counted / np.linalg.norm(counted))


def _by_direction(law: Any, title: str) -> Any:
    """Draw the bound with slips normal to it, and the slip of balls until they roll."""
    figure, (left, right) = make_axes(title, 2)
    angles = np.linspace(0.0, 2.0 * math.pi, 361)
    bound = np.array([_force(law, np.array([math.cos(a), math.sin(a)])) for a in angles])
    left.plot(*bound.T, color="black")
    for angle in np.arange(0.2, 2.0 * math.pi, math.pi / 6.0):
        slip = np.array([math.cos(angle), math.sin(angle)])
        force = _force(law, slip)
        left.annotate(
            "",
            force - 0.2 * slip,
            force,
            arrowprops={"arrowstyle": "->", "color": "tab:red", "shrinkA": 0, "shrinkB": 0},
        )
        left.plot(*force, **DOTS | {"markersize": 3})
    left.set_aspect("equal")
    left.set_xlim(-0.75, 0.75)
    left.set_ylim(-0.75, 0.75)
    left.set_xlabel("friction / normal force, along")
    left.set_ylabel("across")
    left.text(0.03, 0.03, "arrows: against the slip", transform=left.transAxes, fontsize=8, color="tab:red")
    left.set_xticks([-0.5, 0.0, 0.5])
    left.set_yticks([-0.5, 0.0, 0.5])
    rigid = {"normal": laws.Unilateral(), "impact": laws.EnergeticImpact(0.0), "friction": law}
    t_end, speed = 0.1, 0.5
    rolls = Falling(lambda t, slip: np.linalg.norm(slip) - 0.01)
    for heading, look in ((0.5, "-"), (1.2, "--"), (2.6, ":")):
        start = speed * np.array([math.cos(heading), math.sin(heading)])
        right.plot(*_slips(_ball(rigid, t_end, start)), color="black", linestyle=look)
        found = solve_ivp(
            lambda t, v: 3.5 * _G * _force(law, v), (0.0, t_end), start, events=rolls, dense_output=True, rtol=1e-9
        )
        slip = found.sol(found.t[-1] * np.linspace(0.0, 1.0, 12))
        right.plot(*slip, label="integrated" if look == "-" else None, **DOTS)
    right.plot(0.0, 0.0, "k.")
    right.set_aspect("equal", adjustable="datalim")
    right.set_xlabel("slip velocity of a ball until it rolls, along [m/s]")
    right.set_ylabel("across [m/s]")
    right.legend(frameon=False, fontsize=8)
    return figure


def _slips(solution: ns.Solution) -> np.ndarray:
    """Return the slip velocities of a ball, shape [2, n]; its angular velocity is in its own axes."""
    spin = Rotation.from_quat(solution.q[:, 3:7], scalar_first=True).apply(solution.u[:, 3:])
    return np.array([solution.u[:, 0] - _RADIUS * spin[:, 1], solution.u[:, 1] + _RADIUS * spin[:, 0]])


def _rate_and_state() -> Any:
    figure, (left, right) = make_axes("Rate and state: rest makes it stronger, a step of the speed is felt twice", 2)
    law = laws.RateAndState(0.3, 0.01, 0.02, 1e-3, 1e-4)
    values = law.parameters()

    def mu(speed: float, age: float) -> float:
        return law.coefficient(speed, (age,), *values.values())

    times = np.geomspace(1e-3, 1e5, 100)
    left.semilogx(times, [mu(0.0, t) for t in times], color="black", label="$\\mu_0 + b\\,\\ln(1 + v_0 t / L)$")
    left.set_xlabel("time at rest [s]")
    left.set_ylabel("static coefficient")
    slow, fast, length = 1e-3, 1e-2, values["length"]
    way, level = np.linspace(0.0, 6.0, 300), []
    for x in way:
        # in steady slip the age is L / v; behind a step it goes over to that with exp(-x / L)
        before, after = ((slow, fast) if x < 3.0 else (fast, slow)) if x >= 1.0 else (slow, slow)
        since = (x - (1.0 if x < 3.0 else 3.0)) if x >= 1.0 else 0.0
        age = length / after + (length / before - length / after) * math.exp(-since * 2.0)
        level.append(mu(after, age))
    right.plot(2.0 * way, level, color="black")
    right.text(2.3, mu(fast, length / slow), "a", fontsize=9, va="top")
    right.annotate("10 v", (4.0, mu(fast, length / fast)), fontsize=8, va="bottom", ha="center")
    right.annotate("v", (1.0, mu(slow, length / slow)), fontsize=8, va="bottom", ha="center")
    right.annotate("v", (11.0, mu(slow, length / slow)), fontsize=8, va="bottom", ha="center")
    right.set_xlabel("slip / L")
    right.set_ylabel("coefficient")
    left.legend(frameon=False, fontsize=8)
    return figure


def _bristle() -> Any:
    figure, (left, right) = make_axes("Bristles: a spring before they slip, Stribeck's fall when they do", 2)
    law = laws.Bristle(0.2, 0.3, stribeck_speed=0.05, stiffness=1e4, damping=0.0)
    values = law.parameters()

    def look(speed: float, bent: float) -> tuple[float, float]:
        out = [0.0] * 7
        law.traction(1.0, [speed, 0.0, 0.0, 0.0, 0.0], [bent, 0.0], out, *values.values())
        return -out[0], out[5]

    bent, place = 0.0, 0.0
    speed, dt = 1e-3, 1e-4
    places, forces = [], []
    for step in range(5200):
        direction = 1.0 if step < 1200 or step >= 2800 else -1.0
        places.append(1e6 * place)
        forces.append(look(direction * speed, bent)[0])
        bent, place = bent + dt * look(direction * speed, bent)[1], place + dt * direction * speed
    left.plot(places, forces, color="black")
    left.plot([0.0, 30.0], [0.0, 0.3], label="spring $s_0$", **GREY)
    left.axhline(0.0, color="0.7", linewidth=0.8)
    left.set_xlabel("slip at 1 mm/s to and fro [µm]")
    left.set_ylabel("friction / normal force")
    speeds = np.linspace(1e-3, 0.2, 200)
    right.plot(speeds, 0.2 + 0.1 * np.exp(-((speeds / 0.05) ** 2)), color="black", label="g(v)")
    settled = []
    for v in speeds[::20]:
        end = solve_ivp(lambda t, z, v=v: [look(v, z[0])[1]], (0.0, 1e-2 / v), [0.0], method="LSODA", rtol=1e-9)
        settled.append(look(float(v), float(end.y[0, -1]))[0])
    right.plot(speeds[::20], settled, label="after 10 mm of slip", **DOTS)
    right.set_xlabel("slip speed [m/s]")
    right.set_ylim(0.0, 0.35)
    right.set_xticks([0.0, 0.05, 0.1, 0.15, 0.2])
    for axis in (left, right):
        axis.legend(frameon=False, fontsize=8)
    return figure


def _contensou() -> Any:
    figure, (left, right) = make_axes(
        "Coulomb and Contensou: what drills slips easily, and drilling comes to an end", 2
    )
    ratio = np.linspace(0.0, 4.0, 200)
    left.plot(ratio, ratio / np.hypot(1.0, ratio), color="black", label="force / (µ N)")
    left.plot(ratio, 1.0 / np.hypot(1.0, ratio), color="black", linestyle="--", label="drilling moment / (µ N c)")
    left.plot([0.0, 0.0, 4.0], [0.0, 1.0, 1.0], label="force without drilling", **GREY)
    left.set_xlabel("slip speed / (c times drilling rate)")
    left.set_ylabel("part of the bound")
    mu, lever, spin = 0.3, 2e-4, 10.0
    law = laws.CoulombContensou(mu, lever, presliding=1e-8)
    end = 0.4 * _RADIUS**2 * spin / (mu * _G * lever)
    # the reversal of the bristles at the end is of no interest
    solution = _ball(_soft(law), 1.2 * end, (0.0, 0.0), spin)
    right.plot([0.0, end, 1.2 * end], [spin, 0.0, 0.0], color="black", label="stops after $I\\omega / (\\mu N c)$")
    right.plot(solution.t[::25], solution.u[::25, 5], label="run of a ball", **DOTS)
    right.set_xlabel("time [s]")
    right.set_ylabel("drilling rate [rad/s]")
    for axis in (left, right):
        axis.legend(frameon=False, fontsize=8)
    return figure


def traction() -> Mapping[str, Any]:
    """Draw the five laws."""
    anisotropic = laws.Anisotropic(0.15, 0.45, body="first")
    directional = laws.Directional(0.15, 0.5, 0.3, body="first")
    return {
        "law_anisotropic": _by_direction(anisotropic, "Anisotropic: µ = 0.15 along the axis, 0.45 across"),
        "law_directional": _by_direction(directional, "Directional: µ = 0.15 forward, 0.5 backward, 0.3 across"),
        "law_rate_and_state": _rate_and_state(),
        "law_bristle": _bristle(),
        "law_coulomb_contensou": _contensou(),
    }
