"""System and runs on bad input: nothing invalid gets past, and a law that fails is named."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Box, Coordinate, Dumbbell, GeneralisedBody, Harmonic, PlaneSphere, Plate, PointFrame, Sphere
from laws import Coulomb, EnergeticImpact, Frictionless, NewtonImpact, Unilateral
from nonsmooth.interfaces import FrictionLaw, ImpactProcess
from nonsmooth.parameters import parameter
from nonsmooth.system.contact import Contact


def _raises(words: tuple[str, ...], action: Callable[[], Any]) -> None:
    with pytest.raises(ns.InvalidInput) as caught:
        action()
    for word in words:
        assert word in str(caught.value)


def test_bodies_must_be_bodies(build: Any) -> None:
    """Each once, at least one, only bodies."""
    ball: Any = Ball(0.01)
    _raises(("System.bodies", "at least one body"), lambda: ns.System([]))
    _raises(("System.bodies", "each once", "Make a new object"), lambda: ns.System([ball, ball]))
    _raises(("System.bodies: each", "of the kind Body", "'ball'"), lambda: ns.System([ball, "ball"]))  # type: ignore[list-item]
    assert len(ns.System([ball, Ball(0.01)]).bodies) == 2


@pytest.mark.parametrize(
    "gravity",
    [math.nan, math.inf, 1e5, "9.81", None, True, (0.0, -9.81), (0.0, 0.0, math.nan), (1e5, 0.0, 0.0), "xyz", ("9", 0)],
)
def test_gravity_must_be_a_number_or_a_vector(gravity: Any) -> None:
    """Finite and of this world."""
    _raises(("System.gravity", "m/s^2"), lambda: ns.System([Ball(0.01)], gravity))


def test_a_negative_gravity_is_explained() -> None:
    """Many write the component, where the number is that along -z."""
    told = ("System.gravity", "must be >= 0", "counts along -z", "but it is -9.81", "Give 9.81", "(0.0, 0.0, 9.81)")
    _raises(told, lambda: ns.System([Ball(0.01)], -9.81))


@pytest.mark.parametrize("gravity", [(1.0, 2.0, -3.0), [1, 2, -3], np.array([1.0, 2.0, -3.0])])
def test_gravity_may_have_any_direction(gravity: Any) -> None:
    assert ns.System([Ball(0.01)], gravity).gravity == (1.0, 2.0, -3.0)
    assert ns.System([Ball(0.01)], 3.0).gravity == (0.0, 0.0, -3.0)


def test_a_ball_slides_down_oblique_gravity(build: Any) -> None:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball], (1.0, -2.0, -9.0))
    system.contact(plate, ball, **{**build.laws(), "friction": Frictionless()})
    system.place(ball, position=(0.0, 0.0, 0.01))
    assert ns.simulate(system, 0.5).u_end[:3] == pytest.approx([0.5, -1.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([Ball(0.01), Ball(0.02)], "Unpack a list of bodies by a star: System([plate, *balls])."),
        (Box(0.1, 0.1, 0.1), "That is a shape; take a body that has it: BoxBody or one of `nonsmooth list bodies`."),
        (Sphere(0.1), "That is a shape; take a body that has it: one of `nonsmooth list bodies`."),
        (Ball, "Make an object of the class: Ball(...)."),
        ("ball", "Give the object of a body."),
    ],
)
def test_what_is_no_body_is_told_what_to_give(given: Any, said: str) -> None:
    _raises(("System.bodies: each must be of the kind Body", said), lambda: ns.System([Plate(), given]))


def test_contacts_need_bodies_of_the_system(build: Any) -> None:
    """Two different ones, both known, of shapes that can meet."""
    plate, ball, other = Plate(), Ball(0.01), Ball(0.02)
    system = ns.System([plate, ball])
    laws = build.laws()
    _raises(("System.contact", "body of this system", "Add it"), lambda: system.contact(plate, other, **laws))
    _raises(("System.contact", "two different bodies"), lambda: system.contact(ball, ball, **laws))
    _raises(("System.place", "body of this system"), lambda: system.place(other, position=(0, 0, 1)))
    balls: Any = [ball, other]
    one_at_a_time = "Give one body at a time"
    _raises(("System.contact", one_at_a_time), lambda: system.contact(plate, balls, **laws))
    _raises(("System.place", one_at_a_time), lambda: system.place(balls, position=(0, 0, 1)))
    two = ns.System([plate, Plate()])
    _raises(("System.contact", "Plane-Plane", "Known pairs"), lambda: two.contact(*two.bodies, **laws))
    assert system.contacts == ()


def test_contacts_need_laws(build: Any) -> None:
    """All three, each of its kind."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    laws = build.laws()
    for name, kind in (("normal", "a NormalLaw"), ("friction", "a FrictionLaw"), ("impact", "an ImpactLaw")):
        for wrong in (None, 0.2, Ball(0.01)):
            words = ("System.contact", f"needs {kind}", "list laws")
            _raises(words, lambda name=name, wrong=wrong: system.contact(plate, ball, **(laws | {name: wrong})))  # type: ignore[misc]
    instead: tuple[tuple[dict[str, Any], str], ...] = (
        ({"normal": Coulomb(0.2), "friction": Unilateral()}, "normal needs a NormalLaw, but it is Coulomb"),
        ({"normal": Coulomb(0.2), "friction": Unilateral()}, "That is a law for friction=."),
        ({"friction": Unilateral()}, "That is a law for normal=."),
        ({"friction": 0.3}, "A number is no law: give it to one of `nonsmooth list laws`"),
        ({"normal": Unilateral}, "Make an object of the class: Unilateral(...)."),
    )
    for wrong_laws, said in instead:
        told = ("System.contact: ", said)
        _raises(told, lambda wrong=wrong_laws: system.contact(plate, ball, **(laws | wrong)))  # type: ignore[misc]
    words = ("System.contact", "needs an ImpactLaw", "list laws")
    _raises(words, lambda: system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2)))


