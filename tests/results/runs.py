"""A system whose runs are written, cut off and go on: ``python -m tests.results.runs DIR T_END`` runs it.

Two balls bounce on a plate that vibrates, and on each other.
"""

from __future__ import annotations

import sys
import time

import nonsmooth as ns
from bodies import Ball, DrivenBody, Harmonic, Plate, TriangleMesh, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.runs import folder_sink
from tests.bodies.meshes.parts import hills

_COULOMB = Coulomb(0.2)


def balls(friction: FrictionLaw = _COULOMB) -> ns.System:
    """Return the system."""
    balls, plate = [Ball(radius=5e-3), Ball(radius=4e-3)], Plate(motion=Harmonic(amplitude=4e-4, frequency=25.0))
    system = ns.System([*balls, plate])
    for i, ball in enumerate(balls):
        system.place(ball, position=(1e-3 * i, 0.0, 2e-2 + 1e-2 * i), velocity=(0.01, 0.0, 0.0))
    for one, other in ((balls[0], plate), (balls[1], plate), (balls[0], balls[1])):
        system.contact(one, other, normal=Unilateral(), friction=friction, impact=EnergeticImpact(restitution=0.6))
    return system


def bouncing() -> ns.System:
    """Return a ball that bounces on a vibrating plate as long as it runs, some 27 times a second."""
    ball, plate = Ball(radius=5e-3), Plate(motion=Harmonic(amplitude=4e-4, frequency=25.0))
    system = ns.System([ball, plate])
    system.contact(ball, plate, normal=Unilateral(), friction=_COULOMB, impact=EnergeticImpact(restitution=0.9))
    system.place(ball, position=(0.0, 0.0, 6e-3))
    return system


def on_hills() -> ns.System:
    """Return a ball on a mesh, of whose many patches a search finds those near it."""
    ground, ball = DrivenBody(carried=(TriangleMesh(Triangles(*hills(6))),)), Ball(0.05)
    system = ns.System([ground, ball])
    system.contact(ground, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.4))
    system.place(ball, position=(0.05, 0.02, 0.08), velocity=(0.1, 0.0, 0.0))
    return system


def main() -> None:
    """Run it slowly, and write whatever there is as often as possible."""
    folder_sink._COMMIT_INTERVAL = folder_sink._FIRST_COMMIT = 0.0
    folder_sink._MOST_STEPS = folder_sink._FIRST_STEPS
    ns.simulate(balls(), float(sys.argv[2]), output=sys.argv[1], progress=lambda t, t_end: time.sleep(0.03))


if __name__ == "__main__":
    main()
