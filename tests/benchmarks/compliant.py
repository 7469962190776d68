"""The dumbbell's drift on stiff springs, against the impact laws: ``python -m tests.benchmarks.compliant``.

Nothing here is an impact law: each ball has a Hertz spring with the energetic restitution (LZB, Eq. (28)) and Coulomb
friction, and the motion in the plane is integrated through every contact with fixed steps.  The shorter the contact
time, the nearer it is to rigid bodies.
"""

from __future__ import annotations

import math

import numba
import numpy as np

RADIUS, ASPECT_RATIO, RESTITUTION, FRICTION = 5e-3, 3.9, 0.6, 0.15
GAMMA, FREQUENCY, GRAVITY, TILT = 0.9, 25.0, 9.81, math.radians(10.0)


@numba.njit  # type: ignore[untyped-decorator]
def drift(contact_time: float, steps_per_contact: int, t_end: float) -> tuple[float, float]:
    """Return the mean velocity along the rod [m/s] in the second half of the run, and the last tilt [rad]."""
    half = RADIUS * (ASPECT_RATIO - 1.0)
    inertia = half**2 + 0.4 * RADIUS**2
    amplitude, omega = GAMMA * GRAVITY / (2.0 * math.pi * FREQUENCY) ** 2, 2.0 * math.pi * FREQUENCY
    # T_c = 2.943 (5/4 m / k)^(2/5) v^(-1/5) at 0.25 m/s, per unit mass of the dumbbell, of which a ball feels half
    stiffness = 1.25 * 0.5 * (2.943 * 0.25**-0.2 / contact_time) ** 2.5
    z, y, beta = RADIUS + half * math.sin(TILT), 0.0, TILT
    vz = vy = rate = 0.0
    x, normal, tangential = np.zeros(2), np.zeros(2), np.zeros(2)
    arm_z, arm_y, gap, closing, bound = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    t, t_half, y_half = 0.0, 0.5 * t_end, 0.0
    fine = contact_time / steps_per_contact
    while t < t_end:
        if t < t_half:
            y_half = y
        s, c = math.sin(beta), math.cos(beta)
        lowest = 1e300
        for i in range(2):
            side = -1.0 if i == 0 else 1.0
            arm_z[i], arm_y[i] = side * half * c, RADIUS - side * half * s
            gap[i] = z + side * half * s - RADIUS - amplitude * math.sin(omega * t)
            closing[i] = vz + arm_z[i] * rate - amplitude * omega * math.cos(omega * t)
            lowest = min(lowest, gap[i] - 1e-300 if x[i] <= 0.0 else -1.0)
        # far from contact the step may be longer, but not reach it
        h = fine if lowest < 2e-6 else min(20.0 * fine, 1e-6)
        for i in range(2):
            if gap[i] <= 0.0 or x[i] > 0.0:
                share = 1.0 if closing[i] <= 0.0 else RESTITUTION**2
                x[i] = max(0.0, x[i] - h * closing[i] / share)
            normal[i] = h * stiffness * x[i] * math.sqrt(x[i])
            bound[i] = FRICTION * normal[i]
        vz += normal[0] + normal[1] - h * GRAVITY
        rate += (arm_z[0] * normal[0] + arm_z[1] * normal[1]) / inertia
        # Coulomb friction: the impulses that stop the slips, as far as the bounds allow
        tangential[:] = 0.0
        for _sweep in range(50):
            change = 0.0
            for i in range(2):
                if bound[i] > 0.0:
                    slip = vy + arm_y[i] * rate
                    wanted = tangential[i] - slip / (1.0 + arm_y[i] ** 2 / inertia)
                    wanted = min(bound[i], max(-bound[i], wanted))
                    more = wanted - tangential[i]
                    vy += more
                    rate += arm_y[i] * more / inertia
                    tangential[i] = wanted
                    change = max(change, abs(more))
            if change <= 1e-12:
                break
        z, y, beta, t = z + h * vz, y + h * vy, beta + h * rate, t + h
    return (y - y_half) / (t_end - t_half), beta


def main() -> None:
    """Print the drift for ever stiffer springs and finer steps."""
    for contact_time, steps in ((8e-5, 200), (4e-5, 200), (2e-5, 200), (2e-5, 400), (1e-5, 200)):
        velocity, _ = drift(contact_time, steps, 4.0)
        print(f"contact time {1e6 * contact_time:.0f} µs, {steps} steps in it: {1e3 * velocity:+.2f} mm/s")


if __name__ == "__main__":
    main()
