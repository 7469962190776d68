"""Gaps that fall and rise within a step, whatever else happens in it: found if they close, at the time when they do."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    Cone,
    ConeBody,
    DiscBody,
    DrivenBody,
    EllipsoidBody,
    Harmonic,
    Plate,
    Rest,
    Rod,
    Sphere,
)
from laws import EnergeticImpact, Frictionless, NewtonImpact, Unilateral

G, R = 9.81, 0.01
LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(0.5)}


def drop(height: float, overlap: float, speed: float, z: float, held: bool) -> ns.System:
    """Return a ball that falls past another one, held or falling, by less than a diameter, and then onto a plate."""
    plate, ball = Plate(), Ball(R)
    x = 2.0 * R - overlap
    other = DrivenBody(Rest(), (Sphere(R, x=x, z=z),)) if held else Ball(R)
    system = ns.System([plate, ball, other], gravity=G)
    system.contact(ball, other, **LAWS)
    system.contact(plate, ball, **LAWS)
    system.place(ball, position=(0.0, 0.0, height), velocity=(0.0, 0.0, -speed))
    if not held:
        system.contact(plate, other, **LAWS)
        system.place(other, position=(x, 0.0, z))
    return system


def first_touch(height: float, overlap: float, speed: float, z: float, held: bool) -> float:
    """Time at which the balls of `drop` touch if nothing else touches before, infinite if they do not."""
    way = height - z - math.sqrt(4.0 * R * R - (2.0 * R - overlap) ** 2) if overlap > 0.0 else math.inf
    g = G if held else 0.0
    if math.isinf(way) or (g == 0.0 and speed == 0.0):
        return math.inf
    return 2.0 * way / (speed + math.sqrt(speed * speed + 2.0 * g * way))


@pytest.mark.parametrize("held", [True, False])
def test_a_ball_that_falls_past_another_one_onto_a_plate_misses_it_iff_it_does(held: bool) -> None:
    """On both sides of grazing the first collision is that of the closed form, though the plate fires, too."""
    rng = np.random.default_rng(11)
    met = 0
    for _ in range(150):
        overlap = float(rng.choice([-1.0, 1.0])) * 10.0 ** rng.uniform(-9.0, -2.0)
        z = rng.uniform(0.012, 0.05)
        case = z + rng.uniform(0.021, 0.15), overlap, rng.uniform(0.0, 2.0), z, held
        touch = first_touch(*case)
        solution = ns.simulate(drop(*case), 0.25, sample_interval=0.25)
        impacts = solution.events.time[[cause == "impact" for cause in solution.events.causes()]]
        fall = math.inf if held else math.sqrt(2.0 * (z - R) / G)
        floor = (math.sqrt(case[2] ** 2 + 2.0 * G * (case[0] - R)) - case[2]) / G
        expected = min(touch, fall, floor)
        met += touch == expected
        assert impacts[0] == pytest.approx(expected, abs=1e-10), case
    assert met > 20


def test_a_ball_that_falls_past_a_held_one_touches_it_first() -> None:
    """They overlap by 1.7 micrometres across the way down, so that the gap closes between two looks at it."""
    height, overlap, speed, z = 0.0663117, 1.652e-6, 0.0681, 0.0382595
    way = height - z - math.sqrt(4.0 * R * R - (2.0 * R - overlap) ** 2)
    events = ns.simulate(drop(height, overlap, speed, z, True), 0.2, sample_interval=0.2).events
    assert events.time[1] == pytest.approx(2.0 * way / (speed + math.sqrt(speed**2 + 2.0 * G * way)), abs=1e-10)


def test_the_first_of_many_collisions_within_one_step_is_found() -> None:
    """Balls fly freely in the longest of steps, and the first collision is that of the quadratic equations of all."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        n = 6
        balls = [Ball(R) for _ in range(n)]
        place, velocity = rng.uniform(-0.15, 0.15, (n, 3)), rng.normal(size=(n, 3))
        apart = place[:, None] - place[None]
        i, j = np.triu_indices(n, 1)
        d, v = apart[i, j], (velocity[:, None] - velocity[None])[i, j]
        if np.min(np.linalg.norm(d, axis=1)) < 2.1 * R:
            continue
        system = ns.System(balls, gravity=0.0)
        for one, other in zip(i, j, strict=True):
            system.contact(balls[one], balls[other], **LAWS)
        for ball, x, u in zip(balls, place, velocity, strict=True):
            system.place(ball, position=x, velocity=u, angular_velocity=rng.normal(size=3) * 30.0)
        b, c = np.sum(d * v, axis=1), np.sum(d * d, axis=1) - 4.0 * R * R
        a = np.sum(v * v, axis=1)
        real = (b * b > a * c) & (b < 0.0)
        times = np.where(real, c / np.where(real, -b + np.sqrt(np.abs(b * b - a * c)), 1.0), np.inf)
        solution = ns.simulate(system, 0.5, sample_interval=0.5)
        first = solution.events.time[1] if len(solution.events) > 1 else math.inf
        assert first == pytest.approx(min(times) if min(times) <= 0.5 else math.inf, abs=1e-11)


