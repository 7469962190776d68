"""Figures of the compliant normal laws: force over indentation in an impact, and a case in closed form."""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from law_axes import DOTS, GREY, Falling, make_axes
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import laws
import nonsmooth as ns
from nonsmooth.bodies import Ball, Plate
from nonsmooth.parameters import UnusualValue

_RADIUS = 0.01
_MASS = Ball(_RADIUS).total_mass
_STYLES = ("-", "--", ":")


def _run(law: Any, speed: float, t_end: float) -> ns.Solution:
    """Run a ball that strikes a plate at t = 0."""
    plate, ball = Plate(), Ball(_RADIUS)
    system = ns.System([plate, ball], 0.0)
    system.contact(plate, ball, normal=law, friction=laws.Frictionless())
    system.place(ball, position=(0.0, 0.0, _RADIUS), velocity=(0.0, 0.0, -speed))
    return ns.simulate(system, t_end, sample_interval=t_end / 400.0)


def _loop(axis: Any, law: Any, speed: float, t_end: float, micro: float, **look: Any) -> None:
    """Draw force over indentation until the contact opens."""
    names = list(inspect.signature(law.force).parameters)[3:]
    values = {name: law.parameters()[name] for name in names}

    def force(x: float, rate: float) -> float:
        return float(law.force(x, rate, speed, **values))

    opens = Falling(lambda t, y: y[0] + law.reach + 1e-12)
    times = np.linspace(0.0, t_end, 2000)
    found = solve_ivp(
        lambda t, y: [y[1], -force(*y) / _MASS], (0.0, t_end), (0.0, speed), events=opens, t_eval=times, rtol=1e-9
    ).y
    axis.plot(micro * found[0], [force(*y) for y in found.T], **look)


def _finish(figure: Any, left: Any, right: Any, below: str, beside: str) -> Any:
    left.set_xlabel("indentation [µm]")
    left.set_ylabel("normal force [N]")
    right.set_xlabel(below)
    right.set_ylabel(beside)
    for axis in (left, right):
        axis.axhline(0.0, color="0.7", linewidth=0.8)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(frameon=False, fontsize=8)
    return figure


def _cases(axis: Any, places: Sequence[float], run: Callable[[float], float]) -> None:
    axis.plot(places, [run(float(x)) for x in places], label="run of a ball", **DOTS)


def _linear() -> Any:
    stiffness = 1e6
    omega = math.sqrt(stiffness / _MASS)

    def law(ratio: float) -> Any:
        return laws.LinearCompliant(stiffness, 2.0 * ratio * omega * _MASS)

    def restitution(ratio: float) -> float:
        decay, damped = ratio * omega, omega * math.sqrt(1.0 - ratio**2)
        end = (math.atan2(2.0 * decay * damped, decay**2 - damped**2) % math.pi) / damped
        return math.exp(-decay * end) * (decay / damped * math.sin(damped * end) - math.cos(damped * end))

    figure, (left, right) = make_axes("Spring and damper without tension: the force ends before the contact", 2)
    for ratio, look in zip((0.02, 0.2, 0.6), _STYLES, strict=True):
        _loop(left, law(ratio), 0.5, 8e-4, 1e6, color="black", linestyle=look, label=f"damping ratio {ratio:g}")
    ratios = np.linspace(0.01, 0.98, 100)
    right.plot(ratios, [restitution(r) for r in ratios], color="black", label="Schwager and Pöschel")
    right.plot(ratios, np.exp(-math.pi * ratios / np.sqrt(1.0 - ratios**2)), label="if it could pull", **GREY)
    _cases(right, ratios[4::12], lambda r: _run(law(r), 0.5, 4e-3).u_end[2] / 0.5)
    return _finish(figure, left, right, "damping ratio", "coefficient of restitution")


def _hertz() -> Any:
    figure, (left, right) = make_axes("Hertz: nothing is lost, faster impacts are shorter", 2)
    for exponent, stiffness, look in ((1.5, 1e9, "-"), (1.0, 5e6, "--"), (2.0, 2.4e11, ":")):
        x = np.linspace(0.0, 3e-5, 100)
        law = laws.HertzCompliant(stiffness, exponent)
        force = [law.force(one, 0.0, 0.0, stiffness, exponent) for one in x]
        left.plot(1e6 * x, force, color="black", linestyle=look, label=f"η = {exponent:g}")
    speeds = np.geomspace(1e-3, 10.0, 100)
    share = quad(lambda s: 2.0 * s / math.sqrt(1.0 - (1.0 - s * s) ** 2.5), 0.0, 1.0)[0]
    depth = (5.0 * _MASS * speeds**2 / 4e9) ** 0.4
    right.loglog(speeds, 2e6 * share * depth / speeds, color="black", label="quadrature, $v^{-1/5}$")

    ticks = (150, 200, 300, 500, 800)
    right.set_yticks(ticks, [str(tick) for tick in ticks])
    right.minorticks_off()

    def duration(speed: float) -> float:
        events = _run(laws.HertzCompliant(1e9), speed, 5e-3).events
        return float(1e6 * (events.time[-1] - events.time[0]))

    _cases(right, speeds[::11], duration)
    return _finish(figure, left, right, "approach speed [m/s]", "time of contact [µs]")


