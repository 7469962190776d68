"""A run looks at itself: what no tolerance explains ends it by name or makes it suspect, and no body ever jumps."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    CapsuleBody,
    CylinderBody,
    EllipsoidBody,
    Harmonic,
    Hinge,
    Plate,
    Rest,
)
from bodies.contacts.plane.plane_point import evaluate_ball_over_plane
from laws import Cohesive, EnergeticImpact, Frictionless, LinearCompliant, Unilateral
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import PAST_END
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body, FeaturePair, Joint
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.assembly import assemble
from nonsmooth.types import Floats
from tests.testing.body_dummies import Ball as FaultyBall
from tests.testing.body_dummies import free

RADIUS = 0.01
LAWS: Mapping[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(0.5)}
_sound: Any = compiled(evaluate_ball_over_plane)
_free: Any = compiled(free)
_point: Any = compiled(BallJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.1)).evaluator)


def jumping_gap(a: Floats, b: Floats, out: Floats, depth: float, radius: float) -> None:
    _sound(a, b, out, radius, 0.0, 0.0, 0.0, 0.0)
    if b[0] > 0.05:
        out[0] = out[0] - depth


def short_normal(a: Floats, b: Floats, out: Floats, depth: float, radius: float) -> None:
    _sound(a, b, out, radius, 0.0, 0.0, 0.0, 0.0)
    if b[0] > 0.05:
        out[0] = out[0] - depth
        for i in range(1, 4):
            out[i] = 1e-3 * out[i]


def ending(a: Floats, b: Floats, out: Floats, depth: float, radius: float) -> None:
    _sound(a, b, out, radius, 0.0, 0.0, 0.0, 0.0)
    out[PAST_END] = depth if b[0] > 0.05 else -1.0
    if b[0] > 0.05 and out[0] > 0.0:
        out[0] += depth


def handing(a: Floats, b: Floats, out: Floats, depth: float, radius: float, x: float, onto: float) -> None:
    _sound(a, b, out, radius, 0.0, 0.0, 0.0, 0.0)
    past = onto * (x - b[0])
    if past > 0.0:
        past += depth
        out[0] = math.hypot(out[0] if onto > 0.0 else max(out[0], 0.0), past)
    out[PAST_END] = past


def _gap(evaluator: Callable[..., None], depth: float, **values: float) -> FeaturePair:
    """A ball over a plane whose gap falls by ``depth`` where the ball passes x = 0.05, in the way of the evaluator.

    ``short_normal``: with a normal there along which nothing but a long way closes the gap.  ``ending``: the features
    are past their end there, and a gap is no distance.  ``handing``: the plane ends at ``x``, or begins there (``onto``
    1); behind, what stands for a gap is positive, and as long as the way past the end, to which ``depth`` is added.
    """
    return FeaturePair(evaluator, {"depth": depth, "radius": RADIUS, **values}, ("plane-sphere",))


def _over(
    gap: FeaturePair, z: float, gravity: float | tuple[float, float, float], laws: Mapping[str, Any] = LAWS
) -> ns.System:
    plate, ball = Plate(Rest()), Ball(RADIUS, 7800.0)
    system = ns.System([plate, ball], gravity)
    (made,) = ns.System([plate, ball]).contact(plate, ball, **laws)
    system.add_contact(dataclasses.replace(made, kinematics=gap, name=""))
    system.place(ball, position=(0.0, 0.0, z), velocity=(1.0, 0.0, 0.0))
    return system


def _kept(error: ns.RunFailed) -> ns.Solution:
    assert isinstance(error.solution, ns.Solution)
    return error.solution


@pytest.mark.parametrize("depth", [1e-6, 1e-3, -1e-6, -1e-3])
def test_a_gap_of_a_closed_contact_that_jumps_ends_the_run_by_name_and_moves_nothing(depth: float) -> None:
    """The ball slides at the height it has; a projection would move it by the jump."""
    with pytest.raises(ns.RunFailed, match=r"plate - ball.*the gap is -?[0-9.e-]+ m.*jumping_gap") as caught:
        ns.simulate(_over(_gap(jumping_gap, depth), RADIUS, 9.81), 0.1)
    solution = _kept(caught.value)
    assert solution.q_end[2] == pytest.approx(RADIUS, abs=1e-11)
    assert 0.05 - 1e-9 < solution.q_end[0] <= 0.1


@pytest.mark.parametrize("depth", [1e-8, -1e-8])
def test_a_jump_within_what_tolerances_explain_is_projected_away(depth: float) -> None:
    """At a tenth of what is explained the run goes on, and the gap is closed."""
    solution = ns.simulate(_over(_gap(jumping_gap, depth), RADIUS, 9.81), 0.1)
    assert solution.status == "done"
    assert solution.q_end[2] == pytest.approx(RADIUS + depth, abs=1e-11)


def test_a_correction_that_would_move_a_body_far_ends_the_run_by_name_and_moves_nothing() -> None:
    """A gap of 10 nm is explained, a way of 10 um to close it is not; one of 0.1 nm takes no more than is."""
    with pytest.raises(
        ns.RunFailed, match=r"The body 'ball' would have to move by 1e-05 .* contradicts itself"
    ) as caught:
        ns.simulate(_over(_gap(short_normal, 1e-8), RADIUS, 9.81), 0.1)
    assert _kept(caught.value).q_end[2] == pytest.approx(RADIUS, abs=1e-11)
    closed = ns.simulate(_over(_gap(short_normal, 1e-10), RADIUS, 9.81), 0.1)
    assert closed.q_end[2] == pytest.approx(RADIUS + 1e-7, abs=1e-11)


def test_a_gap_of_an_open_contact_that_jumps_below_zero_ends_the_run_by_name() -> None:
    """In free flight 1 cm over the plate, with an overlap of 4 cm from nowhere."""
    with pytest.raises(ns.RunFailed, match=r"the gap is -0\.04 m.*jumping_gap") as caught:
        ns.simulate(_over(_gap(jumping_gap, 0.05), 2.0 * RADIUS, 0.0), 0.1)
    assert _kept(caught.value).q_end[2] == pytest.approx(2.0 * RADIUS, abs=1e-11)


SPRING: Mapping[str, Any] = {"normal": LinearCompliant(1e4), "friction": Frictionless(), "impact": None}


def test_bodies_that_springs_hold_do_not_pass_where_their_contact_ends() -> None:
    """A ball that a spring lets into a plane loses its contact, and has no other: it would fall through the plane."""
    with pytest.raises(ns.RunFailed, match=r"plate - ball.*the gap is -[0-9.]+e-05 m.*ending") as caught:
        ns.simulate(_over(_gap(ending, 1e-6), RADIUS, 9.81, SPRING), 0.1)
    assert _kept(caught.value).q_end[0] == pytest.approx(0.05, abs=1e-9)


def test_the_end_of_a_contact_that_jumps_is_an_event() -> None:
    """A spring holds a ball under a ceiling, and behind the end it would pull with 1 m: no step leads there."""
    pulls: Mapping[str, Any] = {**SPRING, "normal": Cohesive(1e4, 1.0)}
    solution = ns.simulate(_over(_gap(ending, 1.0), RADIUS, (0.0, 0.0, 9.81), pulls), 0.1)
    assert solution.status == "done"
    assert solution.events.causes()[-1] == "end of a feature"
    assert solution.events.time[-1] == pytest.approx(0.05, abs=2e-11)


@pytest.mark.parametrize("jump", [0.0, 1e-6, 1.0])
@pytest.mark.parametrize("place", [0.01, 0.02, 0.03, 0.04, 0.05, 0.06])
def test_springs_hand_over_to_the_next_feature_though_the_first_seems_to_lift_off(place: float, jump: float) -> None:
    """Its gap jumps from an overlap to a number above zero, on one side or the other of its end by round-off."""
    system = _over(_gap(handing, jump, x=place, onto=-1.0), RADIUS, 9.81, SPRING)
    following = _gap(handing, 0.0, x=0.999 * place, onto=1.0)
    system.add_contact(dataclasses.replace(system.contacts[0], kinematics=following, name=""))
    solution = ns.simulate(system, 1.1 * place)
    assert solution.status == "done"
    causes = solution.events.causes()
    assert "end of a feature" in causes
    assert solution.events.time[causes.index("end of a feature")] == pytest.approx(place, abs=2e-11)
    assert len(causes) < 40


@pytest.mark.parametrize("angle", [1e-3, 1e-5, 1e-7, 1e-9])
def test_contacts_that_nearly_repeat_each_other_move_nothing_far(angle: float) -> None:
    """A ball on two planes at a small angle, 1e-12 m into one of them: the exact way out is 1e-12 m over the angle."""
    flat, tilted, ball = Plate(Rest()), Plate(Rest(slope=angle)), Ball(RADIUS, 7800.0)
    system = ns.System([flat, tilted, ball], 9.81)
    system.contact(flat, ball, **LAWS)
    system.contact(tilted, ball, **LAWS)
    system.place(ball, position=(RADIUS * np.tan(0.5 * angle), 0.0, RADIUS))
    memory = assemble(system, EventDriven()).memory
    call_entry("advance", memory, 0, 0)
    memory[owners.ContactRecord.mode][:2] = 2
    y = memory[owners.Island.y][:7]
    y[2] -= 1e-12
    before = y.copy()
    call_entry("project_closed", memory, 1, 0)
    moved = np.linalg.norm((y - before)[:3])
    assert 1e-13 < moved < 1e-8
    assert np.linalg.norm(y[3:]) == pytest.approx(1.0, abs=1e-15)
    if angle == 1e-3:
        call_entry("evaluate_at", memory)
        assert np.abs(memory[owners.ContactRecord.gap][:2]).max() < 1e-14


def turned(
    t: float, q: Floats, u: Floats, out: Floats, growth: float, gravity_x: float, gravity_y: float, gravity_z: float
) -> None:
    _free(t, q, u, out, 0.0, gravity_x, gravity_y, gravity_z)
    for i in range(4):
        out[63 + i] = out[63 + i] + growth * q[3 + i]


@dataclass(frozen=True)
class Growing(FaultyBall):
    """A body whose quaternion grows."""

    growth: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"growth": self.growth}

    @property
    def evaluator(self) -> Callable[..., None]:
        return turned


@pytest.mark.parametrize("growth", [1e-4, -1e-2, 1.0])
def test_a_quaternion_that_leaves_unit_length_ends_the_run_by_name(growth: float) -> None:
    """By more in one step of 0.1 s than a thousand times its tolerance."""
    with pytest.raises(ns.RunFailed, match=r"growing.*length of its quaternion is off by.*turned in"):
        ns.simulate(ns.System([Growing(growth=growth)], 9.81), 1.0)


def test_a_quaternion_within_its_tolerance_is_normalised() -> None:
    """A hundredth of that."""
    solution = ns.simulate(ns.System([Growing(growth=1e-7)], 9.81), 1.0)
    assert solution.status == "done"
    assert np.linalg.norm(solution.q_end[3:7]) == pytest.approx(1.0, abs=1e-15)


@dataclass(frozen=True)
class Dropped(FaultyBall):
    """A body of which the energy is written ``fault`` 8 times too large by a tenth, let go over the plate."""

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        return np.array([0.0, 0.0, 0.6, 1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0, 0.0, 0.0, 0.0])


def _dropped(fault: float) -> ns.Solution:
    plate, ball = Plate(Rest()), Dropped(fault)
    system = ns.System([plate, ball], 0.0)
    system.contact(plate, ball, **LAWS)
    return ns.simulate(system, 0.2)


def test_an_event_whose_energy_account_is_open_makes_the_run_suspect() -> None:
    """The law takes 3/8 J, the body says that 1.1 times as much is gone; without the fault nothing is suspect."""
    solution = _dropped(8.0)
    assert solution.status == "suspect"
    assert "at the event at t = 0.1 s 0.0375 J vanish" in solution.message
    assert "the energy account of the run is open by 0.0375 J" in solution.message
    assert _dropped(0.0).status == "done"


def parting(a: Floats, b: Floats, out: Floats, n_rows: float, rows: Floats, jump: float) -> None:
    _point(a, b, out, n_rows, rows)
    if b[2] < -0.05:
        out[0] = out[0] + jump


@dataclass(frozen=True)
class Parting(Joint):
    """A ball joint, 0.1 m off the body, whose first residual jumps where the body is 0.05 m below the first one."""

    jump: float

    def parameters(self) -> Mapping[str, Any]:
        return {**BallJoint((0.0, 0.0, 0.0), (-0.1, 0.0, 0.0)).parameters(), "jump": self.jump}

    @property
    def n_rows(self) -> int:
        return 3

    @property
    def evaluator(self) -> Callable[..., None]:
        return parting


def _pendulum(jump: float) -> ns.Solution:
    plate, ball = Plate(Rest()), Ball(RADIUS, 7800.0)
    system = ns.System([plate, ball], 9.81)
    system.joint(Parting(jump), plate, ball)
    system.place(ball, position=(0.1, 0.0, 0.0))
    return ns.simulate(system, 0.2)


@pytest.mark.parametrize("jump", [1e-5, 1e-2, -1e-2])
def test_a_joint_whose_residual_jumps_ends_the_run_and_moves_nothing(jump: float) -> None:
    """The body stays on its circle."""
    with pytest.raises(ns.RunFailed, match="joints contradict each other") as caught:
        _pendulum(jump)
    assert np.linalg.norm(_kept(caught.value).q_end[:3]) == pytest.approx(0.1, abs=1e-9)


def test_a_joint_whose_residual_jumps_by_what_is_explained_is_closed() -> None:
    """By 1e-8 m, of which a thousand tolerances of a step explain a hundred times as much."""
    solution = _pendulum(1e-8)
    assert solution.status == "done"
    assert solution.q_end[2] < -0.05


def _hinged() -> tuple[ns.System, list[Body]]:
    plate = Plate(Harmonic(5.77e-05, 99.6, 2.15))
    ball, cylinder = Ball(0.008194, 7800.0), CylinderBody(0.01966, 0.005773, 2700.0, rounding=0.0)
    capsule, ellipsoid = CapsuleBody(0.005864, 0.01563, 2700.0), EllipsoidBody(0.01164, 0.01856, 0.01615, 2700.0)
    bodies: list[Body] = [ball, cylinder, capsule, ellipsoid]
    system = ns.System([plate, *bodies])
    laws = {**LAWS, "impact": EnergeticImpact(0.0)}
    for body in bodies:
        system.contact(plate, body, **laws)
    for one, other in ((ball, capsule), (ball, ellipsoid), (cylinder, capsule), (cylinder, ellipsoid)):
        system.contact(one, other, **laws)
    system.contact(capsule, ellipsoid, **laws)
    places = {
        ball: (
            (-0.0053, 0.014, 0.017),
            (-0.629900103688797, -0.19573633870404603, -0.6577248346064688, 0.3637460474362174),
        ),
        cylinder: (
            (0.012, -0.013, 0.027),
            (0.1687967261260643, -0.14509511093277938, 0.30884358845731696, 0.9247003362718834),
        ),
        capsule: (
            (-0.0197, 0.0114, 0.0554),
            (0.28476897313630967, 0.4447834195835067, 0.7857821291456147, 0.3219018283854229),
        ),
        ellipsoid: (
            (0.025, -0.015, 0.064),
            (-0.8326859131720842, -0.1420421693352803, -0.45342436905188266, 0.28436689977070473),
        ),
    }
    for body, (position, orientation) in places.items():
        system.place(body, position=position, orientation=orientation)
    hinge = Hinge(
        first=(-0.0030235273014788643, -0.003992657626038455, 0.01586725139139334),
        second=(0.012938688364172186, -0.009290798787137797, 0.005810417479921659),
        axis=(-0.20076604399173797, 0.6587521973705279, -0.7250782978681739),
        second_axis=(0.2225493893645452, -0.7522466062358597, 0.6201586996084949),
    )
    system.joint(hinge, ball, cylinder)
    return system, bodies


def test_hinged_bodies_that_strike_each_other_stay_where_their_speeds_carry_them() -> None:
    """Between samples no body moves farther than its largest speed, gravity and vibration apart, carries it.

    A gap that is wrong at isolated poses, as that of a cylinder and an ellipsoid was here, may end the run by name.
    """
    system, bodies = _hinged()
    try:
        solution = ns.simulate(system, 0.15, sample_interval=1e-4)
    except ns.RunFailed as error:
        if "the gap is" not in str(error):
            raise
        solution = _kept(error)
    for body in bodies:
        q, u = solution.of(body)
        steps = np.linalg.norm(np.diff(q[:, :3], axis=0), axis=1)
        speeds = np.linalg.norm(u[:, :3], axis=1)
        assert np.all(steps <= 1.5e-4 * (np.maximum(speeds[1:], speeds[:-1]) + 1.0))
        np.testing.assert_allclose(np.linalg.norm(q[:, 3:], axis=1), 1.0, atol=1e-7)
