"""A system written to a file and read back is the same system, and its run the same run."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    Box,
    BoxBody,
    Bushing,
    Compound,
    ConstantVelocity,
    Distance,
    DrivenBody,
    Fixed,
    FunctionLoad,
    Hinge,
    LineBody,
    Part,
    PlanarBody,
    Plate,
    Point,
    Rest,
    RigidBody,
    Slider,
    Sphere,
    Spring,
    Table,
    TorsionSpring,
)
from laws import Coulomb, CoulombContensou, Directional, EnergeticImpact, Frictionless, HuntCrossley, Unilateral
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.plugins import registry

SCENARIOS = tuple(name for name in registry.names("scenarios") if name != "tiny")
LAWS: Any = {"normal": Unilateral(), "friction": Coulomb(0.1, 1.0 / 3.0), "impact": EnergeticImpact(0.7)}


def same(one: ns.System, other: ns.System) -> bool:
    """Tell whether two systems say the same, to the last bit."""
    places = [{id(body): i for i, body in enumerate(system.bodies)} for system in (one, other)]

    def ends(ties: Sequence[Any], known: dict[int, int]) -> list[Any]:
        return [(known[id(tie.first)], known[id(tie.second)]) for tie in ties]

    def told(contact: Any) -> tuple[Any, ...]:
        search = contact.kinematics.candidates
        given = () if search is None else (search.function, search.values, search.counts)
        return dataclasses.replace(contact.kinematics, candidates=None), *given

    return (
        one.names == other.names
        and one.bodies == other.bodies
        and one.gravity == other.gravity
        and one.guards == other.guards
        and all(
            ends(getattr(one, kind), places[0]) == ends(getattr(other, kind), places[1])
            for kind in ("contacts", "joints", "loads")
        )
        and all(
            [getattr(contact, part) for contact in one.contacts]
            == [getattr(contact, part) for contact in other.contacts]
            for part in ("frames", "extents", "normal", "friction", "impact")
        )
        and list(map(told, one.contacts)) == list(map(told, other.contacts))
        and [(t.component, t.frames) for t in one.joints + one.loads]
        == [(t.component, t.frames) for t in other.joints + other.loads]
        and all(
            np.array_equal(x, y)
            for a, b in zip(one.bodies, other.bodies, strict=True)
            for x, y in zip(one.start(a), other.start(b), strict=True)
        )
    )


@pytest.mark.fast_cases(9)
@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_comes_back(name: str, tmp_path: Path) -> None:
    system = registry.load("scenarios", name)().build()
    ns.save_system(system, tmp_path / "one.toml")
    read = ns.load_system(tmp_path / "one.toml")
    assert same(system, read.system)
    assert same(system, read.build())
    ns.save_system(read.system, tmp_path / "two.toml")
    assert (tmp_path / "one.toml").read_text() == (tmp_path / "two.toml").read_text()


@pytest.mark.parametrize(
    ("name", "t_end"),
    [
        ("dumbbell", 0.3),
        ("block_on_belt", 5.0),
        ("rolling_disc", 0.3),
        ("newtons_cradle", 0.2),
        ("tippe_top", 0.2),
        ("two_link_arm", 0.2),
    ],
)
def test_a_run_from_a_file_is_the_run_from_python(name: str, t_end: float, tmp_path: Path) -> None:
    scenario = registry.load("scenarios", name)()
    engine = ns.EventDriven(tolerance=1e-8, solver="enumeration")
    system, interval = scenario.build(), t_end / 50.0
    ns.save_system(system, tmp_path / "one.toml", t_end=t_end, sample_interval=interval, engine=engine)
    read = ns.load_system(tmp_path / "one.toml")
    assert (read.t_end, read.sample_interval, read.engine) == (t_end, interval, engine)
    one = ns.simulate(system, t_end, sample_interval=interval, engine=engine)
    two = ns.simulate(read.system, t_end, sample_interval=interval, engine=engine)
    for part in ("t", "q", "u", "q_end", "u_end"):
        assert np.array_equal(getattr(one, part), getattr(two, part)), part
    assert np.array_equal(one.events.time, two.events.time)
    assert np.array_equal(one.events.impulse, two.events.impulse)
    assert one.energy == two.energy


def _varied() -> ns.System:
    """Return a system with a little of everything, its numbers without a short decimal form."""
    third, half = 1.0 / 3.0, math.sqrt(0.5)
    turn = (math.cos(0.3), math.sin(0.3), 0.0, 0.0)
    floor = Plate(Table((0.0, third, 1.0), ((0.0, 0.0, 0.0), (0.1, 0.0, third), (0.0, 0.0, 0.0)), True, turn))
    wall = DrivenBody(ConstantVelocity(rate=0.1, axis=(0.6, 0.0, 0.8), position=(5.0, 0.0, 0.0)), (Sphere(0.1),))
    rigid = RigidBody(
        0.3, ((2.0, 0.1, 0.0), (0.1, 2.0, third), (0.0, third, 3.0)), (Sphere(0.1, x=third), Point(z=-0.2))
    )
    compound = Compound((Part(Ball(0.1)), Part(BoxBody(0.1, 0.2, third), (0.2, 0.0, third), turn)))
    slider = LineBody(1.0, (half, 0.0, half), (Box(0.1, 0.1, 0.1, orientation_w=half, orientation_y=half),))
    planar = PlanarBody(1.0, 0.1, (Point(),), y=3.0)
    bodies = [floor, wall, rigid, compound, slider, planar]
    system = ns.System(bodies, gravity=1.62)
    system.name(rigid, "a body of mine")
    system.contact(floor, rigid, **LAWS, shapes=(None, (1,)), name="foot")
    system.contact(floor, rigid, **LAWS | {"friction": Frictionless()}, shapes=((0,), (0,)))
    system.contact(planar, floor, **LAWS | {"friction": Coulomb(0.2)})
    for i, joint in enumerate((BallJoint(), Hinge((third, 0.0, 0.0)), Fixed(), Distance(length=third), Slider())):
        system.joint(joint, bodies[i % 2], bodies[2 + i % 4], name="elbow" if i == 1 else "")
    for load in (Spring(1.0, third), TorsionSpring(third), Bushing(third)):
        system.load(load, wall, compound)
    system.place(rigid, position=(0.0, 0.1, third), orientation=turn, angular_velocity=(third, 0.0, 0.0))
    return system


@pytest.mark.parametrize("gravity", [0.0, 1.62, (0.1, 0.0, -9.8), (0.0, 0.0, 9.81)])
def test_gravity_comes_back(tmp_path: Path, gravity: float | tuple[float, float, float]) -> None:
    system = ns.System([Ball(0.01)], gravity)
    ns.save_system(system, tmp_path / "one.toml")
    assert ns.load_system(tmp_path / "one.toml").system.gravity == system.gravity


def test_joints_loads_shapes_and_nested_bodies_come_back(tmp_path: Path) -> None:
    system = _varied()
    path = tmp_path / "one.toml"
    ns.save_system(system, path, title='a "quoted" title\twith a tab \\ and µ')
    read = ns.load_system(path)
    assert same(system, read.system)
    assert read.title == 'a "quoted" title\twith a tab \\ and µ'


class _Own(FrictionLaw):
    @property
    def coefficient(self) -> Any:
        return None

    def is_fulfilled(self, *state: Any) -> bool:
        return True


def _nothing(t: float, a: Any, b: Any, out: Any) -> None:
    pass


def _of_another() -> Any:
    def hidden(t: float, a: Any, b: Any, out: Any) -> None:
        pass

    return hidden


def test_a_function_goes_by_its_name(tmp_path: Path) -> None:
    """It is the same function; what the name does not mean is told."""
    floor, ball = Plate(), Ball(0.1)
    system = ns.System([floor, ball])
    system.load(FunctionLoad(_nothing), floor, ball)
    path = tmp_path / "one.toml"
    ns.save_system(system, path)
    said = path.read_text()
    assert 'function = "tests.files.test_round_trip:_nothing"' in said
    with pytest.raises(ns.InvalidInput, match=r"as the file is not trusted.*_nothing.*say trust=True"):
        ns.load_system(path)
    found = ns.load_system(path, trust=True).system.loads[0].component
    assert isinstance(found, FunctionLoad)
    assert found.function is _nothing
    for wrong, told in (
        ("_nothing_else", "Did you mean '_nothing'"),
        ("WRONG", "unknown name"),
        ("Ball", "must name a plain Python function"),
    ):
        path.write_text(said.replace(":_nothing", f":{wrong}"))
        with pytest.raises(ns.InvalidInput, match=told):
            ns.load_system(path, trust=True)
    path.write_text(said.replace("tests.files.test_round_trip:_nothing", "just a word"))
    with pytest.raises(ns.InvalidInput, match=r"loads\[0\].function must have the form module:name"):
        ns.load_system(path, trust=True)
    path.write_text(said.replace("tests.files.test_round_trip", "no_such_module"))
    with pytest.raises(ns.PluginError, match="no_such_module:_nothing cannot be imported: ModuleNotFoundError"):
        ns.load_system(path, trust=True)


def test_laws_of_compliant_contacts_come_back(tmp_path: Path) -> None:
    """Without an impact law, and with axes and words among the parameters."""
    plate, ball, other = Plate(), Ball(0.01), Ball(0.02)
    system = ns.System([plate, ball, other])
    system.contact(plate, ball, normal=HuntCrossley(1e9, 0.3), friction=CoulombContensou(0.2, 1e-4))
    fur = Directional(0.1, 0.3, 0.2, axis=(0.0, 1.0, 0.0), body="first")
    system.contact(plate, other, **LAWS | {"friction": fur})
    system.place(other, position=(0.1, 0.0, 0.1))
    path = tmp_path / "system.toml"
    ns.save_system(system, path, t_end=1.0)
    assert same(system, ns.load_system(path).system)


def test_what_is_not_installed_or_is_a_function_is_refused_by_name(tmp_path: Path) -> None:
    floor, ball = Plate(), Ball(0.1)
    system = ns.System([floor, ball])
    system.contact(floor, ball, **LAWS | {"friction": _Own()})
    with pytest.raises(
        ns.InvalidInput, match=r"contacts\[0\].friction must be of an installed class.* but it is '_Own'"
    ):
        ns.save_system(system, tmp_path / "one.toml")
    for function in (_of_another(), lambda t, a, b, out: None):
        system = ns.System([floor, ball])
        system.load(FunctionLoad(function), floor, ball)
        with pytest.raises(ns.InvalidInput, match=r"loads\[0\].function must be importable by its name .*<locals>"):
            ns.save_system(system, tmp_path / "one.toml")
    system = ns.System([floor, ball])
    system.load(FunctionLoad(_nothing, {"tool": object()}), floor, ball)  # type: ignore[dict-item]
    with pytest.raises(ns.InvalidInput, match=r"loads\[0\].constants.tool must be made of numbers"):
        ns.save_system(system, tmp_path / "one.toml")


def test_with_laws_changes_the_laws_and_nothing_else() -> None:
    system = _varied()
    assert same(system, ns.with_laws(system))
    other = ns.with_laws(system, friction=Coulomb(0.9))
    assert {contact.friction for contact in other.contacts} == {Coulomb(0.9)}
    assert [c.impact for c in other.contacts] == [c.impact for c in system.contacts]
    assert same(system, _varied())
    with pytest.raises(ns.InvalidInput, match="needs a system with contacts"):
        ns.with_laws(ns.System([Plate(Rest())]), friction=Coulomb(0.1))
