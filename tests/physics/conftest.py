"""The compliant model in real time, integrated by scipy: the truth that the impact integrator is held against."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
COMPRESSION, EXPANSION, IDLE = "compression", "expansion", "idle"
STICK = 0


@dataclass(frozen=True)
class Law:
    """One contact of the compliant model: F = k x^eta, restitution, planar Coulomb friction."""

    restitution: float = 1.0
    stiffness: float = 1.0
    exponent: float = 1.5
    friction: float = 0.0
    static: float = 0.0


class Compliant:
    """Contacts with springs: x' = -g' in compression, -g'/e^2 in expansion; one tangent per contact."""

    def __init__(self, mass: ArrayLike, normal: ArrayLike, tangential: ArrayLike, laws: list[Law]) -> None:
        self.inverse = np.linalg.inv(np.asarray(mass, dtype=float))
        self.w, self.n = np.asarray(normal, dtype=float), np.asarray(tangential, dtype=float)
        self.laws, self.count = laws, len(laws)
        self.n_u = len(self.inverse)
        self.phases = self.compressions = self.changes = 0
        self._pull = np.zeros(self.count)

    def run(self, velocity: ArrayLike) -> Floats:
        """Return u after the impact."""
        from scipy.integrate import solve_ivp

        u = np.asarray(velocity, dtype=float)
        y = np.concatenate([u, np.zeros(self.count), np.zeros(2 * self.count)])
        rates = self.w.T @ u
        self.speed = float(np.max(-rates))
        g = np.diag(self.w.T @ self.inverse @ self.w)
        times = [
            (self.speed**2 / gi / law.stiffness) ** (1.0 / (law.exponent + 1.0)) / self.speed
            for gi, law in zip(g, self.laws, strict=True)
        ]
        self.force_scale = max(self.speed / gi / t for gi, t in zip(g, times, strict=True))
        self.phase = [COMPRESSION if r < 0.0 else IDLE for r in rates]
        self.compressions = self.phases = sum(p == COMPRESSION for p in self.phase)
        self.probe = 1e-6 * min(times)
        self.slip = [1.0] * self.count
        self._choose_friction(y)
        t = 0.0
        for _round in range(1000):
            if all(p == IDLE for p in self.phase):
                return y[: self.n_u]
            guards = [self._event(i) for i in range(3 * self.count)]
            found = solve_ivp(
                self._slope, (t, t + 1e3 * max(times)), y, "DOP853", events=guards,
                rtol=3e-14, atol=1e-16 * self.speed, max_step=0.05 * min(times),
            )  # fmt: skip
            fired = [i for i, times_found in enumerate(found.t_events) if len(times_found)]
            assert found.status == 1, "the impact does not end"
            t, y = float(found.t[-1]), found.y[:, -1]
            values, later = self._guards(y), self._guards(y + self.probe * self._slope(t, y))
            also = [
                i for i in range(3 * self.count)
                if i not in fired and values[i] < 1e-12 and later[i] < values[i] - 1e-14
            ]  # fmt: skip
            before, self._pull = list(self.slip), self.forces(y)[1]
            for i in [*fired, *also]:
                y = self._switch(y, i, before)
        raise AssertionError("the impact does not end")

    def _event(self, i: int) -> Callable[[float, Floats], float]:
        def guard(t: float, y: Floats) -> float:
            return float(self._guards(y)[i])

        guard.terminal, guard.direction = True, -1.0  # type: ignore[attr-defined]
        return guard

    def forces(self, y: Floats) -> tuple[Floats, Floats]:
        """Return normal and tangential forces."""
        x = y[self.n_u : self.n_u + self.count]
        f = np.array(
            [
                law.stiffness * max(xi, 0.0) ** law.exponent if p != IDLE else 0.0
                for xi, law, p in zip(x, self.laws, self.phase, strict=True)
            ]
        )
        return f, self._friction(f, self.slip)

    def _friction(self, f: Floats, slip: list[float]) -> Floats:
        t = np.array([-law.friction * fi * s for law, fi, s in zip(self.laws, f, slip, strict=True)])
        held = [i for i in range(self.count) if slip[i] == STICK]
        if held:
            n = self.n[:, held]
            drive = n.T @ self.inverse @ (self.w @ f + self.n @ t)
            t[held] = -np.linalg.lstsq(n.T @ self.inverse @ n, drive, rcond=1e-10)[0]
        return t

    def _margin(self, i: int, f: Floats, friction: Floats, slip: list[float]) -> float:
        """Return how far contact ``i`` is from its static bound; of a rank-deficient group, Eqs. (38), (39)."""
        held = [j for j in range(self.count) if slip[j] == STICK]
        if np.linalg.matrix_rank(self.n[:, held]) == len(held):
            held = [i]
        bound = min(self.laws[j].static for j in held) * f[held].sum()
        return float(bound - abs(friction[held].sum()))

    def _slope(self, t: float, y: Floats) -> Floats:
        f, friction = self.forces(y)
        rates = self.w.T @ y[: self.n_u]
        dx = [
            0.0 if p == IDLE else -r / (law.restitution**2 if p == EXPANSION else 1.0)
            for r, law, p in zip(rates, self.laws, self.phase, strict=True)
        ]
        return np.concatenate([self.inverse @ (self.w @ f + self.n @ friction), dx, f, friction])

    def _guards(self, y: Floats) -> Floats:
        f, friction = self.forces(y)
        u, x = y[: self.n_u], y[self.n_u :]
        rates, slips = self.w.T @ u / self.speed, self.n.T @ u / self.speed
        guards = np.ones(3 * self.count)
        for i, (law, phase) in enumerate(zip(self.laws, self.phase, strict=True)):
            guards[3 * i] = -rates[i] if phase == COMPRESSION else rates[i]
            if phase == EXPANSION:
                guards[3 * i + 1] = x[i] / self.speed
            if phase != IDLE and law.friction > 0.0:
                if self.slip[i] == STICK:
                    guards[3 * i + 2] = self._margin(i, f, friction, self.slip) / self.force_scale + 1e-13
                else:
                    guards[3 * i + 2] = slips[i] * self.slip[i]
        return guards

    def _switch(self, y: Floats, guard: int, before: list[float]) -> Floats:
        i, kind = divmod(guard, 3)
        y = y.copy()
        self.phases += 1
        if kind == 1:
            self.phase[i] = IDLE
            y[self.n_u + i] = 0.0
        elif kind == 0:
            fresh = self.phase[i] == IDLE
            self.phase[i] = EXPANSION if self.phase[i] == COMPRESSION else COMPRESSION
            self.compressions += self.phase[i] == COMPRESSION
            if fresh:
                self._choose_friction(y)
        elif self.phase[i] != IDLE and before[i] == STICK:
            self.slip[i] = -math.copysign(1.0, self._pull[i])
            self.changes += 1
        elif self.phase[i] != IDLE:
            self._choose_friction(y)
            self.changes += 1
        return y

    def _choose_friction(self, y: Floats) -> None:
        """Find, by trial of all combinations, who sticks and which way the others slide."""
        u = y[: self.n_u]
        slips, rates = self.n.T @ u, self.w.T @ u
        x = np.maximum(y[self.n_u : self.n_u + self.count], -self.probe * rates)
        f = np.array(
            [
                law.stiffness * max(xi, 0.0) ** law.exponent if p != IDLE else 0.0
                for xi, law, p in zip(x, self.laws, self.phase, strict=True)
            ]
        )
        resting = [i for i in range(self.count) if abs(slips[i]) <= 1e-9 * self.speed]
        choices: list[Any] = [
            (STICK, 1.0, -1.0) if i in resting and self.laws[i].friction > 0.0 and f[i] > 0.0
            else (math.copysign(1.0, slips[i]),)
            for i in range(self.count)
        ]  # fmt: skip
        for trial in itertools.product(*choices):
            friction = self._friction(f, list(trial))
            push = self.n.T @ self.inverse @ (self.w @ f + self.n @ friction)
            if all(
                self._margin(i, f, friction, list(trial)) >= -1e-12 * f[i] if trial[i] == STICK
                else i not in resting or f[i] == 0.0 or push[i] * trial[i] >= -1e-12 * abs(push).max()
                for i in range(self.count)
            ):  # fmt: skip
                self.slip = list(trial)
                return
        raise AssertionError("no consistent friction")


