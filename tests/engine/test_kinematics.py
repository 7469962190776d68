"""Gap rates, Jacobians and second-order terms of moving and turning bodies, against finite differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, Dumbbell, Plate
from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Motion
from nonsmooth.model.assembly import assemble
from nonsmooth.parameters import parameter


def _swing(t, q, u, out, size, rate, shift):  # type: ignore[no-untyped-def]
    """Swing about an oblique axis through a moving point."""
    ax, ay, az = 0.48, 0.6, 0.64
    angle, speed, push = (
        size * math.sin(rate * t),
        size * rate * math.cos(rate * t),
        -size * rate * rate * math.sin(rate * t),
    )
    s, c = math.sin(angle), math.cos(angle)
    out[0], out[1], out[2] = shift * math.sin(2.0 * t), shift * t * t, shift * math.cos(t)
    out[3], out[4], out[5] = c + ax * ax * (1 - c), ax * ay * (1 - c) - az * s, ax * az * (1 - c) + ay * s
    out[6], out[7], out[8] = ay * ax * (1 - c) + az * s, c + ay * ay * (1 - c), ay * az * (1 - c) - ax * s
    out[9], out[10], out[11] = az * ax * (1 - c) - ay * s, az * ay * (1 - c) + ax * s, c + az * az * (1 - c)
    out[12], out[13], out[14] = 2.0 * shift * math.cos(2.0 * t), 2.0 * shift * t, -shift * math.sin(t)
    out[15], out[16], out[17] = speed * ax, speed * ay, speed * az
    out[18], out[19], out[20] = -4.0 * shift * math.sin(2.0 * t), 2.0 * shift, -shift * math.cos(t)
    out[21], out[22], out[23] = push * ax, push * ay, push * az


@final
@dataclass(frozen=True)
class Swing(Motion):
    """A plate that swings and shifts."""

    size: float = parameter(0.5, doc="angle", unit="rad")
    rate: float = parameter(3.0, doc="angular rate", unit="rad/s")
    shift: float = parameter(0.2, doc="shift", unit="m")

    @property
    def evaluator(self) -> Callable[..., None]:
        """The swing."""
        return _swing

    @property
    def time_scale(self) -> float:
        """A second."""
        return 1.0


def _turn(q: Any, omega: Any, dt: float) -> Any:
    """Return the quaternion after turning at constant body rate."""
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(np.asarray(omega) * dt)
    return np.roll(turned.as_quat(), 1)


vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3)


@settings(max_examples=25)
@given(
    time=st.floats(0.0, 2.0),
    position=vectors,
    rotation=vectors,
    velocity=vectors,
    omega=vectors,
    name=st.sampled_from(["ball", "dumbbell"]),
    flip=st.booleans(),
)
def test_rates_and_bias_are_derivatives(
    build: Any, time: float, position: Any, rotation: Any, velocity: Any, omega: Any, name: str, flip: bool
) -> None:
    """The rate is dg/dt, the bias is d(g', v)/dt with u' = 0, W and N are the gradients; in any order."""
    body: Any = {"ball": Ball(0.05), "dumbbell": Dumbbell(0.05)}[name]
    plate = Plate(Swing())
    system = ns.System([body, plate] if flip else [plate, body])
    system.contact(*((body, plate) if flip else (plate, body)), **build.laws())
    system.place(body, position=(0.0, 0.0, 3.0))
    model = assemble(system, EventDriven())
    memory, n = model.memory, len(system.contacts)
    spin = np.asarray(omega) * 10.0
    q0 = _turn(np.array([1.0, 0.0, 0.0, 0.0]), rotation, 1.0)

    def at(dt: float, u: Any) -> Any:
        state = np.concatenate([np.asarray(position) + dt * np.asarray(u[:3]), _turn(q0, u[3:], dt), u])
        memory[owners.Island.y][:13] = state
        memory[owners.Island.time] = time + dt
        call_entry("evaluate_at", memory)
        return model.gaps(), memory[owners.ContactRecord.rate][:n].flatten()

    u = np.concatenate([velocity, spin])
    h = 1e-3
    weights = ((-2 * h, 1.0), (-h, -8.0), (h, 8.0), (2 * h, -1.0))
    parts = [(w / (12.0 * h), at(dt, u)) for dt, w in weights]
    gap_rate = sum(w * gap for w, (gap, _) in parts)
    rate_change = sum(w * rate for w, (_, rate) in parts)
    _, rate = at(0.0, u)
    bias = memory[owners.ContactRecord.bias][:n].flatten()
    scale = 1.0 + float(np.max(np.abs(bias)))
    np.testing.assert_allclose(rate[::3], gap_rate, rtol=0, atol=1e-7 * scale)
    np.testing.assert_allclose(bias, rate_change, rtol=0, atol=3e-7 * scale)
    is_second = not flip or system.contacts[0].second is body
    starts = memory[owners.ContactRecord.jacobian_b if is_second else owners.ContactRecord.jacobian_a][:n]
    jacobian = np.stack([memory.floats[int(j) : int(j) + 18].reshape(3, 6) for j in starts])
    prescribed = memory[owners.ContactRecord.prescribed_rate][:n].flatten()
    np.testing.assert_allclose(jacobian.reshape(3 * n, 6) @ u + prescribed, rate, rtol=0, atol=1e-12 * scale)
    gradient = np.stack([at(0.0, u + e)[1] - rate for e in np.eye(6)], axis=1)
    np.testing.assert_allclose(jacobian.reshape(3 * n, 6), gradient, rtol=0, atol=1e-11 * scale)


def test_a_ball_rests_on_a_swinging_plate(build: Any) -> None:
    """The second-order terms hold a rolling ball on a plate that swings: the gap stays closed, the account closes."""
    ball, motion = Ball(0.01), Swing(size=0.05, shift=0.0)
    system = build.over(ball, motion, friction=0.8)
    system.place(ball, position=(0.02, 0.01, 0.01), velocity=_carried(motion, (0.02, 0.01, 0.0)))
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11))
    assert build.lived(solution) == ["{1,0,0}"]
    assert solution.energy.residual <= 1e-8
    for t, q in zip(solution.t[::400], solution.q[::400], strict=True):
        out = np.zeros(24)
        motion.evaluator(t, None, None, out, **motion.parameters())
        normal = out[3:12].reshape(3, 3)[:, 2]
        assert normal @ (q[:3] - out[:3]) - 0.01 == pytest.approx(0.0, abs=1e-12)


def _carried(motion: Swing, point: Any) -> Any:
    out = np.zeros(24)
    motion.evaluator(0.0, None, None, out, **motion.parameters())
    return out[12:15] + np.cross(out[15:18], np.asarray(point))
