"""Bad input of every kind: each message names the thing, the rule, the value and the remedy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    BoxBody,
    Distance,
    Dumbbell,
    FreeBody,
    FunctionLoad,
    FunctionMotion,
    Harmonic,
    Hinge,
    LineBody,
    PlanarBody,
    Plate,
    RigidBody,
    Spring,
    Table,
)
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import FrictionLaw, ImpactProcess, Shape
from nonsmooth.parameters import parameter

Laws = dict[str, Any]


def _laws(**other: Any) -> Laws:
    return {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.5)} | other


def _contact(first: Any, second: Any, **laws: Any) -> None:
    ns.System([first, second]).contact(first, second, **_laws(**laws))


def _overlap() -> None:
    one, two = Ball(0.01), Ball(0.01)
    system = ns.System([one, two])
    system.contact(one, two, **_laws())
    system.place(two, position=(0.0, 0.0, 0.0195))
    ns.simulate(system, 0.1)


def _starts(q: Any = (0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0), u: Any = (0.0,) * 6, **times: Any) -> None:
    ball = Ball(0.01)
    system = ns.System([ball])
    system.set_start(ball, q, u)
    ns.simulate(system, times.pop("t_end", 0.1), **times)


def _placed(**start: Any) -> None:
    ball = Ball(0.01)
    system = ns.System([ball])
    system.place(ball, **start)
    ns.simulate(system, 0.1)


def _twice() -> None:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **_laws())
    system.contact(ball, plate, **_laws())


def _tied(*joints: Any, bodies: tuple[Any, ...] = (), **start: Any) -> None:
    ball = Ball(0.1)
    plates = bodies or (Plate(),) * len(joints)
    system = ns.System([*dict.fromkeys(plates, None), ball]) if bodies else ns.System([plates[0], ball])
    for plate, joint in zip(plates, joints, strict=True):
        system.joint(joint, plate, ball)
    system.place(ball, **start)
    ns.simulate(system, 0.1)


def _start(**words: Any) -> None:
    ball = Ball(0.01)
    ns.System([ball]).place(ball, **words)


def _still(t: float) -> Any:
    return 0.0, 0.0, 0.0


def _plane(t: float) -> Any:
    return 0.0, 0.0


def _number(t: float) -> Any:
    return 0.0


def _jumping(t: float) -> Any:
    return 0.0, 0.0, 0.0 if t < 0.5 else 1e-3


def _ending(t: float) -> Any:
    return 0.0, 0.0, 0.0 if t < 0.3 else math.nan


def _falling(t: float) -> Any:
    if t > 0.3:
        raise ValueError("no data")
    return 0.0, 0.0, 0.0


def _moving(t: float) -> Any:
    return 0.0, 0.0, t * t


def _motion(position: Any, velocity: Any = _still) -> FunctionMotion:
    return FunctionMotion(position, velocity, _still, duration=1.0, shortest_change=0.1)


@final
@dataclass(frozen=True)
class Ghost(FreeBody):
    """A free body without mass."""

    @property
    def total_mass(self) -> float:
        """None."""
        return 0.0

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Some."""
        return 1.0, 1.0, 1.0

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """None."""
        return ()


