"""The dumbbell's matrices, derived from energy and geometry, against the engine's quaternion quantities."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from bodies import Dumbbell, Harmonic
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.model.assembly import assemble

NAMES = ("x1", "y1", "z1", "theta", "beta", "gamma")
GRAVITY = 9.81


class Derivation:
    """The paper's coordinates in symbols: Eqs. (2)-(13) from the geometry alone."""

    def __init__(self) -> None:
        self.time = sp.Symbol("t")
        self.m, self.length, self.r, self.j1, self.j2, self.g = sp.symbols("m l r J1 J2 g", positive=True)
        self.q = sp.Matrix(sp.symbols(" ".join(NAMES)))
        self.v = sp.Matrix(sp.symbols(" ".join(f"d{n}" for n in NAMES)))
        theta, beta, gamma = self.q[3:]
        turn = sp.rot_axis3(-(sp.pi / 2 + theta)) * sp.rot_axis2(beta) * sp.rot_axis1(-gamma)
        self.axes = sp.expand(turn)
        spin = self.axes.T * self.rate(self.axes)
        # the body components of the angular velocity, from R^T R'
        self.omega = sp.simplify(sp.Matrix([spin[2, 1], spin[0, 2], spin[1, 0]]))
        first = sp.Matrix(self.q[:3])
        self.centre = first + self.length / 2 * self.axes[:, 0]
        self.centre_velocity = self.rate(self.centre)
        inertia = sp.diag(self.j2, self.j1, self.j1)
        self.kinetic = (
            self.m * (self.centre_velocity.T * self.centre_velocity)[0] + (self.omega.T * inertia * self.omega)[0]
        ) / 2
        self.potential = self.m * self.g * self.centre[2]
        self.mass = sp.hessian(self.kinetic, list(self.v))
        down = sp.Matrix([0, 0, -self.r])
        arms = (down, self.length * self.axes[:, 0] + down)
        world = self.axes * self.omega
        points = [self.rate(first) + world.cross(arm) for arm in arms]
        gaps = sp.Matrix([(first + arm)[2] for arm in arms])
        self.normal = gaps.jacobian(self.q).T
        self.slip = [sp.Matrix(p[:2]).jacobian(self.v).T for p in points]
        self.normal_bias = self.rate(self.normal.T) * self.v
        self.slip_bias = [self.rate(n.T) * self.v for n in self.slip]
        self.force = -sp.Matrix([self.potential]).jacobian(self.q).T
        momenta = sp.Matrix([self.kinetic]).jacobian(self.v).T
        # Euler-Lagrange: M q'' = Q + h
        self.inertial = sp.Matrix([self.kinetic]).jacobian(self.q).T - self.rate(momenta)
        self.map = sp.Matrix.vstack(self.centre_velocity, self.omega).jacobian(self.v)
        self.map_rate_v = self.rate(self.map) * self.v

    def rate(self, expression: Any) -> Any:
        """Return the part of the time derivative that needs no acceleration."""
        return expression.applyfunc(
            lambda entry: sum(sp.diff(entry, a) * b for a, b in zip(self.q, self.v, strict=True))
        )

    def function(self) -> Any:
        """Return everything as one function of (q, q', m, l, r, J1, J2, g)."""
        arguments = [*self.q, *self.v, self.m, self.length, self.r, self.j1, self.j2, self.g]
        outputs = [
            self.mass,
            self.normal,
            sp.Matrix.hstack(*self.slip),
            self.normal_bias,
            sp.Matrix.vstack(*self.slip_bias),
            self.force + self.inertial,
            self.map,
            self.map_rate_v,
            self.axes,
            self.centre,
        ]
        return sp.lambdify(arguments, outputs, "numpy", cse=True)


@pytest.fixture(scope="module")
def paper() -> Derivation:
    """Derive once."""
    return Derivation()


@pytest.fixture(scope="module")
def numbers(paper: Derivation) -> Any:
    """Return the derived quantities as one numerical function."""
    return paper.function()


def _zero(matrix: Any) -> bool:
    return bool(sp.simplify(matrix) == sp.zeros(*matrix.shape))