@pytest.mark.parametrize("body", [EllipsoidBody(0.03, 0.005, 0.008, 2700.0), BoxBody(0.02, 0.004, 0.006, 2700.0)])
def test_a_body_that_tumbles_past_a_ball_is_missed_by_no_step(body: EllipsoidBody | BoxBody) -> None:
    """The first collision of long steps is that of steps a hundred times as short."""
    rng = np.random.default_rng(3)
    met = 0
    for _ in range(12):
        ball = Ball(R)
        system = ns.System([ball, body], gravity=0.0)
        system.contact(ball, body, **LAWS)
        aim = rng.normal(size=3) * 0.012
        system.place(ball, position=(0.15 + aim[0], aim[1], aim[2]), velocity=(-2.0, 0.0, 0.0))
        q = rng.normal(size=4)
        turning = rng.normal(size=3) * 20.0
        system.place(body, orientation=q / np.linalg.norm(q), angular_velocity=turning)
        times = []
        for step in (0.1, 1e-3):
            run = ns.simulate(system, 0.15, sample_interval=0.15, engine=ns.EventDriven(largest_step=step))
            times.append(run.events.time[1] if len(run.events) > 1 else math.inf)
        met += times[0] < math.inf
        assert times[0] == pytest.approx(times[1], abs=1e-8)
    assert met > 2


def test_events_are_kept_however_often_the_engine_is_called(monkeypatch: pytest.MonkeyPatch) -> None:
    """Events that take neither a step nor an impact are not lost between two calls."""
    output_sink = importlib.import_module("nonsmooth.runs.folder_sink")
    plate, box = Plate(), BoxBody(0.01, 0.01, 0.01, 2700.0)
    system = ns.System([plate, box])
    system.contact(plate, box, **LAWS)
    system.place(box, position=(0.0, 0.0, 0.012), angular_velocity=(3.0, 2.0, 0.0))
    whole = ns.simulate(system, 0.1)
    monkeypatch.setattr(output_sink, "_STEPS_PER_CALL", 1)
    parts = ns.simulate(system, 0.1)
    assert parts.events.causes() == whole.events.causes()
    np.testing.assert_array_equal(parts.events.time, whole.events.time)


def test_a_run_of_hours_locates_events_to_what_doubles_tell() -> None:
    """After 9000 s doubles are 1.8e-12 s apart, more than the time tolerance: a ball that loses nothing bounces on."""
    plate, ball = Plate(), Ball(R)
    system = ns.System([plate, ball], gravity=1e-3)
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    height = 0.05
    system.place(ball, position=(0.0, 0.0, R + height))
    fall = math.sqrt(2.0 * height / 1e-3)
    t_end = fall * (2.0 * 600 + 1.5)
    solution = ns.simulate(system, t_end, sample_interval=t_end)
    assert solution.status == "done"
    assert solution.t_end == t_end
    impacts = solution.events.time[1:]
    # what an event is off, some 1e-11 s, the velocity keeps, and all later events are off by as much more
    np.testing.assert_allclose(impacts, fall * (2.0 * np.arange(601) + 1.0), rtol=0.0, atol=1e-11 * 600**2)


def _causes_and_times(system: ns.System, t_end: float, step: float) -> tuple[list[str], np.ndarray]:
    run = ns.simulate(system, t_end, sample_interval=t_end, engine=ns.EventDriven(largest_step=step))
    return run.events.causes(), run.events.time


def test_contacts_that_close_together_hide_none_that_closed_before() -> None:
    """The four lower corners of a box reach the plate at once, as its edges, long before, a rod parallel to them."""
    plate, box, rod = Plate(), BoxBody(0.0076, 0.0154, 0.0158, 1200.0, rounding=0.0007), Rod(0.0426, 0.00582, 2700.0)
    system = ns.System([plate, box, rod])
    for pair in ((plate, box), (plate, rod), (box, rod)):
        system.contact(*pair, **LAWS)
    system.place(box, position=(0.0, 0.0, 0.0755))
    system.place(rod, position=(0.0, 0.0, 0.0183))
    long, short = (_causes_and_times(system, 0.11, step) for step in (0.1, 1e-3))
    assert long[0] == short[0]
    np.testing.assert_allclose(long[1], short[1], rtol=0.0, atol=1e-9)


