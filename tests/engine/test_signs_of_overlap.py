"""Features of bodies that strike and come to overlap within a trial step hide no contact that closed before."""

from __future__ import annotations

import nonsmooth as ns
from bodies import BoxBody, Plate
from laws import EnergeticImpact, Frictionless, Unilateral
from tests.benchmarks.random_systems.gaps import distance, overlaps
from tests.benchmarks.random_systems.pieces import poses_of


def test_edges_that_overlap_do_not_hide_the_edge_that_closed_before() -> None:
    """Two boxes on a plate strike edge to edge; a moment later two other pairs of edges are seen to overlap.

    Their gaps jump there, one right before the other.
    """
    plate, one, two = Plate(), BoxBody(0.004462, 0.002888, 0.005821), BoxBody(0.002277, 0.002672, 0.002436)
    system = ns.System([plate, one, two])
    for pair in ((one, two), (plate, two), (plate, one)):
        system.contact(
            *pair, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.7997, exponent=1.5)
        )
    system.place(
        one,
        position=(-0.00017790345025848252, 0.0008216954795265401, 0.011645775013126044),
        orientation=(-0.9060420427347552, 0.13137811271633798, 0.038662783969462544, 0.4004157806978341),
        velocity=(-0.09395456729398992, 0.3109225491875877, -0.5636636970268158),
        angular_velocity=(-34.51228290511674, 118.73808410651424, 3.1994381658726625),
    )
    system.place(
        two,
        position=(0.0009003926820722679, -0.004158708533098186, 0.0039737670824557154),
        orientation=(-0.0882539699214179, 0.7773613889408741, 0.2460074088279814, 0.5721895337899561),
        velocity=(0.47551638102500154, -1.5736197784416521, -0.22653223158687696),
        angular_velocity=(322.3691558739481, 493.23766881570566, -199.27837160606936),
    )
    solution = ns.simulate(system, 0.001)
    assert solution.status == "done"
    assert solution.counters.impacts == 1
    q = solution.events.q[1]
    poses = [poses_of(body, solution.t[:1], q[None, 7 * i : 7 * i + 7]) for i, body in enumerate((one, two))]
    assert distance(one, two, (poses[0], poses[1])) <= 1e-9
    assert all(found.depth <= 1e-9 for found in overlaps(one, two, (poses[0], poses[1])))
