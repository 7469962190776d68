"""The smooth flow: order by slope and by bound, conservation, dense output."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Dumbbell, FreeBody, Harmonic, Sphere
from nonsmooth.interfaces import Shape


@final
@dataclass(frozen=True)
class Brick(FreeBody):
    """A body with three different moments of inertia."""

    @property
    def total_mass(self) -> float:
        """1 kg."""
        return 1.0

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Unequal."""
        return 0.01, 0.02, 0.025

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """One sphere, to have a size."""
        return (Sphere(0.1),)


def _tumble(spin: Any, tolerance: float, t_end: float, gravity: float = 0.0) -> ns.Solution:
    body = Brick()
    system = ns.System([body], gravity)
    system.place(body, velocity=(1.0, 0.0, 2.0), angular_velocity=spin)
    return ns.simulate(system, t_end, engine=ns.EventDriven(tolerance=tolerance, largest_step=10.0))


def _momentum(q: Any, u: Any) -> Any:
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(np.roll(q[3:], -1)).as_matrix() @ (np.array(Brick().inertia) * u[3:])


@settings(max_examples=20)
@given(spin=st.tuples(*[st.floats(-20.0, 20.0)] * 3))
def test_tumbling_conserves_energy_and_momentum(spin: Any) -> None:
    """Torque-free rotation about any axis: energy, angular momentum, unit quaternion."""
    solution = _tumble(spin, 1e-10, 1.0)
    inertia = np.array(Brick().inertia)
    energy = 0.5 * np.sum(inertia * solution.u[:, 3:] ** 2, axis=1)
    np.testing.assert_allclose(energy, energy[0], rtol=0, atol=1e-8 * (1.0 + energy[0]))
    start: Any = _momentum(solution.q[0], solution.u[0])
    end = _momentum(solution.q_end, solution.u_end)
    np.testing.assert_allclose(end, start, rtol=0, atol=1e-8 * (1.0 + float(np.linalg.norm(start))))
    assert np.linalg.norm(solution.q_end[3:]) == pytest.approx(1.0, abs=1e-15)
    assert solution.events.causes() == ["start"]


def test_free_flight_is_a_parabola() -> None:
    """Position and velocity under gravity, exact for the method."""
    solution = _tumble((1.0, 2.0, 3.0), 1e-9, 0.7, gravity=9.81)
    expected = np.array([0.7, 0.0, 1.4 - 0.5 * 9.81 * 0.49])
    np.testing.assert_allclose(solution.q_end[:3], expected, rtol=0, atol=1e-13)
    height = 2.0 * solution.t - 0.5 * 9.81 * solution.t**2
    np.testing.assert_allclose(solution.q[:, 2], height, rtol=0, atol=1e-13)


def test_order_of_the_flow() -> None:
    """Fifth order: the error falls with the fifth power of the work, and stays within the tolerance times a bound."""
    spin = (3.0, 15.0, 1.0)
    truth = _tumble(spin, 1e-14, 3.0)
    tolerances = 10.0 ** -np.arange(4.0, 12.5, 1.0)
    runs = [_tumble(spin, float(tolerance), 3.0) for tolerance in tolerances]
    errors = np.array([np.max(np.abs(run.u_end[3:] - truth.u_end[3:])) for run in runs])
    work = np.array([run.counters.steps + run.counters.rejected for run in runs], dtype=float)
    inside = (tolerances <= 1e-5) & (errors > 1e-11)
    assert -np.polyfit(np.log(work[inside]), np.log(errors[inside]), 1)[0] >= 4.8
    assert np.all(errors <= 1e4 * tolerances)
    assert np.polyfit(np.log(tolerances[inside]), np.log(errors[inside]), 1)[0] >= 0.9


def test_symmetric_top_is_exact() -> None:
    """The dumbbell's free precession: body spin constant, transverse rate turning at (J2 - J1)/J1 times it."""
    body = Dumbbell()
    along, across, _ = body.inertia
    system = ns.System([body], 0.0)
    system.place(body, angular_velocity=(40.0, 5.0, 0.0))
    solution = ns.simulate(system, 0.5, engine=ns.EventDriven(tolerance=1e-12))
    phase = (across - along) / across * 40.0 * solution.t
    np.testing.assert_allclose(solution.u[:, 3], 40.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(solution.u[:, 4], 5.0 * np.cos(phase), rtol=0, atol=1e-8)
    np.testing.assert_allclose(solution.u[:, 5], -5.0 * np.sin(phase), rtol=0, atol=1e-8)


def test_dense_output_agrees_with_the_steps(build: Any) -> None:
    """A sample is what a run that ends there computes, and neither samples nor their number move an event."""
    motion = Harmonic(amplitude=3.6e-4, frequency=25.0)

    def run(t_end: float, interval: float) -> ns.Solution:
        body = Dumbbell()
        system = build.over(body, motion, restitution=0.6)
        start = build.paper_start(body, (0, 0, body.radius, 0.1, 0.17, 0.0), (0, 0, 0, 0, 0, 0))
        system.place(body, **start)
        return ns.simulate(system, t_end, sample_interval=interval)

    coarse, fine = run(0.1, 0.01), run(0.1, 0.0005)
    np.testing.assert_array_equal(coarse.events.time, fine.events.time)
    np.testing.assert_allclose(fine.t, np.arange(len(fine.t)) * 0.0005, rtol=0, atol=1e-15)
    assert len(fine.t) == 201
    np.testing.assert_array_equal(coarse.q, fine.q[::20])
    for index in (37, 111, 158):
        short = run(float(fine.t[index]), 0.0005)
        np.testing.assert_allclose(short.q_end, fine.q[index], rtol=0, atol=1e-8)
        np.testing.assert_allclose(short.u_end[:3], fine.u[index, :3], rtol=0, atol=1e-7)
    np.testing.assert_allclose(fine.q[-1], fine.q_end, rtol=0, atol=1e-9)