BAD: dict[str, tuple[Callable[[], Any], tuple[str, str, str, str]]] = {
    "overlap": (
        _overlap,
        ("start of the contact 'ball 1 - ball 2'", "must not overlap", "-0.0005", "Place the bodies"),
    ),
    "no density": (lambda: Ball(0.01, 0.0), ("Ball.density", "must be > 0 [kg/m^3]", "0.0", "It is the density")),
    "no mass": (lambda: RigidBody(0.0, (1, 1, 1)), ("RigidBody.mass", "must be > 0 [kg]", "0.0", "It is the mass")),
    "no inertia": (
        lambda: RigidBody(1.0, (0, 1, 1)),
        ("inertia of RigidBody", "must be positive definite", "[0.0, 0.0, 0.0]", "without extent has none"),
    ),
    "no mass on a line": (lambda: LineBody(mass=0.0), ("LineBody.mass", "must be > 0", "0.0", "It is the mass")),
    "no mass in a plane": (
        lambda: PlanarBody(mass=0.0, moment=1.0),
        ("PlanarBody.mass", "must be > 0", "0.0", "It is the mass"),
    ),
    "negative mass": (lambda: BoxBody(1, 1, 1, mass=-1.0), ("BoxBody.mass", "must be > 0", "-1.0", "instead of")),
    "a body's own mass": (Ghost, ("mass of Ghost", "must be positive", "0.0", "A body that moves has mass")),
    "joints apart": (
        lambda: _tied(BallJoint(), BallJoint(second=(0.0, 0.0, 0.4))),
        (
            "start of the joint 'ball joint plate - ball (2)'",
            "must have the residual 0",
            "[0.0, 0.0, 0.4]",
            "contradict",
        ),
    ),
    "joints moving apart": (
        lambda: _tied(BallJoint(), BallJoint(), bodies=(Plate(Harmonic(1e-3, 20.0)), Plate())),
        ("start of the joint 'ball joint plate 1 - ball'", "must have the rate 0", "-0.125", "contradict"),
    ),
    "a rod too long": (
        lambda: _tied(Distance(length=1.0), position=(0.0, 0.0, 0.9)),
        ("start of the joint 'distance plate - ball'", "must have the residual 0", "-0.09999", "Place the bodies"),
    ),
    "a long quaternion": (
        lambda: _starts(q=(0.0, 0.0, 0.1, 2.0, 0.0, 0.0, 0.0)),
        ("System.set_start: q of 'ball': the quaternion q[3:7]", "unit length", "2", "Divide"),
    ),
    "no quaternion": (
        lambda: _starts(q=(0.0,) * 7),
        ("System.set_start: q of 'ball': the quaternion q[3:7]", "unit length", "0", "Divide"),
    ),
    "a start of texts": (
        lambda: _starts(u=("0",) * 6),
        ("System.set_start: u", "must be an array of numbers", "'0'", "help"),
    ),
    "a place of texts": (lambda: _placed(position=("0", "0", "0.1")), ("position", "3 finite numbers", "'0.1'", "[m]")),
    "a place of truth values": (
        lambda: _placed(position=(True, False, True)),
        ("position", "3 finite numbers", "True", "[m]"),
    ),
    "a spin without an energy": (
        lambda: _placed(angular_velocity=(0.0, 0.0, 1e200)),
        ("start: the kinetic energy", "must be finite [J]", "inf", "slower"),
    ),
    "a speed without an energy": (
        lambda: _starts(u=(0.0, 0.0, 1e300, 0.0, 0.0, 0.0)),
        ("start: the kinetic energy", "must be finite [J]", "inf", "slower"),
    ),
    "a truth value for a time": (
        lambda: _starts(t_end=True),
        ("simulate: t_end", "positive and finite", "True", "[s]"),
    ),
    "more samples than memory": (
        lambda: _starts(sample_interval=1e-12),
        ("simulate: sample_interval", "at most 1e+08 samples within 0.1 s", "1e-12", "longer"),
    ),
    "samples without end": (
        lambda: _starts(sample_interval=1e-300),
        ("simulate: sample_interval", "at most 1e+08 samples", "1e-300", "longer"),
    ),
    "no axis": (lambda: Hinge(axis=(0.0, 0.0, 0.0)), ("Hinge.axis", "have a direction", "0.0, 0.0", "not zero")),
    "shapes nobody knows": (
        lambda: _contact(Plate(), Plate()),
        ("System.contact", "contact kinematics is known", "Plane-Plane", "Known pairs: "),
    ),
    "no shape": (
        lambda: _contact(Plate(), RigidBody(1.0, (1, 1, 1))),
        ("System.contact", "bodies that carry shapes", "RigidBody(mass=1.0", "Without a shape"),
    ),
    "shapes of no pair": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(0, 1)[:1]),
        ("System.contact: shapes", "must be a pair", "(0,)", "((0, 1), None)"),
    ),
    "shapes as a number": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(None, 1)),
        ("System.contact: shapes of Dumbbell", "None or a sequence of at least one number", "1", "all shapes"),
    ),
    "no shapes chosen": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(None, ())),
        ("System.contact: shapes of Dumbbell", "at least one number", "()", "None stands for"),
    ),
    "a shape that is none": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(None, (0, 2))),
        ("System.contact: shapes of Dumbbell", "whole numbers from 0, below 2", "2", "0: Sphere, 1: Sphere"),
    ),
    "a shape counted from the end": (
        lambda: _contact(Plate(), Dumbbell(), shapes=((-1,), None)),
        ("System.contact: shapes of Plate", "whole numbers from 0, below 1", "-1", "0: Plane"),
    ),
    "a shape by a truth value": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(None, (True,))),
        ("System.contact: shapes of Dumbbell", "whole numbers", "True", "0: Sphere"),
    ),
    "a shape twice": (
        lambda: _contact(Plate(), Dumbbell(), shapes=(None, (1, 1))),
        ("System.contact: shapes of Dumbbell", "every shape once", "(1, 1)", "Take the double one out"),
    ),
    "a contact twice": (
        _twice,
        ("System.contact", "no contact with each other yet", "('ball', 'plate')", "One call adds"),
    ),
    "no normal law": (lambda: _contact(Plate(), Ball(1), normal=None), ("System.contact", "NormalLaw", "None", "list")),
    "no friction law": (
        lambda: _contact(Plate(), Ball(1), friction=None),
        ("System.contact", "needs a FrictionLaw", "None", "nonsmooth list laws"),
    ),
    "no impact law": (
        lambda: _contact(Plate(), Ball(1), impact=0.5),
        ("System.contact", "needs an ImpactLaw", "0.5", "nonsmooth list laws"),
    ),
    "restitution": (
        lambda: EnergeticImpact(1.5),
        ("EnergeticImpact.restitution", ">= 0 and <= 1", "1.5", "energetic coefficient"),
    ),
    "friction": (lambda: Coulomb(-0.1), ("Coulomb.friction", "must be >= 0", "-0.1", "kinetic friction coefficient")),
    "a motion of two numbers": (
        lambda: _motion(_plane),
        ("FunctionMotion.position (_plane)", "a tuple of 3 numbers", "(0.0, 0.0)", "Write `return x, y, z`"),
    ),
    "a motion of one number": (
        lambda: _motion(_number),
        ("FunctionMotion.position (_number)", "a tuple of 3 numbers", "0.0", "Write `return x, y, z`"),
    ),
    "a motion that jumps": (
        lambda: _motion(_jumping),
        ("FunctionMotion.position (_jumping)", "must not jump at t = 0.5 s", "0.001", "round the corner off"),
    ),
    "a motion that ends": (
        lambda: _motion(_ending),
        ("FunctionMotion.position (_ending)", "must be finite (at t = 0.3", "nan", "division by zero"),
    ),
    "a motion that raises": (
        lambda: _motion(_falling),
        ("FunctionMotion.position (_falling)", "must return at t = 0.3", "ValueError('no data')", "Look at"),
    ),
    "a velocity of another motion": (
        lambda: _motion(_moving),
        ("FunctionMotion.velocity (_still)", "must be the derivative of", "[0.0, 0.0, 0.0]", "Differentiate again"),
    ),
    "a table that runs back": (
        lambda: Table((0.0, 0.2, 0.1, 0.3), ((0.0, 0.0, 0.0),) * 4),
        ("Table.times[2]", "must be above 0.2 [s]", "0.1", "Sort the rows by time"),
    ),
    "a word unknown": (lambda: _start(positon=(0, 0, 0)), ("start of Ball", "known", "'positon'", "'position'")),
    "half a position": (lambda: _start(position=(0, 0)), ("position of Ball", "3 finite numbers", "(0, 0)", "[m]")),
    "no direction": (
        lambda: _start(orientation=(1, 1, 0, 0)),
        ("orientation of Ball", "unit quaternion", "[1.0, 1.0, 0.0, 0.0]", "Divide it by its length 1.41421"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_each_message_names_thing_rule_value_and_remedy(case: str) -> None:
    """InvalidInput before anything runs."""
    action, words = BAD[case]
    with pytest.raises(ns.InvalidInput) as caught:
        action()
    error = caught.value
    thing, rule, value, remedy = words
    assert thing in error.thing
    assert rule in error.rule
    assert value in repr(error.value)
    assert remedy in error.remedy
    assert error.remedy
    if not isinstance(error, ns.UnknownName):
        assert str(error) == f"{error.thing} {error.rule}, but it is {error.value!r}. {error.remedy}"


def test_laws_cannot_be_left_out() -> None:
    """Python itself names those that are missing; whether an impact law is depends on the normal law."""
    plate, ball = Plate(), Ball(0.01)
    with pytest.raises(TypeError, match="'normal' and 'friction'"):
        ns.System([plate, ball]).contact(plate, ball)  # type: ignore[call-arg]


def _too_fast(speed: float, limit: float) -> float:
    if speed > limit:
        raise ValueError("too fast")
    return 0.3


@compiled
def _helper(speed: float) -> float:
    return 0.3 if speed < 0.37 else math.nan


def _with_helper(speed: float) -> float:
    return float(_helper(speed))


@final
@dataclass(frozen=True)
class Limited(FrictionLaw):
    """Friction that raises above a speed."""

    limit: float = parameter(0.4, doc="largest speed", unit="m/s")

    @property
    def coefficient(self) -> Callable[..., float]:
        """Raises."""
        return _too_fast

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


@final
@dataclass(frozen=True)
class Helped(FrictionLaw):
    """Friction whose compiled helper has no value above a speed."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """Calls the helper."""
        return _with_helper

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def _brittle(indentation: float) -> float:
    if indentation > 1e-9:
        raise ArithmeticError("broken")
    return indentation


def _whole(rate: float) -> float:
    return 1.0


@final
@dataclass(frozen=True)
class Brittle(ImpactProcess):
    """Raises where the contact is pressed in."""

    @property
    def force(self) -> Callable[..., float]:
        """Raises."""
        return _brittle

    @property
    def efficiency(self) -> Callable[..., float]:
        """Elastic."""
        return _whole

    @property
    def contact_time(self) -> float:
        """Any."""
        return 1e-5

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def _late(t: float, a: Any, b: Any, out: Any) -> None:
    for i in range(9):
        out[i] = 0.0
    if t > 0.05:
        raise ValueError("late")


def _after(t: float) -> Any:
    if t > 1.0:
        raise ValueError("over")
    return 0.0, 0.0, 0.0


def _run(height: float = 0.0, motion: Any = None, load: Any = None, t_end: float = 0.2, **laws: Any) -> ns.Solution:
    plate, ball = Plate(motion) if motion else Plate(), Dumbbell(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **_laws(**laws))
    system.place(ball, position=(0.0, 0.0, 0.01 + height), velocity=(0.5, 0.0, 0.0))
    if load:
        system.load(load, plate, ball)
    return ns.simulate(system, t_end)


HERE = "test_bad_input.py"
FAILING: dict[str, tuple[Callable[[], Any], float, tuple[str, ...]]] = {
    "friction raises": (
        lambda: _run(friction=Limited()),
        0.0,
        ("Limited: _too_fast", HERE, "raises ValueError('too fast')", "'limit': 0.4", "contact 'plate - dumbbell (1)'"),
    ),
    "friction has a helper": (
        lambda: _run(friction=Helped()),
        0.0,
        ("Helped: _with_helper", HERE, "returns "),
    ),
    "impact raises": (
        lambda: _run(1e-3, impact=Brittle()),
        math.sqrt(2e-3 / 9.81),
        ("Brittle: _brittle", HERE, "raises ArithmeticError('broken')"),
    ),
    "load raises": (
        lambda: _run(load=FunctionLoad(_late)),
        0.05,
        ("load 'function load plate - dumbbell'", "_late", HERE),
    ),
    "spring of no length": (
        lambda: _run(load=Spring(stiffness=1.0, length=0.1, first=(0.0, 0.0, 0.01))),
        0.0,
        ("load 'spring plate - dumbbell'", "spring.py"),
    ),
    "motion raises after its time": (
        lambda: _run(motion=_motion(_after), t_end=2.0),
        1.0,
        ("body 'plate', Plate(motion=FunctionMotion(", "_after", "at t = 1 s"),
    ),
}


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("case", FAILING)
def test_what_fails_in_a_run_is_named(case: str) -> None:
    """RunFailed says when, which function, what it gave, what to do; what was computed until then is kept."""
    action, time, words = FAILING[case]
    with pytest.raises(ns.RunFailed) as caught:
        action()
    message = str(caught.value)
    for word in (*words, "At t = ", "must return a finite number", "NONSMOOTH_PLAIN=1"):
        assert word in message
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.status == "failed"
    assert solution.t_end == pytest.approx(time, abs=1e-9)