def test_rims_that_face_each_other_for_an_instant_of_a_long_step_collide() -> None:
    """A cone falls past the rim of a held cone whose rim it grazes by 24 micrometres."""
    cone = ConeBody(0.007446, 0.017683, 7800.0, foot_height=0.0)
    over = Rest(position=(0.009508, -0.015472, 0.028888), orientation=(0.0, 1.0, 0.0, 0.0))
    held = DrivenBody(over, (Cone(0.009528, 0.019882),))
    system = ns.System([cone, held])
    system.contact(cone, held, **LAWS)
    q = np.array([-0.279185, 0.085136, -0.290044, -0.911418])
    system.place(cone, position=(0.0, 0.0, 0.085), orientation=q / np.linalg.norm(q), velocity=(0.0, 0.0, -0.77))
    long, short = (_causes_and_times(system, 0.06, step) for step in (0.1, 1e-4))
    assert "impact" in short[0]
    assert long[0] == short[0]
    np.testing.assert_allclose(long[1], short[1], rtol=0.0, atol=1e-9)


def test_features_that_face_each_other_at_one_end_of_a_step_only_do_not_pass() -> None:
    """A spinning rod falls across the rim of a held cone: behind it the number in place of their gap is any."""
    over = Rest(position=(0.005, 0.004, 0.028888), orientation=(0.0, 1.0, 0.0, 0.0))
    held = DrivenBody(over, (Cone(0.0095, 0.0199),))
    rng = np.random.default_rng(7)
    met = 0
    for _ in range(8):
        rod = Rod(0.04, 0.005, 2700.0)
        system = ns.System([held, rod])
        system.contact(held, rod, **LAWS)
        turning = rng.normal(size=3) * 10.0
        system.place(
            rod, position=(*rng.uniform(-0.01, 0.01, 2), 0.08), velocity=(0, 0, -0.9), angular_velocity=turning
        )
        long, short = (_causes_and_times(system, 0.06, step)[1][1:2] for step in (0.1, 2e-4))
        met += len(short)
        np.testing.assert_allclose(long, short, rtol=0.0, atol=1e-8)
    assert met > 3


@pytest.mark.slow
def test_a_disc_that_rocks_through_flat_over_a_falling_plate_strikes_it() -> None:
    """Its lowest point jumps from side to side as it comes level, and with it the rate of its gap."""
    rng, radius, rounding, turn = np.random.default_rng(3), 0.01, 0.001, 50.0 * math.pi
    for _ in range(150):
        amplitude, phase, restitution = 10.0 ** rng.uniform(-3.3, -2.5), rng.uniform(0.6, 1.6), rng.uniform(0.0, 0.9)
        tilt, gap, spin = (
            10.0 ** rng.uniform(-4.0, -2.0),
            10.0 ** rng.uniform(-6.0, -5.0),
            10.0 ** rng.uniform(-1.0, 1.0),
        )
        plate = Plate(motion=Harmonic(amplitude=amplitude, frequency=25.0, phase=phase))
        disc = DiscBody(radius=radius, surface_density=1.0, rounding=rounding)
        system = ns.System([plate, disc], gravity=9.81)
        system.contact(
            plate, disc, normal=Unilateral(), friction=Frictionless(), impact=NewtonImpact(restitution=restitution)
        )
        rises = amplitude * turn * math.cos(phase) + rng.uniform(-0.2, 1.0) * spin * radius
        system.place(
            disc,
            position=(0.0, 0.0, amplitude * math.sin(phase) + (radius - rounding) * math.sin(tilt) + rounding + gap),
            orientation=(math.cos(0.5 * tilt), math.sin(0.5 * tilt), 0.0, 0.0),
            velocity=(0.0, 0.0, rises),
            angular_velocity=(-spin, 0.1 * spin * rng.normal(), 0.0),
        )
        solution = ns.simulate(system, 0.02, sample_interval=2e-5)
        w, x, y, z = solution.q[:, 3:7].T
        reach = (radius - rounding) * 2.0 * np.hypot(x * z + w * y, y * z - w * x) + rounding
        gaps = solution.q[:, 2] - amplitude * np.sin(turn * solution.t + phase) - reach
        assert float(np.min(gaps)) > -1e-9