def test_impact_laws_must_be_of_one_kind(build: Any) -> None:
    """An impact owns the whole colliding set."""
    plate, ball, other = Plate(), Ball(0.01), Ball(0.02)
    system = ns.System([plate, ball, other])
    system.contact(plate, ball, **build.laws())
    mixed = build.laws() | {"impact": NewtonImpact(0.5)}
    _raises(
        ("kind of EnergeticImpact", "NewtonImpact", "whole colliding set"),
        lambda: system.contact(plate, other, **mixed),
    )
    system.contact(plate, other, **build.laws(restitution=0.9))
    assert len(system.contacts) == 2


def _given(plate: Plate, ball: Ball, **changes: Any) -> Contact:
    """Return a contact of a plate and a ball with given kinematics."""
    shapes = plate.frames[0][0], ball.frames[0][0]
    laws = ns.ContactLaws(Unilateral(), Coulomb(0.2), EnergeticImpact(0.5))
    made = Contact.of_shapes((plate, ball), shapes, PlaneSphere.between(*shapes)[0], laws)
    return dataclasses.replace(made, **changes)


def test_a_contact_with_given_kinematics_is_that_of_installed_ones(build: Any) -> None:
    """The same motion, to the last bit; it is no contact of contact_all, no file can hold it, and it has its laws."""
    ends = []
    for is_given in (False, True):
        plate, ball = Plate(), Ball(0.01)
        system = ns.System([plate, ball])
        system.place(ball, position=(0.0, 0.0, 0.05), velocity=(0.1, 0.0, 0.0))
        if is_given:
            added = system.add_contact(_given(plate, ball))
            assert system.contacts == system.given_contacts == (added,)
            assert system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.2), EnergeticImpact(0.5))) == ()
        else:
            (added,) = system.contact(plate, ball, **build.laws())
        assert added.name == "plate - ball"
        ends.append(ns.simulate(system, 0.5).q_end.tolist())
    assert ends[0] == ends[1]
    _raises(("save_system", "System.add_contact"), lambda: ns.save_system(system, "system.toml", t_end=1.0))
    assert system.without_contacts().given_contacts == ()


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"first": Plate()}, "needs a body of this system"),
        ({"frames": (0, 1)}, "must be below 1 for ball"),
        ({"kinematics": "a plane and a sphere"}, "System.add_contact: kinematics"),
        ({"normal": Coulomb(0.2)}, "normal"),
        ({"impact": None}, "impact"),
        ({"name": "plate - ball"}, "must not have any of"),
    ],
)
def test_contacts_that_cannot_be_added(changes: dict[str, Any], told: str) -> None:
    """Bodies, frames, kinematics, laws and names are checked, and nothing is added."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    _raises((told,), lambda: system.add_contact(_given(plate, ball, **changes)))
    _raises(("System.add_contact", "Contact"), lambda: system.add_contact("a contact"))  # type: ignore[arg-type]
    _raises(("two different bodies",), lambda: system.add_contact(_given(plate, ball, second=plate)))
    assert system.contacts == ()


def test_a_dumbbell_has_two_contacts_whatever_the_order(build: Any) -> None:
    """The pair decides who is first: the normal points from the plate."""
    plate, body = Plate(), Dumbbell()
    for pair in ((plate, body), (body, plate)):
        system = ns.System([plate, body])
        contacts = system.contact(*pair, **build.laws())
        assert len(contacts) == 2
        assert all(contact.first is plate for contact in contacts)


def test_shapes_of_a_body_get_contacts_and_laws_of_their_own(build: Any) -> None:
    """Numbers count through all frames, in the order of the body; what has a contact already is refused again."""
    plate, body, other = Plate(), Dumbbell(), Dumbbell()
    system = ns.System([plate, body, other])
    last = system.contact(body, plate, shapes=((1,), None), **build.laws(friction=0.1))
    assert [contact.friction for contact in last] == [Coulomb(0.1)]
    again = ("System.contact", "shapes of them, that have no contact", "named by `shapes`")
    _raises(again, lambda: system.contact(plate, body, **build.laws()))
    _raises(again, lambda: system.contact(plate, body, shapes=(None, (0, 1)), **build.laws()))
    assert len(system.contacts) == 1
    first = system.contact(plate, body, shapes=(None, (0,)), **build.laws(friction=0.3))
    both = ns.System([plate, body]).contact(plate, body, **build.laws())
    assert [c.kinematics for c in (*first, *last)] == [c.kinematics for c in both]
    assert system.contacts == (*last, *first)
    crossed = system.contact(body, other, shapes=((1, 0), (1,)), **build.laws())
    all_four = ns.System([body, other]).contact(body, other, **build.laws())
    assert [c.kinematics for c in crossed] == [all_four[i].kinematics for i in (1, 3)]


def _height(q: Any, out: Any) -> None:
    out[2] = q[0]


def _unit(q: Any, out: Any) -> None:
    out[2] = 1.0


def _unit_mass(q: Any, out: Any) -> None:
    out[0] = 1.0


def _nothing(q: Any, u: Any, out: Any) -> None:
    pass


def _no_force(t: float, q: Any, u: Any, out: Any) -> None:
    pass


def _zero(q: Any) -> float:
    return 0.0


def test_shapes_are_counted_through_frames(build: Any) -> None:
    """The frame of a contact is the one that carries its shape."""
    frames = (PointFrame(_height, _unit, _nothing, (Sphere(r), Sphere(2.0 * r))) for r in (0.01, 0.03))
    plate, body = Plate(), GeneralisedBody((Coordinate("z", "m", 1.0),), _unit_mass, _no_force, _zero, tuple(frames))
    system = ns.System([plate, body])
    (contact,) = system.contact(plate, body, shapes=(None, (2,)), **build.laws())
    assert contact.frames == (0, 1)
    assert contact.kinematics.parameters()["radius"] == 0.03


@pytest.mark.parametrize("depth", [1e-3, 1e-6])
def test_overlap_at_the_start_is_refused(build: Any, depth: float) -> None:
    """The gap is named; touching is allowed."""
    ball = Ball(0.01)
    system = build.over(ball)
    system.place(ball, position=(0, 0, 0.01 - depth))
    _raises(
        ("start of the contact", "must not overlap", "its gap must be >= 0 [m], but it is -", "by System.place"),
        lambda: ns.simulate(system, 0.1),
    )
    system.place(ball, position=(0, 0, 0.01))
    assert ns.simulate(system, 0.01).status == "done"


@pytest.mark.parametrize("t_end", [0.0, -1.0, math.nan, math.inf])
def test_end_time_must_be_positive(build: Any, t_end: float) -> None:
    """And finite."""
    ball = Ball(0.01)
    system = build.over(ball)
    system.place(ball, position=(0, 0, 0.02))
    _raises(("simulate: t_end", "positive and finite", "[s]"), lambda: ns.simulate(system, t_end))
    _raises(("simulate: sample_interval",), lambda: ns.simulate(system, 0.1, sample_interval=t_end))


@pytest.mark.parametrize(
    ("option", "value"),
    [("tolerance", 0.0), ("tolerance", math.nan), ("impact_tolerance", 1.0), ("steps_per_period", 0.5)],
)
def test_options_are_checked(option: str, value: Any) -> None:
    """A tolerance that no step can meet is refused."""
    _raises((f"EventDriven.{option}",), lambda: ns.EventDriven(**{option: value}))


def _bad_force(indentation: float, threshold: float) -> float:
    return indentation if indentation < threshold else math.nan


def _one(rate: float) -> float:
    return 1.0


@final
@dataclass(frozen=True)
class BrokenImpact(ImpactProcess):
    """Returns a number that is not finite."""

    threshold: float = parameter(1e-9, doc="from here on it fails", unit="m")

    @property
    def force(self) -> Callable[..., float]:
        """Not finite."""
        return _bad_force

    @property
    def efficiency(self) -> Callable[..., float]:
        """Elastic."""
        return _one

    @property
    def contact_time(self) -> float:
        """Any."""
        return 1e-5

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Never."""
        return False


