"""Random contact laws: every law of the package, alone or different from contact to contact."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from laws import (
    Anisotropic,
    Bristle,
    Cohesive,
    Coulomb,
    CoulombContensou,
    Directional,
    EnergeticImpact,
    Frictionless,
    HertzCompliant,
    HuntCrossley,
    JohnsonImpact,
    LankaraniNikravesh,
    LinearCompliant,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    RateAndState,
    Stribeck,
    StrongeImpact,
    Unilateral,
    ViscoelasticImpact,
    Viscous,
)
from nonsmooth import ContactLaws
from nonsmooth.interfaces import ImpactLaw, NormalLaw
from nonsmooth.interfaces.tangential_law import TangentialLaw
from tests.benchmarks.random_systems.solids import Random, number


def _restitution(random: Random) -> float:
    # the ends of the range are where laws change
    return float(random.choice([0.0, 0.5, 1.0])) if random.random() < 0.35 else number(random, 0.0, 1.0)


def _coulomb(random: Random) -> TangentialLaw:
    kinetic = number(random, 0.01, 1.0)
    return Coulomb(kinetic, number(random, kinetic, 1.3 * kinetic)) if random.random() < 0.3 else Coulomb(kinetic)


def _axis(random: Random) -> tuple[float, float, float]:
    if random.random() < 0.4:
        return (1.0, 0.0, 0.0)
    x, y, z = np.round(random.normal(size=3), 3).tolist()
    return x, y, z


def _stribeck(random: Random) -> TangentialLaw:
    static = number(random, 0.05, 1.0)
    return Stribeck(static, number(random, 0.1, 100.0), number(random, 0.0, static))


def _bristle(random: Random) -> TangentialLaw:
    kinetic = number(random, 0.05, 1.0)
    return Bristle(kinetic, number(random, kinetic, 1.5 * kinetic), stiffness=1e4, damping=number(random, 0.0, 2.0))


def _side(random: Random) -> Literal["first", "second"]:
    return "first" if random.random() < 0.5 else "second"


_FRICTION: tuple[tuple[float, Callable[[Random], TangentialLaw]], ...] = (
    (0.32, _coulomb),
    (0.15, lambda random: Frictionless()),
    (0.08, lambda r: Viscous(number(r, 0.0, 0.8), number(r, 0.0, 2.0), number(r, 0.8, 1.5))),
    (0.08, _stribeck),
    (0.08, lambda r: RateAndState(number(r, 0.1, 0.8), number(r, 0.0, 0.02), number(r, 0.0, 0.02), 1e-3, 1e-4)),
    (0.08, lambda r: Anisotropic(number(r, 0.05, 0.8), number(r, 0.05, 0.8), _axis(r), _side(r))),
    (
        0.08,
        lambda r: Directional(number(r, 0.05, 0.8), number(r, 0.05, 0.8), number(r, 0.05, 0.8), _axis(r), _side(r)),
    ),
)
_COMPLIANT_ONLY: tuple[Callable[[Random], TangentialLaw], ...] = (
    _bristle,
    lambda r: CoulombContensou(number(r, 0.05, 0.8), number(r, 0.0, 2e-3), number(r, 0.0, 5e-4), 1e-5),
)
_IMPACT: tuple[tuple[float, Callable[[Random], ImpactLaw]], ...] = (
    (0.38, lambda r: EnergeticImpact(_restitution(r), float(r.choice([1.0, 1.0, 3.0])), float(r.choice([1.0, 1.5])))),
    (0.08, lambda r: MonoStiffnessImpact(_restitution(r))),
    (0.08, lambda r: JohnsonImpact(number(r, 0.01, 0.5))),
    (0.08, lambda r: ViscoelasticImpact(number(r, 0.1, 5.0))),
    (0.1, lambda r: NewtonImpact(_restitution(r))),
    (0.08, lambda r: PoissonImpact(_restitution(r))),
    (0.09, lambda r: PlasticImpact()),
    (0.08, lambda r: MoreauImpact(_restitution(r), float(r.choice([0.0, 0.0, 0.5])))),
    (0.03, lambda r: StrongeImpact(_restitution(r))),
)


def _compliant(random: Random) -> NormalLaw:
    stiffness = float(f"{10.0 ** random.uniform(3.5, 5.5):.3g}")
    made: tuple[Callable[[], NormalLaw], ...] = (
        lambda: LinearCompliant(stiffness, number(random, 0.0, 5.0)),
        lambda: HertzCompliant(1e2 * stiffness),
        lambda: HuntCrossley(1e2 * stiffness, number(random, 0.01, 1.0)),
        lambda: LankaraniNikravesh(1e2 * stiffness, number(random, 0.5, 1.0)),
        lambda: Cohesive(stiffness, number(random, 0.0, 0.5), number(random, 0.0, 5.0)),
    )
    return made[int(random.integers(len(made)))]()


def _one_of(random: Random, table: tuple[tuple[float, Callable[[Random], object]], ...]) -> Callable[[Random], object]:
    weights = np.array([weight for weight, _ in table])
    return table[int(random.choice(len(table), p=weights / weights.sum()))][1]


def laws_of(random: Random) -> Callable[[], ContactLaws]:
    """Return what gives each contact of a system its laws: all have impact laws of one kind, as they must."""
    friction, impact = _one_of(random, _FRICTION), _one_of(random, _IMPACT)
    # more than two compliant contacts with static friction are refused: most get a friction without it
    compliant = random.random() < 0.12
    if compliant and random.random() < 0.85:
        friction = (_FRICTION[1][1], *_COMPLIANT_ONLY)[int(random.integers(3))]
    mixed, alike = random.random() < 0.25, random.random() < 0.6

    def draw() -> ContactLaws:
        way = _one_of(random, _FRICTION) if mixed and not compliant else friction
        normal = _compliant(random) if compliant else Unilateral()
        return ContactLaws(normal, way(random), None if compliant else impact(random))  # type: ignore[arg-type]

    first = draw()
    return (lambda: first) if alike and not mixed else draw
