"""Motions and impacts of closed form, or of a known account, that need a constant of the engine."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np

import nonsmooth as ns
from bodies import Ball, BallJoint, BoxBody, DrivenBody, Plate, Rest, Sphere
from laws import Coulomb, EnergeticImpact, Frictionless, LinearCompliant, Stribeck
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.impact import _memory
from nonsmooth.model.delassus import write_delassus
from tests.engine.plain_cases import _creeping, jamming
from tests.engine.test_clearance import LAWS, R, drop
from tests.engine.test_courses import FAR, HEIGHT, _beside
from tests.engine.test_spins import test_a_spin_that_keeps_its_direction_is_integrated_along_the_body as keep_direction
from tests.engine.test_stall import CROWDED, _rattling
from tests.engine.test_step_length import AHEAD, FLYING, INTEGRATED, RADIUS, SPEED, _pass_by
from tests.engine.tops import Top
from tests.physics.test_own_guards import Level
from tests.physics.test_wedged_impacts import _jointed, _on_a_line

G = 9.81


def _first_impact(solution: ns.Solution) -> float:
    return float(solution.events.time[1]) if len(solution.events) > 1 else math.inf


def passes_a_level() -> None:
    """Throw a ball past a level next to the top of its way; it is back below it as the step ends."""
    ball, speed, below = Ball(R), 0.05 * G, 1e-3
    system = ns.System([ball], gravity=G)
    system.place(ball, velocity=(0.0, 0.0, speed))
    system.guard(Level(0.5 * speed**2 / G - below, -1.0))
    passed = _first_impact(ns.simulate(system, 0.1, sample_interval=0.1))
    assert abs(passed - (0.05 - math.sqrt(2.0 * below / G))) < 1e-11


def touches_a_ball_on_its_way_down() -> None:
    """Let a ball that falls onto a plate touch another one before, by two thousandths of a millimetre."""
    height, overlap, speed, z = 0.0663117, 1.652e-6, 0.0681, 0.0382595
    way = height - z - math.sqrt(4.0 * R * R - (2.0 * R - overlap) ** 2)
    solution = ns.simulate(drop(height, overlap, speed, z, True), 0.2, sample_interval=0.2)
    assert abs(_first_impact(solution) - 2.0 * way / (speed + math.sqrt(speed**2 + 2.0 * G * way))) < 1e-10


def precesses_into_a_ball() -> None:
    """Let the axis of a top come near that about which it turned at the start, where a ball is.

    The other ball is next to the centre of its body, and what turns that moves its surface hardly.
    """
    top, other, period = Top(), Top((0.01, 0.01, 0.01), 1e-3), 0.1
    system = ns.System([top, other], gravity=0.0)
    system.contact(top, other, **LAWS)
    lean = math.radians(60.0)
    tilt = math.atan(0.5 * math.tan(lean))
    rate = 2.0 * math.pi / period
    system.place(top, angular_velocity=(rate * math.sin(tilt), 0.0, 0.5 * rate * math.cos(tilt)))
    system.place(other, position=(0.1 * math.sin(lean), 0.0, 0.1 * math.cos(lean) - other.arm))
    near = math.cos(2.0 * math.asin(top.radius / top.arm))
    turned = (math.cos(tilt) * math.cos(lean - tilt) - near) / (math.sin(tilt) * math.sin(lean - tilt))
    solution = ns.simulate(system, period, sample_interval=period)
    assert abs(_first_impact(solution) - math.acos(turned) / rate) < 1e-10


def flies_up_to_a_closing() -> None:
    """End the step where two balls touch that all but pass each other; nothing is looked for in it."""
    solution = _pass_by(FLYING, 0.95 * 2.0 * RADIUS)
    exact = (AHEAD - 2.0 * RADIUS * math.sqrt(1.0 - 0.95**2)) / SPEED
    assert abs(_first_impact(solution) - exact) < 1e-12
    assert solution.counters.gap_looks == 0


def steps_up_to_a_closing() -> None:
    """End the first step there, too, of one that is integrated and meets the other in the middle."""
    assert _pass_by(INTEGRATED, 0.0).counters.gap_looks == 0


def keeps_its_length() -> None:
    """Hold the quaternion of a tumbling box to unit length."""
    box = BoxBody(0.01, 0.02, 0.03)
    system = ns.System([box], gravity=0.0)
    system.place(box, angular_velocity=(30.0, 20.0, 10.0))
    assert abs(np.linalg.norm(ns.simulate(system, 0.1).q_end[3:]) - 1.0) < 1e-15


def rolls_undisturbed() -> None:
    """Let a ball roll beside one that bounces as beside one that flies, to the last bit."""
    ends = []
    for height in (HEIGHT, 0.5 * FAR):
        system, (ball,) = _beside(height, [(0.0, 0.3)], 0.2)
        ends.append(ns.simulate(system, 0.04, sample_interval=0.02).of(ball)[0])
    np.testing.assert_array_equal(ends[0], ends[1])


def is_thrown_back() -> None:
    """Throw a soft ball back that begins in touch with a held one, so fast that it could be through in one stage."""
    held, ball = DrivenBody(Rest(), (Sphere(R),)), Ball(R)
    system = ns.System([held, ball], gravity=0.0)
    system.contact(held, ball, normal=LinearCompliant(1e5), friction=Frictionless())
    system.place(ball, position=(0.0, 0.0, 2.0 * R), velocity=(0.0, 0.0, -5.0))
    assert abs(ns.simulate(system, 0.05, sample_interval=0.05).u_end[2] - 5.0) < 1e-6


def creeps_in_long_steps() -> None:
    """Follow a slip that turns as it slows down, and is stiff, by a few implicit steps."""
    numbers = _creeping(1e-3)
    assert abs(numbers["wrong"][0]) < 1e-7
    assert numbers["cost"][0] <= 10


def hangs_by_a_rope() -> None:
    """Hold the middle of a ball that swings on a joint to its distance, however far it has swung."""
    ball, base = Ball(R), Plate()
    system = ns.System([base, ball], G)
    system.joint(BallJoint((0.0, 0.0, 1.0), (-0.2, 0.0, 0.0)), base, ball)
    system.place(ball, position=(0.2, 0.0, 1.0))
    arm = ns.simulate(system, 0.3, sample_interval=0.3).q_end[:3] - [0.0, 0.0, 1.0]
    assert abs(np.linalg.norm(arm) - 0.2) < 1e-12


def _rattles(every: float, events: int) -> str:
    """Return how a run ends in which a ball strikes each of two plates every so many seconds, so many times."""
    try:
        return ns.simulate(_rattling(every), every * events).status
    except ns.RunFailed as failed:
        return "stalls" if "stalls" in str(failed) else str(failed)


def stalls() -> None:
    """Give a ball up that strikes so often that time hardly passes."""
    assert _rattles(0.5 * CROWDED, 110) == "stalls"


def does_not_stall() -> None:
    """Go on with one that strikes half as often as that."""
    assert _rattles(2.0 * CROWDED, 110) == "done"


def rebounds_on_a_line() -> None:
    """Let a point rebound on a line that leans from the normal: friction takes its part of the energy both ways."""
    mass, normal, tangential, u = _on_a_line(1.0)
    part = 0.95
    result = ns.solve_impact(
        mass, normal, tangential, u, [EnergeticImpact(0.5)], [Coulomb(part / math.tan(1.0))], tolerance=1e-10
    )
    after = 0.5 * abs(float(u[0])) * math.sqrt((1.0 - part) / (1.0 + part))
    assert abs(float(result.velocity[0]) - after) < 1e-9
    assert not result.truncated


def _wrong(*problem: Any) -> float:
    """Return the part of the energy that is in no account after an impact, or of the approach that is left."""
    mass, normal, _, u, *_ = problem
    result = ns.solve_impact(*problem)
    before, after = (0.5 * float(v @ mass @ v) for v in (u, result.velocity))
    lost = float(np.sum(result.restitution_loss + result.friction_loss))
    approach = -np.min(normal.T @ result.velocity) / np.max(np.abs(normal.T @ u))
    return max(abs(before - after - lost) / before, float(approach))


def slides_over_two_plates() -> None:
    """Let a ball slide over two plates that are next to one, where they meet: neither stops it."""
    lean, speed = 1e-5, 5e-4
    plates, ball = [Plate(), Plate(Rest(orientation=(math.cos(0.5 * lean), 0.0, -math.sin(0.5 * lean), 0.0)))], Ball(R)
    system = ns.System([*plates, ball], gravity=G)
    for plate in plates:
        system.contact(plate, ball, **LAWS)
    system.place(ball, position=(0.0, 0.0, R), velocity=(speed, 0.0, 0.0))
    assert abs(ns.simulate(system, 1e-3).u_end[0] / speed - 1.0) < 0.02


def jams_late() -> None:
    """Jam a slip at the Painleve singularity three years later than at the start, in steps that are no shorter."""
    model, late = ns.assemble(jamming(0.999)), 1e8
    solution = model.run(late + 5e-4, start=dataclasses.replace(model.start, time=late))
    counters = solution.counters
    assert "jamming of a slip" in solution.events.causes()
    assert counters.steps + counters.rejected + counters.gap_looks < 150


def keeps_account_of_a_light_contact() -> None:
    """Book all energy of two contacts of one body on a line, of which one moves along its normal hardly."""
    line = np.array([[4.5e-3, -0.079, -0.70], [-1.17, 0.25, -0.80]])
    laws = [EnergeticImpact(0.0176)] * 2, [Coulomb(0.0924)] * 2
    assert _wrong(np.eye(1), line[None, :, 0], line[None, :, 1:], np.array([2.7]), *laws) < 1e-9


def keeps_account_of_a_slip_that_stops() -> None:
    """Book the energy of a slip that comes to rest in an impact."""
    assert _wrong(*_jointed(32), [EnergeticImpact(0.878)], [Stribeck(0.497, 1.0, 0.297)]) < 1e-9


def rebounds_slowly() -> None:
    """Give back what a contact stored whose forces move its body, however slow it is next to what bounces."""
    memory = _memory([EnergeticImpact(1.0)], [Frictionless()], 1e-10)
    write_delassus(memory, np.eye(3))
    memory.array("impact_z0", 3)[:] = [-1.0, 0.0, 0.0]
    memory.scalars["slow_speed"] = 10.0
    assert call_entry("energetic_impact", memory, 0.0) == 1
    assert abs(memory.array("impulse", 3)[0] - 2.0) < 1e-9


MOTIONS: dict[str, tuple[Any, Callable[[], None]]] = {
    "flow.location._MIDDLE": (0.999, passes_a_level),
    "flow.courses._ATTEMPTS": (0, rolls_undisturbed),
    "flow.courses._DRIFT": (0.0, rolls_undisturbed),
    "flow.courses._KEPT": (2.0, rolls_undisturbed),
    "flow.spins._KEPT": (2.0, keep_direction),
    "memory.layout.PARTS": (2, touches_a_ball_on_its_way_down),
    "flow.guards.UNKNOWN_FALL": ((0.0, 0.0, 0.0), touches_a_ball_on_its_way_down),
    "events.step_length._TURN": (1e9, precesses_into_a_ball),
    "events.step_length._FIRST_WAY": (1e9, is_thrown_back),
    "events.step_length._SHORTEST": (1.0, steps_up_to_a_closing),
    "flow.clearance._CLOSINGS": (2, flies_up_to_a_closing),
    "flow.projection._DAMPING": (0.0, slides_over_two_plates),
    "flow.projection._MOST_ITERATIONS": (1, hangs_by_a_rope),
    "flow.projection._ROUND_OFF": (1e-3, keeps_its_length),
    "flow.self_check.NOUGHT": (1.0, flies_up_to_a_closing),
    "events.event_loop._SPACINGS": (0.0, jams_late),
    "events.stall._EVENTS": (10**6, stalls),
    "events.stall._TIME": (1.0, does_not_stall),
    "flow.step.STIFF": (1e300, creeps_in_long_steps),
    "memory.implicit_tableau.ITERATIONS": (1, creeps_in_long_steps),
    "memory.implicit_tableau.SETTLED": (0.0, creeps_in_long_steps),
    "impact.end._LOCKED": (2.0, rebounds_slowly),
    "impact.friction._IDLE": (0.5, rebounds_on_a_line),
    "impact.problem._LONG": (0, rebounds_on_a_line),
    "impact.problem._NO_RETURN": (0.9, rebounds_on_a_line),
    "impact.guards.TOGETHER": (1e-2, keeps_account_of_a_light_contact),
    "impact.scales.CIRCLING": (1e6, keeps_account_of_a_light_contact),
    "impact.scales.REST": (1e-2, keeps_account_of_a_slip_that_stops),
}
"""By constant: another value, and what holds with the present one only."""
