"""What a user writes by hand: names, materials, starts, and every mistake by file, key, rule, value and remedy."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.files.reading import read

BALL = """
title = "A ball on a slope"
t_end = 0.2
gravity = 9.81

[laws.rubber]
type = "coulomb"
friction = 0.8

[bodies.floor]
type = "plate"
motion = { type = "rest", slope = 0.1 }

[bodies.ball]
type = "ball"
radius = 0.01
start = { place = "touching", velocity = [0.5, 0.0, 0.0] }

[[contacts]]
between = ["ball", "floor"]
normal = "unilateral"
friction = "rubber"
impact = { type = "energetic", restitution = 0.5 }
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return the path of a file with the text above."""
    made = tmp_path / "ball.toml"
    made.write_text(BALL)
    return made


def test_a_file_says_what_python_says(path: Path) -> None:
    setup = ns.load_system(path)
    floor, ball = Plate(Rest(slope=0.1)), Ball(radius=0.01)
    system = ns.System([floor, ball])
    system.contact(ball, floor, normal=Unilateral(), friction=Coulomb(0.8), impact=EnergeticImpact(restitution=0.5))
    ns.touching(system, ball, velocity=(0.5, 0.0, 0.0))
    assert (setup.title, setup.t_end, setup.sample_interval, setup.system.names.bodies) == (
        "A ball on a slope",
        0.2,
        None,
        ("floor", "ball"),
    )
    one, two = ns.simulate(system, 0.2), ns.simulate(setup.system, 0.2)
    assert np.array_equal(one.q, two.q)
    assert np.array_equal(one.u, two.u)


@pytest.mark.fast_cases(18)
@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        (
            "radius = 0.01",
            "radius = -1.0",
            "bodies.ball: Ball.radius must be > 0 [m], but it is -1.0. It is",
        ),
        ("radius = 0.01", 'radius = "0.01"', "but it is '0.01'. It is text: take off the quotes."),
        ("radius = 0.01", 'radius = "a"', "bodies.ball: Ball.radius must be a finite number, but it is 'a'."),
        ("radius = 0.01", "", "bodies.ball.radius must be given, but it is None. It is the radius [m]."),
        (
            "radius = 0.01",
            "radus = 0.01",
            "bodies.ball: unknown parameter of Ball 'radus'.",
        ),
        ('type = "ball"', 'type = "bal"', "bodies.ball.type: unknown body 'bal'."),
        ('type = "ball"', "", "bodies.ball.type must be a name, but it is"),
        (
            "slope = 0.1",
            "slope = 9.0",
            "bodies.floor.motion: Rest.slope must be >= -1.5708 and <=",
        ),
        (
            '"rest"',
            '"rst"',
            "bodies.floor.motion.type: unknown motion 'rst'. Did you mean 'rest'",
        ),
        (
            '"rubber"',
            '"ruber"',
            "contacts[0].friction: unknown law 'ruber'. Did you mean 'rubber'",
        ),
        ('"rubber"', '"newton"', "contacts[0].friction.type: unknown law 'newton'."),
        ("friction = 0.8", "friction = -0.8", "laws.rubber: Coulomb.friction must be >= 0 [1], but it is -0.8."),
        ('friction = "rubber"', "", "contacts[0].friction must be given, but it is None."),
        ('"floor"]', '"flor"]', "contacts[0]: unknown body 'flor'. Did you mean 'floor'"),
        ('["ball", "floor"]', '["ball"]', "contacts[0].between must be a list of 2 names, but it is ['ball']."),
        ('["ball", "floor"]', '["ball", "ball"]', "contacts[0]: System.contact needs two different bodies"),
        (
            "[[contacts]]",
            "\n[[contacs]]",
            ": unknown key 'contacs'. Did you mean 'contacts'",
        ),
        (
            'normal = "',
            'shapes = [[3], "all"]\nnormal = "',
            "contacts[0]: System.contact: shapes of Ball must be",
        ),
        ("t_end = 0.2", "t_end = 0", "t_end must be positive, but it is 0."),
        ("gravity = 9.81", "gravity = true", "gravity must be a finite number, but it is True."),
        ("gravity = 9.81", "gravity = 9.81 9", "must be TOML text"),
        (
            '"touching"',
            '"toching"',
            "bodies.ball.start: unknown place 'toching'. Did you mean",
        ),
        ("velocity", "velcity", "bodies.ball.start: start of Ball: unknown keyword 'velcity'."),
        (
            "gravity = 9.81",
            "[engine]\ntolerance = 1.0",
            "engine: EventDriven.tolerance must be > 0 and <=",
        ),
        (
            "gravity = 9.81",
            '[engine]\nsolver = "lemk"',
            "engine: unknown EventDriven.solver 'lemk'",
        ),
        (
            "gravity = 9.81",
            '[[joints]]\ntype = "hinge"',
            "joints[0].between must be a list of 2 names, but it is None.",
        ),
        (
            "gravity = 9.81",
            '[[joints]]\ntype = "hinge"\nbetween = ["ball", "floor"]\nfirst = [1.0]',
            "joints[0]: Hinge.first must be 3 finite numbers, but it is (1.0,).",
        ),
        ("radius = 0.01", 'radius = 0.01\nmaterial = "steel"', "materials must be given where bodies have one"),
    ],
)
def test_a_mistake_is_told_with_file_key_rule_value_and_remedy(path: Path, before: str, after: str, told: str) -> None:
    assert before in BALL
    path.write_text(
        BALL.replace(before, "", 1) + after if re.match(r"\[+[a-z]", after) else BALL.replace(before, after, 1)
    )
    with pytest.raises(ns.InvalidInput) as raised:
        ns.load_system(path)
    message = str(raised.value)
    assert message.startswith(str(path))
    assert told in message


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(ns.InvalidInput, match=r"must be a file that can be read, but it is '.*no.toml'"):
        ns.load_system(tmp_path / "no.toml")


def test_values_can_be_changed_by_key(path: Path) -> None:
    setup = read(
        path,
        False,
        {"bodies.ball.radius": "0.02", "contacts.0.impact.restitution": "0.25", "laws.rubber": "{type='frictionless'}"},
    )
    contact = setup.system.contacts[0]
    assert setup.system.bodies[1] == Ball(0.02)
    assert contact.impact == EnergeticImpact(0.25)
    assert contact.friction == Frictionless()
    for key in ("bodies.bal.radius", "contacts.1.impact", "t_end.x", "contacts.x.impact"):
        with pytest.raises(ns.InvalidInput, match=re.escape(f"{key} must be a key of {path}")):
            read(path, False, {key: "1"})


MATERIALS = """
[bodies.floor]
type = "plate"

