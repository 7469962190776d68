"""Messages that the page "Stuck?" quotes are those of the program, apart from numbers."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, ConstantVelocity, DrivenBody, Hinge, Plate, Rest, Rod, Wall
from laws import (
    Bristle,
    Coulomb,
    EnergeticImpact,
    Frictionless,
    HuntCrossley,
    LinearCompliant,
    NewtonImpact,
    Unilateral,
)
from tests.physics.test_compliant_laws import box_on_an_edge

PAGE = Path(__file__).parents[2] / "docs" / "pages" / "stuck.md"
RIGID: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(0.5)}
TOO_LONG = (
    "RunFailed: At t = 0.507741939 s a gap differs from zero",
    "RunFailed: At t = ... s bodies passed into each other",
    "bodies passed into each other",
)
"""Beginnings of messages of which no short run is known: boxes in a gripper, bodies in each other."""

_QUOTE = re.compile(r"`([^`]+)`")
_NUMBER = re.compile(r"-?\d[\d.]*(?:e[+-]?\d+)?")
_MESSAGE_ROWS = ("you see", "message", "at the end")

NAN_LAW = '''"""A law without a value."""

import math
from dataclasses import dataclass
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter

@dataclass(frozen=True)
class NanLaw(FrictionLaw):
    a: float = parameter(0.3, doc="coefficient", minimum=0.0)

    @staticmethod
    def coefficient(speed, a):
        return a + math.sqrt(-speed)

    def is_fulfilled(self, *given):
        return True
'''


def _quotes() -> Iterator[str]:
    """All messages that the page quotes: in the first column of tables headed "you see", and in rows of that name."""
    heading = ""
    for line, below in zip(lines := PAGE.read_text(encoding="utf-8").splitlines(), [*lines[1:], ""], strict=True):
        if not line.startswith("|"):
            continue
        first, second = (cell.strip() for cell in line.split("|")[1:3])
        if below.startswith("|---"):
            heading = first
        elif heading == "you see" and not first.startswith("**silent**"):
            yield from _QUOTE.findall(first)
        elif first in _MESSAGE_ROWS:
            yield from _QUOTE.findall(second)


def _ball_on_plate(**laws: Any) -> tuple[ns.System, Ball]:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **RIGID | laws)
    return system, ball


def _forgotten() -> None:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.place(ball, position=(0.0, 0.0, 0.1))
    ns.simulate(system, 0.01)


def _forgotten_to_the_end() -> None:
    plate, one, two = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, one, two])
    system.contact(plate, one, **RIGID)
    system.place(one, position=(0.0, 0.0, 0.1))
    system.place(two, position=(0.1, 0.0, 0.1))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Bodies without any contact")
        ns.simulate(system, 1.0)


def _overlap() -> None:
    system, ball = _ball_on_plate()
    system.place(ball, position=(0.0, 0.0, 0.005))
    ns.simulate(system, 0.1)


def _stalled() -> None:
    floor, ball = Plate(), Ball(0.01)
    lid = Plate(Rest(position=(0.0, 0.0, 0.020000045), orientation=(0.0, 1.0, 0.0, 0.0)))
    system = ns.System([floor, lid, ball])
    for plate in (floor, lid):
        system.contact(plate, ball, **RIGID | {"impact": EnergeticImpact(1.0, duration=1e-3)})
    system.place(ball, position=(0.0, 0.0, 0.01 + 1.125e-8), velocity=(0.0, 0.0, 1.0))
    ns.simulate(system, 1.0)


def _hardly_passing() -> None:
    plate, hammer = Plate(), Ball(0.1)
    system = ns.System([plate, hammer], gravity=1e4)
    system.name(hammer, "hammer")
    system.contact(plate, hammer, **RIGID | {"impact": NewtonImpact(1.0, duration=1e-12)})
    system.place(hammer, position=(0.0, 0.0, 0.1), velocity=(0.0, 0.0, 1e-5))
    ns.simulate(system, 100.0)


def _coulomb_under_a_box() -> None:
    plate, box = Plate(), BoxBody(0.02, 0.02, 0.02)
    ns.System([plate, box]).contact(plate, box, normal=LinearCompliant(1e5, 10.0), friction=Coulomb(0.3))


def _contact_at_a_joint() -> None:
    wall, pivot, rod = Wall((1.0, 0.0, 0.0)), DrivenBody(), Rod(0.3, 0.005, mass=0.2)
    system = ns.System([wall, pivot, rod])
    system.joint(Hinge(first=(0.005, 0.0, 0.0), second=(-0.15, 0.0, 0.0)), pivot, rod)
    system.contact(wall, rod, **RIGID)
    system.place(rod, position=(0.155, 0.0, 0.0))
    ns.simulate(system, 0.1)


def _squeezed() -> None:
    floor, ball = Plate(), Ball(0.01)
    press = ConstantVelocity(position=(0.0, 0.0, 0.025), orientation=(0.0, 1.0, 0.0, 0.0), velocity=(0.0, 0.0, -0.1))
    lid = Plate(press)
    system = ns.System([floor, lid, ball])
    for plate in (floor, lid):
        system.contact(plate, ball, **RIGID)
    ns.touching(system, ball)
    ns.simulate(system, 0.1)


def _quaternion() -> None:
    box = BoxBody(1.0, 1.0, 1.0)
    ns.System([box]).place(box, orientation=(1.0, 2.0, 0.0, 0.0))


def _misspelt() -> None:
    system, ball = _ball_on_plate()
    system.place(ball, postion=(0.0, 0.0, 0.1))


def _without_friction() -> None:
    plate, ball = Plate(), Ball(0.01)
    ns.System([plate, ball]).contact(plate, ball, normal=Unilateral())  # type: ignore[call-arg]


CASES: tuple[Callable[[], Any], ...] = (
    _forgotten,
    _forgotten_to_the_end,
    _overlap,
    _stalled,
    lambda: ns.simulate(box_on_an_edge(11, 3e4), 0.05),
    lambda: ns.simulate(box_on_an_edge(0, 3e3), 0.05),
    _hardly_passing,
    _coulomb_under_a_box,
    lambda: _ball_on_plate(friction=Bristle(0.3, 0.4)),
    lambda: HuntCrossley(stiffness=300.0, dissipation=1.0),
    _contact_at_a_joint,
    _squeezed,
    _quaternion,
    lambda: Coulomb(mu=0.3),  # type: ignore[call-arg]
    lambda: EnergeticImpact(e=0.5),  # type: ignore[call-arg]
    _without_friction,
    lambda: _ball_on_plate(impact=None),
    _misspelt,
)
"""Each raises one of the messages, as warnings are errors in tests, or returns a suspect solution."""


def _message(case: Callable[[], Any]) -> str:
    try:
        return str(case())
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def _of_a_law(folder: Path) -> str:
    """Message about a law of a file that has no value."""
    file = folder / "nan.py"
    file.write_text(NAN_LAW, encoding="utf-8")
    specification = importlib.util.spec_from_file_location("nan", file)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)

    def case() -> None:
        system, ball = _ball_on_plate(friction=module.NanLaw())
        ns.touching(system, ball, velocity=(0.2, 0.0, 0.0))
        ns.simulate(system, 0.1)

    return _message(case).replace(f"{folder}/", "")


def _of_a_file(folder: Path) -> str:
    """Message about a file ``bodies.py`` next to the user's script."""
    (folder / "bodies.py").touch()
    (folder / "script.py").write_text("from bodies import Ball\n", encoding="utf-8")
    return subprocess.run([sys.executable, "script.py"], cwd=folder, capture_output=True, text=True).stderr


def _without_numbers(text: str) -> str:
    return _NUMBER.sub("N", text)


@pytest.mark.slow
def test_every_message_is_quoted_as_it_is_printed(tmp_path: Path) -> None:
    """An ellipsis in a quote stands for any text."""
    printed = [*map(_message, CASES), _of_a_law(tmp_path), _of_a_file(tmp_path)]
    texts = [_without_numbers(text) for text in printed]
    wrong = []
    for quote in _quotes():
        parts = [part.strip() for part in _without_numbers(quote).split("...")]
        if not (quote.startswith(TOO_LONG) or any(all(part in text for part in parts) for text in texts)):
            wrong.append(quote)
    assert wrong == []
