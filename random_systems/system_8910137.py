"""Random system 8910137: failed At t = 0.00379577794 s impacts at one instant did not settle into a mode. In contact are 'disc - hull 2 (28)', 'disc - hull 2 (33)'. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation.
energy: residual 0.0326

as it stands here: failed At t = 0.00379577794 s impacts at one instant did not settle into a mode. In contact are 'disc - hull 2 (28)', 'disc - hull 2 (33)'. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation.
energy: residual 0.0326"""

import nonsmooth as ns
from bodies import *
from laws import *

b0 = Plate(motion=Rest(slope=0.0, position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0)))
b1 = HullBody(
    points=(
        (-0.006, -0.0024000000000000002, -0.0036),
        (0.006, -0.0024000000000000002, -0.0036),
        (0.006, 0.0024000000000000002, -0.0036),
        (-0.006, 0.0024000000000000002, -0.0036),
        (-0.006, -0.0024000000000000002, 0.0036),
        (0.006, -0.0024000000000000002, 0.0036),
        (0.006, 0.0024000000000000002, 0.0036),
        (-0.006, 0.0024000000000000002, 0.0036),
    ),
    density=None,
    mass=None,
    rounding=0.0,
)
b2 = HullBody(
    points=(
        (-0.006, -0.0048000000000000004, -0.0024000000000000002),
        (0.006, -0.0048000000000000004, -0.0024000000000000002),
        (0.006, 0.0048000000000000004, -0.0024000000000000002),
        (-0.006, 0.0048000000000000004, -0.0024000000000000002),
        (-0.006, -0.0048000000000000004, 0.0024000000000000002),
        (0.006, -0.0048000000000000004, 0.0024000000000000002),
        (0.006, 0.0048000000000000004, 0.0024000000000000002),
        (-0.006, 0.0048000000000000004, 0.0024000000000000002),
    ),
    density=None,
    mass=None,
    rounding=0.0,
)
b3 = DiscBody(radius=0.006, surface_density=None, mass=None, foot_height=0.0, rounding=0.0006000000000000001)
b4 = BoxBody(
    half_x=0.006, half_y=0.0048000000000000004, half_z=0.0048000000000000004, density=None, mass=None, rounding=0.0
)
b5 = MeshBody(
    surface=Triangles(
        vertices=(
            (-0.006, -0.0036, -0.006),
            (0.006, -0.0036, -0.006),
            (0.006, 0.0036, -0.006),
            (-0.006, 0.0036, -0.006),
            (-0.006, -0.0036, 0.006),
            (0.006, -0.0036, 0.006),
            (0.006, 0.0036, 0.006),
            (-0.006, 0.0036, 0.006),
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
b6 = CylinderBody(
    radius=0.006, half_length=0.0006000000000000001, density=None, mass=None, foot_height=None, rounding=0.0
)
system = ns.System([b0, b1, b2, b3, b4, b5, b6], gravity=9.81)
laws0 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.07773, static_friction=None),
    impact=EnergeticImpact(restitution=0.8, stiffness=1.0, exponent=1.5, duration=2e-05),
)
system.contact(b0, b1, **laws0)
system.contact(b0, b2, **laws0)
system.contact(b1, b2, **laws0)
system.contact(b0, b3, **laws0)
system.contact(b1, b3, **laws0)
system.contact(b2, b3, **laws0)
system.contact(b0, b4, **laws0)
system.contact(b1, b4, **laws0)
system.contact(b2, b4, **laws0)
system.contact(b3, b4, **laws0)
system.contact(b0, b5, **laws0)
system.contact(b1, b5, **laws0)
system.contact(b2, b5, **laws0)
system.contact(b3, b5, **laws0)
system.contact(b4, b5, **laws0)
system.contact(b0, b6, **laws0)
system.contact(b1, b6, **laws0)
system.contact(b2, b6, **laws0)
system.contact(b3, b6, **laws0)
system.contact(b4, b6, **laws0)
system.contact(b5, b6, **laws0)
system.place(b1, position=(0.0, 0.0, 0.0036), orientation=(1.0, 0.0, 0.0, 0.0))
system.place(
    b2,
    position=(-1.9779996054004214e-13, -2.1768943092720298e-07, 0.009600000000000001),
    orientation=(0.9999995480067161, 0.0, 0.0, 0.0009507819747902951),
)
system.place(
    b3,
    position=(-1.9779996054004214e-13, -2.1768943092720298e-07, 0.0126),
    orientation=(0.9999900526802441, 0.0, 0.0, 0.00446032964731601),
)
system.place(
    b4,
    position=(-1.9580530071740196e-13, -2.1768943535386363e-07, 0.01801434945177649),
    orientation=(0.9999990839353226, -3.050161826089307e-05, 0.001167948524952233, 0.0006834430554190294),
)
system.place(
    b5,
    position=(7.349126789615851e-07, -2.1768991797041672e-07, 0.02882863711945661),
    orientation=(0.9999999997393825, 0.0, 0.0, 2.2830575675370038e-05),
)
system.place(
    b6,
    position=(7.349508053550182e-07, -2.1768991797041672e-07, 0.035428637159461596),
    orientation=(1.0, 0.0, 0.0, 2.7739244481625e-09),
)
try:
    solution = ns.simulate(system, 0.05, sample_interval=0.0006)
    print(solution.status, "energy residual", solution.energy.residual)
except ns.NonsmoothError as error:
    print(type(error).__name__, error)