@pytest.mark.slow
def test_rotation_is_equation_2_and_angular_velocity_equation_3(paper: Derivation) -> None:
    """The columns of Eq. (2), and omega = theta' k - beta' e2' + gamma' e1."""
    theta, beta, gamma = paper.q[3:]
    st_, ct, sb, cb, sg, cg = (f(a) for a in (theta, beta, gamma) for f in (sp.sin, sp.cos))
    printed = sp.Matrix(
        [
            [-st_ * cb, -ct * cg + st_ * sb * sg, ct * sg + st_ * sb * cg],
            [ct * cb, -st_ * cg - ct * sb * sg, st_ * sg - ct * sb * cg],
            [sb, cb * sg, cb * cg],
        ]
    )
    assert _zero(paper.axes - printed)
    second = sp.Matrix([-ct, -st_, 0])
    omega = paper.v[3] * sp.Matrix([0, 0, 1]) - paper.v[4] * second + paper.v[5] * printed[:, 0]
    assert _zero(paper.axes * paper.omega - omega)


@pytest.mark.slow
def test_kinetic_energy_is_equation_5(paper: Derivation) -> None:
    """The long form of the kinetic energy as printed."""
    m, length, j1, j2 = paper.m, paper.length, paper.j1, paper.j2
    theta, beta = paper.q[3], paper.q[4]
    s, c = sp.sin, sp.cos
    dx, dy, dz, dt, db, dg = paper.v
    printed = m * (
        dx**2 + dy**2 + dz**2 + length**2 * db**2 / 4 + length**2 * c(beta) ** 2 * dt**2 / 4
        + length * s(theta) * s(beta) * dx * db - length * c(theta) * c(beta) * dx * dt
        - length * c(theta) * s(beta) * dy * db - length * s(theta) * c(beta) * dy * dt + length * c(beta) * dz * db
    ) / 2 + j1 * (c(beta) ** 2 * dt**2 + db**2) / 2 + j2 * (s(beta) * dt + dg) ** 2 / 2  # fmt: skip
    assert sp.simplify(sp.expand(paper.kinetic - printed)) == 0


@pytest.mark.slow
def test_lost_appendix(paper: Derivation) -> None:
    """M, W, N, S_N and Q as they were re-derived for the notes."""
    m, length, r, j1, j2, g = paper.m, paper.length, paper.r, paper.j1, paper.j2, paper.g
    theta, beta = paper.q[3], paper.q[4]
    st_, ct, sb, cb = sp.sin(theta), sp.cos(theta), sp.sin(beta), sp.cos(beta)
    mass = sp.zeros(6)
    mass[0, 0] = mass[1, 1] = mass[2, 2] = m
    mass[0, 3], mass[0, 4] = -m * length / 2 * cb * ct, m * length / 2 * sb * st_
    mass[1, 3], mass[1, 4] = -m * length / 2 * cb * st_, -m * length / 2 * sb * ct
    mass[2, 4] = m * length / 2 * cb
    mass[3, 3] = (j1 + m * length**2 / 4) * cb**2 + j2 * sb**2
    mass[3, 5], mass[4, 4], mass[5, 5] = j2 * sb, j1 + m * length**2 / 4, j2
    for i in range(6):
        for j in range(i):
            mass[i, j] = mass[j, i]
    assert _zero(paper.mass - mass)
    assert _zero(paper.normal - sp.Matrix([[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, length * cb, 0]]).T)
    ax = [1, 0, 0, 0, -r * st_, -r * cb * ct]
    bx = [1, 0, 0, -length * cb * ct, (length * sb - r) * st_, -r * cb * ct]
    ay = [0, 1, 0, 0, r * ct, -r * cb * st_]
    by = [0, 1, 0, -length * cb * st_, (r - length * sb) * ct, -r * cb * st_]
    assert _zero(paper.slip[0] - sp.Matrix([ax, ay]).T)
    assert _zero(paper.slip[1] - sp.Matrix([bx, by]).T)
    assert _zero(paper.normal_bias - sp.Matrix([0, -length * sb * paper.v[4] ** 2]))
    assert _zero(paper.force - sp.Matrix([0, 0, -m * g, 0, -m * g * length / 2 * cb, 0]))


angle = st.floats(-3.0, 3.0)
speed = st.floats(-2.0, 2.0)
spin = st.floats(-40.0, 40.0)
states = st.tuples(
    st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.0, 0.1), angle, st.floats(-1.4, 1.4), angle),
    st.tuples(speed, speed, speed, spin, spin, spin),
    st.floats(0.0, 1.0),
)