[bodies.one]
type = "ball"
radius = 0.01
material = "steel"
start = { place = "at_height", height = 0.001 }

[bodies.two]
type = "ball"
radius = 0.01
material = "felt"
start = { position = [0.1, 0.0, 0.5] }

[bodies.three]
type = "ball"
radius = 0.01
start = { q = [0.2, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0], u = [0.0, 0.0, 0.25, 0.0, 0.0, 0.0] }

[materials]
exclude = [["two", "three"]]

[materials.default]
normal = "unilateral"
friction = "frictionless"
impact = { type = "energetic", restitution = 0.5 }

[[materials.pairs]]
between = ["steel", "felt"]
normal = "unilateral"
friction = { type = "coulomb", friction = 0.5 }
impact = { type = "energetic", restitution = 0.1 }
"""


def test_materials_and_starts(tmp_path: Path) -> None:
    path = tmp_path / "materials.toml"
    path.write_text(MATERIALS)
    system = ns.load_system(path).system
    found = {
        tuple(sorted((system.bodies.index(c.first), system.bodies.index(c.second)))): c.friction
        for c in system.contacts
        if c.first is system.bodies[0]
    }
    assert len(system.contacts) == 5
    assert all(law == Frictionless() for law in found.values())
    (felt,) = (c for c in system.contacts if c.friction == Coulomb(0.5))
    assert {id(felt.first), id(felt.second)} == {id(system.bodies[1]), id(system.bodies[2])}
    assert felt.impact == EnergeticImpact(0.1)
    assert system.start(system.bodies[1])[0][2] == pytest.approx(0.011, rel=1e-12)
    assert system.start(system.bodies[3])[1][2] == 0.25


def test_a_class_of_a_file_beside_it(path: Path) -> None:
    law = "class Ice(Frictionless.__base__):"
    source = f"""
from dataclasses import dataclass
from laws import Frictionless
from nonsmooth.parameters import parameter

def slippery(speed, friction):
    return friction

@dataclass(frozen=True)
{law}
    friction: float = parameter(0.01, doc="coefficient", minimum=0.0)

    @property
    def coefficient(self):
        return slippery

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        return True
"""
    (path.parent / "my_law.py").write_text(source)
    path.write_text(BALL.replace('type = "coulomb"\nfriction = 0.8', 'type = "my_law.py:Ice"\nfriction = 0.02'))
    with pytest.raises(ns.InvalidInput, match=r"but it is 'my_law\.py:Ice'.*say trust=True"):
        ns.load_system(path)
    contact = ns.load_system(path, trust=True).system.contacts[0]
    assert type(contact.friction).__name__ == "Ice"
    assert contact.friction.parameters() == {"friction": 0.02}


@pytest.mark.parametrize("ending", ["toml", "yaml"])
def test_lists_in_lists_without_end_are_refused(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"deep.{ending}"
    file.write_text(("bodies = " if ending == "toml" else "bodies: ") + "[" * 3000 + "]" * 3000)
    with pytest.raises(ns.InvalidInput, match=f"deep.{ending} must be"):
        ns.load_system(file)


def test_a_material_is_one_name(tmp_path: Path) -> None:
    file = tmp_path / "ball.toml"
    file.write_text('[bodies.ball]\ntype = "ball"\nradius = 0.01\nmaterial = ["steel"]\n')
    with pytest.raises(ns.InvalidInput, match=r"bodies\.ball\.material must be one name, but it is \['steel'\]"):
        ns.load_system(file)
