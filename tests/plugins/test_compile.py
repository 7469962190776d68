"""What is compiled when: every component once; other numbers of them, other values, other sizes: nothing."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, final

import numba
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, Harmonic, Plate, Rest, RigidBody, Sphere, Spring
from laws import Coulomb, EnergeticImpact, NewtonImpact, Unilateral
from nonsmooth.binding import compile as compiling
from nonsmooth.binding.compile import bind
from nonsmooth.engine.native.kernel import PLAIN, address_of
from nonsmooth.interfaces import FrictionLaw


@contextlib.contextmanager
def _compilations(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """List what is compiled inside: functions that get an address, and all that numba works on, whoever asks."""
    found: list[str] = []

    def noted(shim: Callable[..., Any], form: str, key: str) -> int:
        found.append(form)
        return address_of(shim, form, key)

    with monkeypatch.context() as patch, contextlib.ExitStack() as stack:
        patch.setattr(compiling, "address_of", noted)
        if PLAIN:
            yield found
            return
        from numba.core import event

        passes = stack.enter_context(event.install_recorder("numba:run_pass"))
        yield found
        found += sorted({record.data["qualname"] for _, record in passes.buffer})


REST = Rest()


def _pile(radii: list[float], motion: Any = REST, friction: float = 0.3, restitution: float = 0.5) -> ns.Solution:
    """Drop balls over one another on a plate; all may touch all, the last two are tied, the last hangs on a spring."""
    plate, balls = Plate(motion), [Ball(radius) for radius in radii]
    system = ns.System([plate, *balls])
    laws: Any = {"normal": Unilateral(), "friction": Coulomb(friction), "impact": EnergeticImpact(restitution)}
    height = 0.0
    for i, ball in enumerate(balls):
        height += ball.radius + 1e-3
        for other in (plate, *balls[:i]):
            system.contact(other, ball, **laws)
        system.place(ball, position=(0.0, 0.0, height))
        height += ball.radius
    gap = balls[-1].radius + 1e-3
    system.joint(BallJoint((0.0, 0.0, balls[-2].radius), (0.0, 0.0, -gap)), balls[-2], balls[-1])
    spring = Spring(stiffness=friction, length=restitution, first=(0.0, 0.0, 1.0))
    system.load(spring, plate, balls[-1])
    return ns.simulate(system, 0.03)


def test_one_more_sphere_compiles_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor do other radii, so many that a broad phase sets in, other values of laws, motions, joints and loads."""
    _pile([0.01, 0.02])
    _pile([0.01, 0.02], Harmonic(1e-4, 25.0))
    for radii, values in (
        ([0.01, 0.02, 0.01], {}),
        ([0.015, 0.01, 0.02], {}),
        ([0.01, 0.02], {"friction": 0.1, "restitution": 0.9}),
        ([0.01, 0.02], {"motion": Harmonic(3e-4, 20.0)}),
        ([0.01] * 12, {}),
    ):
        with _compilations(monkeypatch) as compiled:
            solution = _pile(radii, **values)
        assert compiled == []
        assert len(solution.system.contacts) == len(radii) * (len(radii) + 1) / 2
        assert solution.counters.impacts > 0


def test_one_more_foot_compiles_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another number of contacts of one body, after Newton's law as a map of another size."""

    def run(feet: int) -> None:
        body = RigidBody(1.0, (1e-3, 1e-3, 1e-3), tuple(Sphere(0.01, 0.1 * i) for i in range(feet)))
        plate = Plate()
        system = ns.System([plate, body])
        system.contact(plate, body, normal=Unilateral(), friction=Coulomb(0.2), impact=NewtonImpact(0.5))
        system.place(body, position=(0.0, 0.0, 0.02))
        assert ns.simulate(system, 0.1).counters.impacts > 0

    run(1)
    with _compilations(monkeypatch) as compiled:
        run(4)
    assert compiled == []


def _made(offset: float) -> Callable[..., float]:
    """Return a closure: nothing of it is kept on disk, and it is new to every session."""

    def steady(speed: float, level: float) -> float:
        return offset + level

    return steady


_steady = _made(0.0)


@final
@dataclass(frozen=True)
class _Steady(FrictionLaw):
    """A law that no other test uses."""

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": 0.2}

    @property
    def coefficient(self) -> Callable[..., float]:
        """The same at all speeds."""
        return _steady

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def test_a_new_law_is_compiled_alone_and_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The counter counts: a law of the user's own is compiled on its first run, the engine is not."""

    def run() -> None:
        plate, ball = Plate(), Ball(0.01)
        system = ns.System([plate, ball])
        system.contact(plate, ball, normal=Unilateral(), friction=_Steady(), impact=EnergeticImpact(0.5))
        system.place(ball, position=(0.0, 0.0, 0.02), velocity=(0.1, 0.0, 0.0))
        ns.simulate(system, 0.1)

    _pile([0.01, 0.02])
    with _compilations(monkeypatch) as first:
        run()
    with _compilations(monkeypatch) as second:
        run()
    assert first == (["scalar"] if PLAIN else ["scalar", "_made.<locals>.steady", "shim"])
    assert second == []


@numba.njit  # type: ignore[untyped-decorator]
def _own(speed: float, level: float) -> float:
    return level + 0.1 * speed


def _calling(own: Callable[..., float]) -> Callable[..., float]:
    """Return a closure, which is compiled every time."""

    def law(speed: float, level: float) -> float:
        return max(own(speed, level), level)

    return law


@numba.njit  # type: ignore[untyped-decorator]
def _caller(level: float) -> float:
    return float(max(_own(2.0, level), level))


def test_what_numba_compiled_for_the_user_goes_on_as_it_was() -> None:
    """A law may call a function that Python, and other functions of the user, call compiled with the same types."""
    bind(_calling(_own), "scalar", {"level": 0.3}, "Own")
    assert _own(1.0, 0.3) == pytest.approx(0.4)
    assert _caller(0.3) == pytest.approx(0.5)
