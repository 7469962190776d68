"""Impact laws with one fault each."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar

from laws import NewtonImpact
from nonsmooth.certificates import follows_map
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.parameters import parameter
from nonsmooth.types import Array, Floats

_newton: Any = compiled(NewtonImpact(0.5).impulses)
Certificate = Callable[[float, float, float, float], bool]


def spring(indentation: float) -> float:
    return indentation


def with_offset(indentation: float) -> float:
    return indentation + 1e-12


def giving_way(indentation: float) -> float:
    return indentation if indentation < 5.0 else 10.0 - 0.5 * indentation + 50.0 / indentation


def share(rate: float, restitution: float) -> float:
    return 1.0 if rate <= 0.0 else restitution * restitution


def lossy_compression(rate: float, restitution: float) -> float:
    return 0.999 if rate < -50.0 else share_of(rate, restitution)


share_of: Any = compiled(share)


def gaining(rate: float, restitution: float) -> float:
    return 1.2 if rate > 50.0 else share_of(rate, restitution)


def never_plastic(rate: float, restitution: float) -> float:
    return 1.0 if rate <= 0.0 else max(restitution * restitution, 1e-3)


def never_elastic(rate: float, restitution: float) -> float:
    return 1.0 if rate <= 0.0 else 0.98 * restitution * restitution


def exact(e: float, stored: float, returned: float, tolerance: float) -> bool:
    return abs(returned - e**2 * stored) <= tolerance


def no_more(e: float, stored: float, returned: float, tolerance: float) -> bool:
    return -tolerance <= returned <= stored + tolerance


def never(e: float, stored: float, returned: float, tolerance: float) -> bool:
    return False


def always(e: float, stored: float, returned: float, tolerance: float) -> bool:
    return True


@dataclass(frozen=True)
class Process(ImpactProcess):
    """A process put together from functions."""

    restitution: float = parameter(0.5, doc="restitution", minimum=0.0, maximum=1.0)
    spring: Callable[..., float] = spring
    shares: Callable[..., float] = share
    certificate: Certificate = exact
    duration: float = 2e-5

    @property
    def force(self) -> Callable[..., float]:
        return self.spring

    @property
    def efficiency(self) -> Callable[..., float]:
        return self.shares

    @property
    def contact_time(self) -> float:
        return self.duration

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        return self.certificate(self.restitution, stored, returned, tolerance)


def newton(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)


def weak(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2:
        for i in range(6):
            out[i] = 0.6 * out[i]


def strong(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2:
        for i in range(6):
            out[i] = 1.3 * out[i]


def sticky(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2:
        for i in range(2):
            out[3 * i + 1], out[3 * i + 2] = 1.2 * out[3 * i + 1], 1.2 * out[3 * i + 2]


def pushing(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2:
        for i in range(2):
            out[3 * i + 1], out[3 * i + 2] = -out[3 * i + 1], -out[3 * i + 2]


def weighing(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 1 and delassus[0] < 0.5:
        out[0] = 1.1 * out[0]


def fast(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2 and rates[0] < -7.0:
        out[0] = 1.01 * out[0]


def grooved(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2:
        out[2] = out[5] = 0.0


def ranked(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 2 and friction[0] < friction[1]:
        out[0] = 1.01 * out[0]


def viscous(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    for i in range(n):
        if friction[i] < 1e-3:
            out[3 * i + 1] -= 1e-3 * out[3 * i] * rates[3 * i + 1]


def half_rough(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    if n == 1:
        out[1], out[2] = 0.5 * out[1], 0.5 * out[2]


def adding(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    old = out[0]
    _newton(n, delassus, rates, out, friction, restitution)
    out[0] += old


def beyond(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats, restitution: Floats) -> None:
    _newton(n, delassus, rates, out, friction, restitution)
    out[3 * n] = 0.0


@dataclass(frozen=True)
class Map(ImpactMap):
    """Newton's law with a fault, or without."""

    departures: ClassVar[Mapping[str, str]] = NewtonImpact.departures
    restitution: float = parameter(0.5, doc="restitution", minimum=0.0, maximum=1.0)
    function: Callable[..., None] = newton
    judges: Callable[..., bool] = follows_map

    @property
    def impulses(self) -> Callable[..., None]:
        return self.function

    @property
    def contact_time(self) -> float:
        return 2e-5

    def is_fulfilled(self, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float) -> bool:
        return self.judges(self, delassus, before, impulses, friction, tolerance)


@dataclass(frozen=True)
class Plain(Map):
    """The same, said to be without faults."""

    departures: ClassVar[Mapping[str, str]] = MappingProxyType({})


@dataclass(frozen=True)
class Modest(Map):
    """One that says of itself what is not so."""

    departures: ClassVar[Mapping[str, str]] = MappingProxyType({"cone": "it is modest"})


@dataclass(frozen=True)
class Misspelt(Map):
    """One that departs from something that is no property."""

    departures: ClassVar[Mapping[str, str]] = MappingProxyType({**Map.departures, "dissipaton": "a slip of the pen"})


DUMMIES: list[tuple[str, ImpactLaw]] = [
    ("no approach after", Map(function=weak)),
    ("cone", Map(function=sticky)),
    ("dissipation", Map(function=strong)),
    ("dissipation with friction", Plain(function=pushing)),
    ("scaling of masses", Map(function=weighing)),
    ("scaling of velocities", Map(function=fast)),
    ("frame invariance", Map(function=grooved)),
    ("permutation", Map(function=ranked)),
    ("limit mu -> 0", Map(function=viscous)),
    ("force and impact level", Map(function=half_rough)),
    ("contact time", Process(duration=-1e-5)),
    ("contact time", Process(duration=math.nan)),
    ("no gain accepted", Process(certificate=always)),
    ("force", Process(spring=with_offset)),
    ("force", Process(spring=giving_way)),
    ("efficiency", Process(shares=lossy_compression)),
    ("efficiency", Process(shares=gaining)),
    ("certificate", Process(certificate=never)),
    ("writes its block", Map(function=adding)),
    ("writes its block", Map(function=beyond)),
    ("certificate", Map(judges=lambda *words: True)),
    ("certificate", Map(judges=lambda *words: False)),
    ("limit e -> 0", Process(shares=never_plastic, certificate=no_more)),
    ("limit e -> 1", Process(shares=never_elastic, certificate=no_more)),
]