@pytest.mark.slow
@settings(max_examples=60)
@given(state=states)
def test_engine_equals_the_derivation(build: Any, numbers: Any, state: Any) -> None:
    """M, W, N, S_N, S_T, Q and h at random states to 1e-12, through u = T(q) q'."""
    q, rate, time = state
    body = Dumbbell()
    motion = Harmonic(amplitude=3.6e-4, frequency=25.0, phase=0.4)
    model = _model_at(build, body, motion, q, rate, time)
    floats = model.memory.floats
    j2, j1, _ = body.inertia
    mass, normal, slip, normal_bias, slip_bias, force, to_u, to_u_rate, axes, centre = numbers(
        *q, *rate, body.total_mass, body.centre_distance, body.radius, j1, j2, GRAVITY
    )
    out = int(model.memory[owners.BodyRecord.out][:2][1])
    block = floats[out : out + 111]
    np.testing.assert_allclose(block[:3], centre.ravel(), rtol=0, atol=1e-13)
    np.testing.assert_allclose(block[3:12].reshape(3, 3), axes, rtol=0, atol=2e-15 * 4)
    tail = out + FRAME + 36 + 7
    engine_mass = np.linalg.inv(floats[tail + 6 : tail + 42].reshape(6, 6))
    _close(to_u.T @ engine_mass @ to_u, mass)
    # M_e u' = h_e and u' = T q'' + T' q', so T^T (h_e - M_e T' q') is the paper's Q + h
    bias = to_u_rate.ravel()
    engine_force = floats[tail : tail + 6]
    _close(to_u.T @ (engine_force - engine_mass @ bias), force.ravel(), scale=_size(engine_mass @ bias))
    starts = model.memory[owners.ContactRecord.jacobian_b][:2]
    jacobian = np.stack([floats[int(j) : int(j) + 18].reshape(3, 6) for j in starts])
    w_engine, n_engine = jacobian[:, 0].T, jacobian[:, 1:].reshape(4, 6).T
    _close(to_u.T @ w_engine, normal)
    _close(to_u.T @ n_engine, slip)
    omega = 2.0 * math.pi * motion.frequency
    phase = omega * time + motion.phase
    plate = motion.amplitude * np.array([np.sin(phase), omega * np.cos(phase), -(omega**2) * np.sin(phase)])
    rates = model.memory[owners.ContactRecord.rate][:2]
    _close(rates[:, 0], (normal.T @ rate).ravel() - plate[1], scale=_size(rate))
    _close(rates[:, 1:].ravel(), (slip.T @ rate).ravel(), scale=_size(rate))
    prescribed = model.memory[owners.ContactRecord.prescribed_rate][:2]
    _close(prescribed, np.array([[-plate[1], 0.0, 0.0]] * 2), scale=_size(rate))
    # the engine's bias is g'' and v' with u' = 0, that is q'' = -T^-1 T' q'
    still = -np.linalg.solve(to_u, bias)
    expected_n = (normal.T @ still) + normal_bias.ravel() - plate[2]
    expected_t = (slip.T @ still) + slip_bias.ravel()
    scale = _size(plate[2]) + _size(jacobian) * _size(still)
    engine_bias = model.memory[owners.ContactRecord.bias][:2]
    _close(engine_bias[:, 0], expected_n, scale=scale)
    _close(engine_bias[:, 1:].ravel(), expected_t, scale=scale)
    gaps = model.gaps()
    z1, beta = q[2], q[4]
    expected = np.array([z1, z1 + body.centre_distance * math.sin(beta)]) - body.radius - plate[0]
    np.testing.assert_allclose(gaps, expected, rtol=0, atol=1e-15)
    assert model.memory[owners.Island.time] == time


def _model_at(build: Any, body: Dumbbell, motion: Harmonic, q: Any, rate: Any, time: float) -> Any:
    system = build.over(body, motion)
    system.place(body, position=(0.0, 0.0, 1.0))
    model = assemble(system, EventDriven())
    start = build.paper_start(body, q, rate)
    names = ("position", "orientation", "velocity", "angular_velocity")
    model.memory[owners.Island.y][:13] = np.concatenate([start[n] for n in names])
    model.memory[owners.Island.time] = time
    call_entry("evaluate_at", model.memory)
    return model


def _size(array: Any) -> float:
    return float(np.max(np.abs(array)))


def _close(engine: Any, paper: Any, scale: float = 0.0) -> None:
    np.testing.assert_allclose(engine, paper, rtol=0, atol=1e-12 * max(_size(paper), scale))