@pytest.fixture(scope="session")
def compliant() -> Callable[..., Any]:
    """Return a function of (M, W, N, u, laws) that gives u after and the model that was run."""

    def run(mass: Any, normal: Any, tangential: Any, velocity: Any, laws: list[Any]) -> tuple[Floats, Compliant]:
        model = Compliant(mass, normal, tangential, [Law(*law) for law in laws])
        return model.run(velocity), model

    return run


class Chain:
    """Balls on a line: matrices for one impact."""

    def __call__(self, masses: ArrayLike) -> tuple[Floats, Floats, Floats]:
        """Return M, W and a vanishing N."""
        mass = np.diag(np.asarray(masses, dtype=float))
        n = len(mass)
        normal = np.zeros((n, n - 1))
        for i in range(n - 1):
            normal[i, i], normal[i + 1, i] = -1.0, 1.0
        return mass, normal, np.zeros((n, n - 1, 2))


@pytest.fixture(scope="session")
def chain() -> Chain:
    """Return the builder of chains."""
    return Chain()


class DumbbellImpact:
    """A dumbbell of unit mass and ball radius: u = (v, angular velocity about x and -y, z), rod along x."""

    def __init__(self, aspect_ratio: float = 3.9, rod_mass_fraction: float = 0.0) -> None:
        x = rod_mass_fraction
        self.l = 2.0 * (aspect_ratio - 1.0)
        self.across = (1.0 - x) * (self.l**2 / 4.0 + 0.4) + x * (self.l - 2.0) ** 2 / 12.0
        self.along = (1.0 - x) * 0.4

    def __call__(self, shift: float = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return M, W and N of balls A and B, the contact points at -l/2 + shift and l/2 + shift."""
        a, b = shift - self.l / 2.0, shift + self.l / 2.0
        normal = np.array([[0.0, 0.0, 1.0, 0.0, x, 0.0] for x in (a, b)]).T
        first = np.array([[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]] * 2).T
        second = np.array([[0.0, 1.0, 0.0, 1.0, 0.0, x] for x in (a, b)]).T
        mass = np.diag([1.0, 1.0, 1.0, self.along, self.across, self.across])
        return mass, normal, np.stack([first, second], axis=2)


@pytest.fixture(scope="session")
def dumbbell_impact() -> type[DumbbellImpact]:
    """Return the builder of dumbbells in impact."""
    return DumbbellImpact