def _damped(d: float) -> float:
    """Return e of (1 + e) d = ln((1 + d) / (1 - e d)), d being the damping times the speed."""
    most = min(1.0, 1.0 / d - 1e-14)
    return float(brentq(lambda e: (1.0 + e) * d - math.log((1.0 + d) / (1.0 - e * d)), 1e-12, most))


def _hunt_crossley() -> Any:
    figure, (left, right) = make_axes("Hunt and Crossley: damping grows with the indentation", 2)
    for dissipation, look in zip((0.1, 0.6, 3.0), _STYLES, strict=True):
        law = laws.HuntCrossley(1e9, dissipation)
        _loop(left, law, 1.0, 2e-3, 1e6, color="black", linestyle=look, label=f"d v = {dissipation:g}")
    places = np.geomspace(1e-2, 30.0, 100)
    right.semilogx(places, [_damped(d) for d in places], color="black", label="$(1+e)\\,dv = \\ln[(1+dv)/(1-e\\,dv)]$")
    right.semilogx(places[places < 1.0], 1.0 - 2.0 * places[places < 1.0] / 3.0, label="$1 - 2\\,dv/3$", **GREY)
    _cases(right, places[::11], lambda d: _run(laws.HuntCrossley(1e9, d), 1.0, 2e-2).u_end[2])
    return _finish(figure, left, right, "damping times speed, d v", "coefficient of restitution")


def _lankarani_nikravesh() -> Any:
    figure, (left, right) = make_axes("Lankarani and Nikravesh: damping by the speed of the impact", 2)
    for e, look in zip((0.95, 0.7, 0.3), _STYLES, strict=True):
        law = laws.LankaraniNikravesh(1e9, e)
        _loop(left, law, 1.0, 2e-3, 1e6, color="black", linestyle=look, label=f"e = {e:g}")
    nominal = np.linspace(0.0, 0.999, 100)
    right.plot(nominal, [_damped(0.75 * (1.0 - e * e)) for e in nominal], color="black", label="what comes back")
    right.plot([0.0, 1.0], [0.0, 1.0], label="e", **GREY)
    _cases(right, nominal[::11], lambda e: _run(laws.LankaraniNikravesh(1e9, e), 1.0, 5e-3).u_end[2])
    return _finish(figure, left, right, "nominal restitution e", "coefficient of restitution")


def _cohesive() -> Any:
    stiffness, tension = 1e6, 20.0
    law = laws.Cohesive(stiffness, tension)
    least = tension / math.sqrt(_MASS * stiffness)
    figure, (left, right) = make_axes("Cohesion: it pulls before it lets go, and holds what is slow", 2)
    for part, words, look in (
        (1.4, "gets away", {"color": "black", "linewidth": 1.2}),
        (0.7, "held", {"color": "0.6", "linewidth": 4.0, "zorder": 1}),
    ):
        _loop(left, law, part * least, 2e-3, 1e6, label=f"v = {part:g} $T/\\sqrt{{mk}}$: {words}", **look)
    left.plot([-20.0, -20.0], [-tension, 0.0], color="tab:red", linewidth=1.2, label="it lets go")
    parts = np.linspace(0.0, 3.0, 301)
    right.plot(parts, np.sqrt(np.maximum(0.0, parts**2 - 1.0)), color="black", label="$\\sqrt{v^2 - T^2/(mk)}$")

    def after(part: float) -> float:
        solution = _run(law, part * least, 2e-2)
        away = "lift-off" in solution.events.causes()
        return float(solution.u_end[2]) / least if away else 0.0

    _cases(right, [0.2, 0.5, 0.8, 0.95, 1.05, 1.2, 1.5, 2.0, 2.5, 3.0], after)
    return _finish(figure, left, right, "speed before / $T/\\sqrt{mk}$", "speed it gets away with / the same")


def compliance() -> Mapping[str, Any]:
    """Draw the five laws."""
    # small restitutions are drawn, too
    warnings.simplefilter("ignore", UnusualValue)
    return {
        "law_linear": _linear(),
        "law_hertz": _hertz(),
        "law_hunt_crossley": _hunt_crossley(),
        "law_lankarani_nikravesh": _lankarani_nikravesh(),
        "law_cohesive": _cohesive(),
    }
