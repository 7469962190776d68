"""Random system 8910050: failed At t = 0.00124447372 s bodies passed into each other. The bodies 'mesh 1' and 'mesh 2' of the contact 'mesh 1 - mesh 2 (1)' overlap by 2.21e-07 m; their closed contacts allow 2.22e-08 m. Their features missed each other: turn or shift one of them by a thousandth of its size, give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...). What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation.

as it stands here: failed At t = 0.00124209418 s bodies passed into each other. The bodies 'mesh 1' and 'mesh 2' of the contact 'mesh 1 - mesh 2 (1)' overlap by 2.2e-07 m; their closed contacts allow 2.23e-08 m. Their features missed each other: turn or shift one of them by a thousandth of its size, give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...). What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation."""

import nonsmooth as ns
from bodies import *
from laws import *

b0 = Plate(motion=Rest(slope=0.0, position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0)))
b1 = MeshBody(
    surface=Triangles(
        vertices=(
            (-0.006, -0.0024000000000000002, -0.0048000000000000004),
            (0.006, -0.0024000000000000002, -0.0048000000000000004),
            (0.006, 0.0024000000000000002, -0.0048000000000000004),
            (-0.006, 0.0024000000000000002, -0.0048000000000000004),
            (-0.006, -0.0024000000000000002, 0.0048000000000000004),
            (0.006, -0.0024000000000000002, 0.0048000000000000004),
            (0.006, 0.0024000000000000002, 0.0048000000000000004),
            (-0.006, 0.0024000000000000002, 0.0048000000000000004),
        ),
        faces=(
            (0, 2, 1),
            (0, 3, 2),
            (4, 5, 6),
            (4, 6, 7),
            (0, 1, 5),
            (0, 5, 4),
            (1, 2, 6),
            (1, 6, 5),
            (2, 3, 7),
            (2, 7, 6),
            (3, 0, 4),
            (3, 4, 7),
        ),
        name="box",
        repair=(),
    ),
    density=None,
    mass=None,
    decomposition=None,
)
b2 = MeshBody(
    surface=Triangles(
        vertices=(
            (-0.006, -0.0024000000000000002, -0.0048000000000000004),
            (0.006, -0.0024000000000000002, -0.0048000000000000004),
            (0.006, 0.0024000000000000002, -0.0048000000000000004),
            (-0.006, 0.0024000000000000002, -0.0048000000000000004),
            (-0.006, -0.0024000000000000002, 0.0048000000000000004),
            (0.006, -0.0024000000000000002, 0.0048000000000000004),
            (0.006, 0.0024000000000000002, 0.0048000000000000004),
            (-0.006, 0.0024000000000000002, 0.0048000000000000004),
        ),
        faces=(
            (0, 2, 1),
            (0, 3, 2),
            (4, 5, 6),
            (4, 6, 7),
            (0, 1, 5),
            (0, 5, 4),
            (1, 2, 6),
            (1, 6, 5),
            (2, 3, 7),
            (2, 7, 6),
            (3, 0, 4),
            (3, 4, 7),
        ),
        name="box",
        repair=(),
    ),
    density=None,
    mass=None,
    decomposition=None,
)
system = ns.System([b0, b1, b2], gravity=9.81)
laws0 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.788, static_friction=None),
    impact=EnergeticImpact(restitution=0.8, stiffness=1.0, exponent=1.5, duration=2e-05),
)
system.contact(b0, b1, **laws0)
system.contact(b0, b2, **laws0)
system.contact(b1, b2, **laws0)
system.place(
    b1,
    position=(0.0, 0.0, 0.006),
    orientation=(-0.7071067811865476, 0.0, -0.7071067811865475, 0.0),
    velocity=(0.0, 1.3, 0.0),
)
system.place(
    b2,
    position=(3.8e-10, 0.0064, 0.006),
    orientation=(-0.7071067811865476, -4.4985533346525465e-09, -0.7071067811865475, 4.498553334652547e-09),
)
try:
    solution = ns.simulate(system, 0.0014, sample_interval=0.00075)
    print(solution.status, "energy residual", solution.energy.residual)
except ns.NonsmoothError as error:
    print(type(error).__name__, error)