def _bad_friction(speed: float) -> float:
    return math.nan if speed > 1e-3 else 0.3


@final
@dataclass(frozen=True)
class BrokenFriction(FrictionLaw):
    """Fails as soon as something slips."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """Not finite under slip."""
        return _bad_friction

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Never."""
        return False


def test_an_impact_law_that_fails_is_named(build: Any) -> None:
    """RunFailed names the law and its file, and keeps what was computed."""
    body, plate = Dumbbell(), Plate()
    system = ns.System([plate, body])
    system.contact(plate, body, **(build.laws() | {"impact": BrokenImpact()}))
    system.place(body, position=(0, 0, 0.02))
    with pytest.raises(ns.RunFailed) as caught:
        ns.simulate(system, 0.2)
    message = str(caught.value)
    for word in ("BrokenImpact", "_bad_force", "test_system.py", "nan", "At t = 0.0"):
        assert word in message
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.status == "failed"
    assert 0.03 < solution.t_end < 0.06
    assert np.all(np.isfinite(solution.q))
    assert len(solution.t) > 100


def test_a_friction_law_that_fails_is_named(build: Any) -> None:
    """The same in sustained contact."""
    ball, plate = Ball(0.01), Plate()
    system = ns.System([plate, ball])
    system.contact(plate, ball, **(build.laws() | {"friction": BrokenFriction()}))
    system.place(ball, position=(0, 0, 0.01), velocity=(0.5, 0, 0))
    with pytest.raises(ns.RunFailed) as caught:
        ns.simulate(system, 0.2)
    for word in ("BrokenFriction", "_bad_friction", "test_system.py", "nan"):
        assert word in str(caught.value)


