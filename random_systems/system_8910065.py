"""Random system 8910065: failed At t = 0.00158674502 s an impact did not end within its steps. In contact are 'plate - box 1 (5)', 'plate - box 1 (7)', 'box 1 - box 2 (4)', 17 others. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation.

as it stands here: failed At t = 0.00158674502 s an impact did not end within its steps. In contact are 'plate - box 1 (5)', 'plate - box 1 (7)', 'box 1 - box 2 (4)', 17 others. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation."""

import nonsmooth as ns
from bodies import *
from laws import *

b0 = Plate(motion=Rest(slope=0.0, position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0)))
b1 = BoxBody(half_x=0.012, half_y=0.012, half_z=0.012, density=None, mass=None, rounding=0.0)
b2 = BoxBody(half_x=0.012, half_y=0.012, half_z=0.012, density=None, mass=None, rounding=0.0)
b3 = BoxBody(half_x=0.012, half_y=0.012, half_z=0.012, density=None, mass=None, rounding=0.0)
b4 = BoxBody(half_x=0.012, half_y=0.012, half_z=0.012, density=None, mass=None, rounding=0.0)
b5 = BoxBody(half_x=0.012, half_y=0.012, half_z=0.012, density=None, mass=None, rounding=0.0)
system = ns.System([b0, b1, b2, b3, b4, b5], gravity=9.81)
laws0 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.4614, static_friction=None),
    impact=EnergeticImpact(restitution=0.8, stiffness=1.0, exponent=1.5, duration=2e-05),
)
system.contact(b0, b1, **laws0)
system.contact(b1, b2, **laws0)
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
system.place(
    b1, position=(0.0, 0.0, 0.012000000000000004), orientation=(0.7071067811865476, 0.0, 0.7071067811865475, 0.0)
)
system.place(
    b2,
    position=(-7.744402839617462e-13, 0.0, 0.03600000000000001),
    orientation=(0.7071067811865476, 0.0, 0.7071067811865475, 0.0),
)
system.place(
    b3,
    position=(4.196239893009875e-08, 0.0, 0.06000000000000002),
    orientation=(0.7071067811865476, 0.0, 0.7071067811865475, 0.0),
)
system.place(
    b4,
    position=(4.196095104599906e-08, -4.94583243145451e-10, 0.08400000004053054),
    orientation=(0.7071067807822787, -8.345883059306911e-10, 0.7071067815908163, -7.451579523112753e-10),
)
system.place(
    b5,
    position=(4.04375422366633e-08, -4.94583243145451e-10, 0.10800705740307419),
    orientation=(0.7071243011145203, 2.6805546096406666e-05, 0.7070892600991935, -1.7525384859113053e-05),
)
try:
    solution = ns.simulate(system, 0.05, sample_interval=0.001)
    print(solution.status, "energy residual", solution.energy.residual)
except ns.NonsmoothError as error:
    print(type(error).__name__, error)
