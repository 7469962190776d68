"""Arguments of components that are missing, unknown, or of another length than one."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, ConstantVelocity, Hinge, LineBody, Wall
from laws import Coulomb, EnergeticImpact
from nonsmooth.errors import MissingArgument
from nonsmooth.interfaces import FrictionLaw, ImpactProcess
from nonsmooth.parameters import UnusualValue, parameter


def test_a_letter_is_answered_with_the_name() -> None:
    with pytest.raises(ns.UnknownName, match=r"Unknown parameter of Coulomb 'mu'\. It is called 'friction'\. Known: "):
        Coulomb(mu=0.3)  # type: ignore[call-arg]
    with pytest.raises(ns.UnknownName, match=r"'e'\. It is called 'restitution'"):
        EnergeticImpact(e=0.5)  # type: ignore[call-arg]


def test_a_missing_argument_is_named_with_its_unit() -> None:
    with pytest.raises(MissingArgument, match=r"^Ball.radius must be given. Write Ball\(radius=...\). .*\[m\]"):
        Ball()


def test_the_case_of_letters_does_not_hide_a_name() -> None:
    with pytest.raises(ns.UnknownName, match="Did you mean 'radius'"):
        Ball(Radius=0.1)  # type: ignore[call-arg]


def test_directions_may_have_any_length() -> None:
    assert Wall((3.0, 4.0, 0.0)).normal == (0.6, 0.8, 0.0)
    assert ns.turned_about((0.0, 0.0, 2.0), 0.3) == ns.turned_about((0.0, 0.0, 1.0), 0.3)
    one, other = (Hinge(axis=(0.0, size, 0.0)).rows for size in (1.0, 5.0))
    assert one == other
    for make in (_line_body, _constant_velocity):
        np.testing.assert_array_equal(make(1.0), make(2.0))


def _line_body(size: float) -> Any:
    return LineBody(1.0, (size, 0.0, 0.0)).parameters()["direction"]


def _constant_velocity(size: float) -> Any:
    return ConstantVelocity(axis=(size, 0.0, 0.0)).parameters()["axis"]


def test_a_warning_points_at_the_line_of_the_user(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("from bodies import Ball\n\nBall(20.0)\n")
    with pytest.warns(UnusualValue) as caught:
        runpy.run_path(str(script))
    assert (caught[0].filename, caught[0].lineno) == (str(script), 3)


class _Constant(FrictionLaw):
    """Base of the laws below."""

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        return True


def test_a_function_of_a_law_without_staticmethod_is_named() -> None:
    told = (
        r"^MyLaw\.coefficient must be a static method, but it is 'def coefficient\(self, speed, static\)'\. "
        r"Add @staticmethod above coefficient, and remove `self`: parameters of the class are arguments\.$"
    )
    with pytest.raises(ns.InvalidInput, match=told):

        class MyLaw(_Constant):
            static: float = parameter(0.3, doc="coefficient")

            def coefficient(self, speed: float, static: float) -> float:
                return static

    told = r"'def force\(time\)'\. Add @staticmethod above force\.$"
    with pytest.raises(ns.InvalidInput, match=told):

        class MyProcess(ImpactProcess):
            def force(time: float) -> float:  # type: ignore[misc]  # noqa: N805
                return time


def test_a_class_without_the_decorator_of_dataclasses_is_named() -> None:
    class Undecorated(_Constant):
        static: float = parameter(0.3, doc="coefficient")

        @staticmethod
        def coefficient(speed: float, static: float) -> float:
            return static

    class Derived(Coulomb):  # type: ignore[misc]
        factor: float = parameter(2.0, doc="a field that the constructor would not take")

    class WithoutFields(_Constant):
        @staticmethod
        def coefficient(speed: float) -> float:
            return 0.2

    for owner in (Undecorated, Derived):
        told = rf"^class {owner.__name__} must be a dataclass, .*\. Write @dataclass\(frozen=True\) above class"
        for given in ({}, {"friction": 0.2}):
            with pytest.raises(ns.InvalidInput, match=told):
                owner(**given)
    with pytest.raises(ns.InvalidInput, match=r"Write @dataclass\(frozen=True\) above class WithoutFields"):
        WithoutFields().numbers()
