"""Random system 8910029: time-out the run was interrupted

as it stands here: time-out the run was interrupted"""

import nonsmooth as ns
from bodies import *
from laws import *

b0 = Plate(motion=Rest(slope=0.0, position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0)))
b1 = BoxBody(half_x=0.012, half_y=0.009600000000000001, half_z=0.0072, density=None, mass=None, rounding=0.0)
b2 = BoxBody(half_x=0.012, half_y=0.019200000000000002, half_z=0.0072, density=None, mass=None, rounding=0.0)
b3 = BoxBody(half_x=0.012, half_y=0.009600000000000001, half_z=0.0072, density=None, mass=None, rounding=0.0)
system = ns.System([b0, b1, b2, b3], gravity=9.81)
laws0 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.08992, static_friction=0.09367),
    impact=EnergeticImpact(restitution=0.5518, stiffness=1.0, exponent=1.5, duration=2e-05),
)
system.contact(b0, b1, **laws0)
laws1 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.321, static_friction=None),
    impact=EnergeticImpact(restitution=0.5553, stiffness=1.0, exponent=1.5, duration=2e-05),
)
system.contact(b1, b2, **laws1)
laws2 = dict(
    normal=Unilateral(),
    friction=Coulomb(friction=0.6125, static_friction=None),
    impact=EnergeticImpact(restitution=0.0, stiffness=3.0, exponent=1.0, duration=2e-05),
)
system.contact(b2, b3, **laws2)
system.place(
    b1,
    position=(0.0, 0.0, 0.009600000000000003),
    orientation=(0.7071067811865476, 0.7071067811865475, 0.0, 0.0),
    velocity=(0.0, 0.0, 0.0),
)
system.place(
    b2,
    position=(-2.739158681338389e-10, 2.2144239806086912e-14, 0.038400000006626564),
    orientation=(0.7071067811865474, 0.7071067811865472, -1.9973375673220096e-08, -1.99733756732201e-08),
)
system.place(
    b3,
    position=(-5.337486637521622e-06, 2.2144239806086912e-14, 0.0672021991554796),
    orientation=(0.7070805218325218, 0.7071330360529303, 6.836725539095379e-05, -1.7132783728661668e-05),
)
try:
    solution = ns.simulate(system, 0.04, sample_interval=0.001)
    print(solution.status, "energy residual", solution.energy.residual)
except ns.NonsmoothError as error:
    print(type(error).__name__, error)
