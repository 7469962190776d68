"""Laws that cannot be compiled, or that fail in the middle of a run, and systems in which they do."""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, final

import nonsmooth as ns
from bodies import Ball, Dumbbell, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import (
    CompliantNormalLaw,
    FrictionLaw,
    ImpactMap,
    ImpactProcess,
    StatefulFrictionLaw,
    TractionLaw,
)
from nonsmooth.parameters import parameter

TABLE = {"static": 0.3, "kinetic": 0.2}
STEPS = (0.3, 0.25, 0.2)


@final
@dataclass(frozen=True)
class Friction(FrictionLaw):
    """Friction by a function of the test's."""

    function: Callable[..., float]
    level: float = parameter(0.2, doc="coefficient")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def coefficient(self) -> Callable[..., float]:
        """As given."""
        return self.function

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def _spring(indentation: float, level: float) -> float:
    return level * indentation


def _half(rate: float, level: float) -> float:
    return 1.0 if rate <= 0.0 else 0.5


@final
@dataclass(frozen=True)
class Process(ImpactProcess):
    """An impact process by functions of the test's."""

    force_of: Callable[..., float] = field(default=_spring)
    share_of: Callable[..., float] = field(default=_half)
    level: float = parameter(1.0, doc="stiffness")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def force(self) -> Callable[..., float]:
        """As given."""
        return self.force_of

    @property
    def efficiency(self) -> Callable[..., float]:
        """As given."""
        return self.share_of

    @property
    def contact_time(self) -> float:
        """Any."""
        return 1e-5

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Not asked for here."""
        return True


@final
@dataclass(frozen=True)
class Map(ImpactMap):
    """An impact map by a function of the test's."""

    function: Callable[..., None]
    level: float = parameter(0.5, doc="restitution")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def impulses(self) -> Callable[..., None]:
        """As given."""
        return self.function

    @property
    def contact_time(self) -> float:
        """Any."""
        return 1e-5

    def is_fulfilled(self, delassus: Any, before: Any, impulses: Any, friction: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def push_back(indentation: float, rate: float, closing_rate: float, level: float) -> float:
    """Push as a spring with damping."""
    return max(0.0, 1e5 * level * indentation * (1.0 + 0.5 * rate))


@final
@dataclass(frozen=True)
class Compliance(CompliantNormalLaw):
    """A compliant normal law by a function of the test's."""

    function: Callable[..., float] = field(default=push_back)
    level: float = parameter(1.0, doc="stiffness")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def force(self) -> Callable[..., float]:
        """As given."""
        return self.function

    @property
    def reach(self) -> float:
        """None."""
        return 0.0

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """Not asked for here."""
        return True


@compiled
def drag(normal_force: float, motion: Any, state: Any, out: Any, level: float) -> None:
    """Resist slip in proportion."""
    for i in range(5):
        out[i] = 0.0
    out[0], out[1] = -level * normal_force * motion[0], -level * normal_force * motion[1]


def by_drag(normal_force: float, motion: Any, state: Any, out: Any, level: float) -> None:
    """Do just that."""
    drag(normal_force, motion, state, out, level)


@final
@dataclass(frozen=True)
class Traction(TractionLaw):
    """A law of traction by a function of the test's."""

    function: Callable[..., None] = field(default=by_drag)
    level: float = parameter(1.0, doc="viscosity", unit="s/m")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def traction(self) -> Callable[..., None]:
        """As given."""
        return self.function

    @property
    def initial_state(self) -> tuple[float, ...]:
        """None."""
        return ()

    @property
    def state_scale(self) -> tuple[float, ...]:
        """None."""
        return ()

    def is_fulfilled(self, motion: Any, state: Any, normal_force: float, traction: Any, tolerance: float) -> bool:
        """Not asked for here."""
        return True


def remembering(speed: float, level: float, state: Any) -> float:
    """Grow with the state."""
    return float(level + 0.1 * state[0])


def settle(speed: float, state: Any, out: Any, level: float) -> None:
    """Follow the speed."""
    out[0] = 20.0 * (speed - state[0])


@final
@dataclass(frozen=True)
class Stateful(StatefulFrictionLaw):
    """Friction with a state, by functions of the test's."""

    function: Callable[..., float] = field(default=remembering)
    rates_by: Callable[..., None] = field(default=settle)
    level: float = parameter(0.2, doc="coefficient")

    def parameters(self) -> dict[str, float]:
        """Return the level."""
        return {"level": self.level}

    @property
    def coefficient(self) -> Callable[..., float]:
        """As given."""
        return self.function

    @property
    def rates(self) -> Callable[..., None]:
        """As given."""
        return self.rates_by

    @property
    def initial_state(self) -> tuple[float, ...]:
        """A speed."""
        return (0.1,)

    @property
    def state_scale(self) -> tuple[float, ...]:
        """Of slow slip."""
        return (0.1,)

    def is_fulfilled(
        self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float, state: Any = None
    ) -> bool:
        """Not asked for here."""
        return True


def sliding(friction: Any, t_end: float = 0.1) -> ns.Solution:
    """Let a ball slide on a plate at 0.5 m/s; the slip falls at 7 mu g / 2."""
    return _thrown({"friction": friction}, 0.0, t_end)


def bouncing(impact: Any, t_end: float = 0.3) -> ns.Solution:
    """Let a ball bounce from 1 cm: its impacts are at 0.443 m/s, and slower from time to time."""
    return _thrown({"impact": impact, "friction": Coulomb(0.2)}, 0.01, t_end)


def pressed(normal: Any = None, friction: Any = None) -> ns.Solution:
    """Let a ball that slides fall on a compliant plate from 1 mm."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=normal or Compliance(), friction=friction or Coulomb(0.2))
    system.place(ball, position=(0.0, 0.0, 0.011), velocity=(0.3, 0.0, 0.0))
    return ns.simulate(system, 0.1)


def bouncing_with(friction: Any, t_end: float = 0.3) -> ns.Solution:
    """Let it bounce with a friction law."""
    return _thrown({"friction": friction}, 0.01, t_end)


def falling_flat(impact: Any) -> ns.Solution:
    """Let a dumbbell fall flat, both ends at once; a contact alone would not ask for its force."""
    plate, body = Plate(), Dumbbell()
    system = ns.System([plate, body])
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(0.2), impact=impact)
    system.place(body, position=(0.0, 0.0, 0.02))
    return ns.simulate(system, 0.1)


def _thrown(laws: dict[str, Any], height: float, t_end: float) -> ns.Solution:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **({"normal": Unilateral(), "impact": EnergeticImpact(0.5)} | laws))
    system.place(ball, position=(0.0, 0.0, 0.01 + height), velocity=(0.5, 0.0, 0.0))
    return ns.simulate(system, t_end)


def falling(speed: float, level: float) -> float:
    """Return what the next three return, compiled."""
    return 0.3 if speed < 1e-9 else level + 0.1 * math.exp(-speed)


def by_dictionary(speed: float, level: float) -> float:
    """Look it up in a dictionary outside, which numba does not know."""
    return TABLE["static"] if speed < 1e-9 else level + 0.1 * math.exp(-speed)


def by_library(speed: float, level: float) -> float:
    """Ask a module that numba does not know."""
    return (0.3, level + 0.1 * math.exp(-speed))[bisect.bisect((1e-9,), speed)]


def by_import(speed: float, level: float) -> float:
    """Import, which numba cannot."""
    import cmath

    return 0.3 if speed < 1e-9 else level + 0.1 * cmath.exp(-speed).real


def no_number(speed: float, level: float) -> float:
    """Have none for slip between 0.3 and 0.31 m/s."""
    return math.nan if 0.3 < speed < 0.31 else level


def raising(speed: float, level: float) -> float:
    """Raise there."""
    if 0.3 < speed < 0.31:
        raise ValueError("no such speed")
    return level


def out_of_table(speed: float, level: float) -> float:
    """Look beyond the end of a tuple there."""
    return STEPS[3 if 0.3 < speed < 0.31 else 2]


def missing_key(speed: float, level: float) -> float:
    """Look for what is not there, in Python."""
    return TABLE["cinetic" if 0.3 < speed < 0.31 else "kinetic"]


def no_number_in_python(speed: float, level: float) -> float:
    """Have none there, in Python."""
    return TABLE["kinetic"] * (math.nan if 0.3 < speed < 0.31 else 1.0)


def returns_nothing(speed: float, level: float) -> Any:
    """Forget to return."""
    TABLE["kinetic"] * level


def of_a_stranger(speed: float, stranger: float) -> float:
    """Ask for what nobody has."""
    return stranger


def misspelt(speed: float, levle: float) -> float:
    """Ask for something misspelt."""
    return levle


def soft_and_lost(rate: float, level: float) -> float:
    """Have no share for slow impacts."""
    return math.nan if 0.05 < rate < 0.2 else 0.5 if rate > 0.0 else 1.0


def soft_and_raising(rate: float, level: float) -> float:
    """Raise for slow impacts."""
    if 0.05 < rate < 0.2:
        raise ArithmeticError("too slow")
    return 0.5 if rate > 0.0 else 1.0


def soft_and_silent(rate: float, level: float) -> float:
    """Have no share for fast impacts."""
    return math.nan if rate > 0.05 else 1.0


def stiff_and_lost(indentation: float, level: float) -> float:
    """Have no force far in."""
    return indentation if indentation < 1e-4 else math.nan


def soft_in_python(rate: float, level: float) -> float:
    """Raise for slow impacts, in Python."""
    return {"slow": 0.5}["fast" if 0.05 < rate < 0.2 else "slow"] if rate > 0.0 * TABLE["static"] else 1.0


def newton(n: int, delassus: Any, rates: Any, out: Any, friction: Any, level: Any) -> None:
    """Reverse the normal rate of one contact."""
    out[0] = -(1.0 + level[0]) * rates[0] / delassus[0]
    out[1] = out[2] = 0.0


def newton_in_python(n: int, delassus: Any, rates: Any, out: Any, friction: Any, level: Any) -> None:
    """Do the same with a dictionary outside."""
    out[0] = -(1.0 + level[0]) * rates[0] / delassus[0] * (TABLE["static"] / 0.3)
    out[1] = out[2] = 0.0


def newton_lost(n: int, delassus: Any, rates: Any, out: Any, friction: Any, level: Any) -> None:
    """Have no number for slow impacts."""
    out[0] = -(1.0 + level[0]) * rates[0] / delassus[0] if rates[0] < -0.3 else math.nan
    out[1] = out[2] = 0.0


def newton_raising(n: int, delassus: Any, rates: Any, out: Any, friction: Any, level: Any) -> None:
    """Raise for slow impacts."""
    if rates[0] > -0.3:
        raise ValueError("too slow")
    out[0] = -(1.0 + level[0]) * rates[0] / delassus[0]
    out[1] = out[2] = 0.0


def newton_misspelt(n: int, delassus: Any, rates: Any, out: Any, friction: Any, levle: Any) -> None:
    """Ask for something misspelt."""
    out[0] = levle[0]


def lost_deep(indentation: float, rate: float, closing_rate: float, level: float) -> float:
    """Have no force far in."""
    return 1e5 * level * indentation if 0.0 <= indentation < 2e-5 else math.nan if indentation > 0.0 else 0.0


def drag_lost(normal_force: float, motion: Any, state: Any, out: Any, level: float) -> None:
    """Have no force for slip below 0.29 m/s."""
    for i in range(5):
        out[i] = 0.0
    out[1] = -level * normal_force * motion[1]
    out[0] = -level * normal_force * motion[0] if motion[0] > 0.29 else math.nan


def settle_lost(speed: float, state: Any, out: Any, level: float) -> None:
    """Divide by zero for slow slip."""
    if speed < 0.3:
        raise ZeroDivisionError("slow")
    out[0] = speed


def remembering_lost(speed: float, level: float, state: Any) -> float:
    """Have no coefficient for slow slip."""
    return float(level + 0.1 * state[0]) if speed > 0.3 else math.nan