def test_a_parameter_nobody_gives_is_named(build: Any) -> None:
    """A law function that asks for a name its law does not have."""

    def force(indentation: float, stiffnes: float) -> float:
        return stiffnes * indentation

    @final
    @dataclass(frozen=True)
    class Misspelt(ImpactProcess):
        """Asks for `stiffnes`."""

        stiffness: float = parameter(1.0, doc="stiffness", unit="N/m")

        @property
        def force(self) -> Callable[..., float]:
            return force

        @property
        def efficiency(self) -> Callable[..., float]:
            return _one

        @property
        def contact_time(self) -> float:
            return 1e-5

        def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
            return False

    ball, plate = Ball(0.01), Plate()
    system = ns.System([plate, ball])
    system.contact(plate, ball, **(build.laws() | {"impact": Misspelt()}))
    system.place(ball, position=(0, 0, 0.02))
    with pytest.raises(ns.UnknownName, match="Did you mean 'stiffness'"):
        ns.simulate(system, 0.1)


def test_a_field_that_is_no_parameter_is_told_how_to_become_one(build: Any) -> None:
    @final
    @dataclass(frozen=True)
    class Plain(FrictionLaw):
        """Its coefficient is a field like any other."""

        k: float = 0.2

        @staticmethod
        def coefficient(speed: float, k: float) -> float:
            return k

        def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
            return True

    ball, plate = Ball(0.01), Plate()
    system = ns.System([plate, ball])
    system.contact(plate, ball, **(build.laws() | {"friction": Plain()}))
    system.place(ball, position=(0, 0, 0.02))
    with pytest.raises(ns.UnknownName, match="asks for: unknown parameter 'k'") as caught:
        ns.simulate(system, 0.1)
    assert 'declared as one: k: float = parameter(0.2, doc="what it is").' in str(caught.value)


MATRICES: dict[str, Any] = {
    "mass": np.eye(2),
    "normal": np.array([[1.0], [0.0]]),
    "tangential": np.array([[[0.0, 0.0]], [[1.0, 0.0]]]),
    "velocity": np.array([-1.0, 0.5]),
}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("mass", np.diag([1.0, -1.0])),
        ("mass", np.array([[1.0, 0.5], [0.0, 1.0]])),
        ("mass", np.eye(3)),
        ("normal", np.zeros((3, 1))),
        ("tangential", np.zeros((2, 1))),
        ("velocity", np.array([math.nan, 0.0])),
    ],
)
def test_one_impact_checks_its_matrices(name: str, value: Any) -> None:
    """Shape, symmetry, definiteness, finiteness."""
    laws: dict[str, Any] = {"impact": [EnergeticImpact(0.5)], "friction": [Coulomb(0.2)]}
    good, none = MATRICES | laws, MATRICES | laws | {"friction": []}
    _raises((f"solve_impact: {name}", "must be"), lambda: ns.solve_impact(**(good | {name: value})))
    _raises(("solve_impact: friction", "one law for each"), lambda: ns.solve_impact(**none))
    assert ns.solve_impact(**good).velocity[0] == pytest.approx(0.5)


def test_a_fast_plate_is_resolved(build: Any) -> None:
    """The shortest time scale of all bodies limits the step."""
    system = ns.System(
        [Plate(Harmonic(amplitude=1e-4, frequency=50.0)), Plate(Harmonic(amplitude=1e-4, frequency=20.0))]
    )
    assert system.time_scale == pytest.approx(0.02)
    assert system.n_degrees == 0
