"""Random system 8910112: failed At t = 0.0652154312 s a gap differs from zero by more than the tolerances allow. The contact 'cylinder - driven body (14)': the gap is -0.00208 m; the tolerances allow 0.000126 m. It jumps in evaluate_flank_edge in /work/main/bodies/contacts/frustum/flank_edge.py, line 31. Run `nonsmooth check` on a kinematics or body of your own; report an error of nonsmooth. Shift or turn a body a little, or give it rounded edges. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation.

as it stands here: failed At t = 0.0652707609 s a gap differs from zero by more than the tolerances allow. The contact 'cylinder - driven body (14)': the gap is -0.00201 m; the tolerances allow 0.000127 m. It jumps in evaluate_flank_edge in /work/main/bodies/contacts/frustum/flank_edge.py, line 31. Run `nonsmooth check` on a kinematics or body of your own; report an error of nonsmooth. Shift or turn a body a little, or give it rounded edges. What was computed is in the error's `solution`; see the page 'Stuck?' of the documentation."""

import nonsmooth as ns
from bodies import *
from laws import *

b0 = DrivenBody(
    motion=Rest(
        slope=0.0,
        position=(0.0135, -0.01864, 0.04997),
        orientation=(-0.5417329481404676, 0.7928792027652524, -0.23497182318347273, -0.1505198492930759),
    ),
    carried=(
        Box(
            half_x=0.01466,
            half_y=0.0121,
            half_z=0.01861,
            x=0.0,
            y=0.0,
            z=0.0,
            orientation_w=1.0,
            orientation_x=0.0,
            orientation_y=0.0,
            orientation_z=0.0,
            rounding=0.0,
        ),
    ),
)
b1 = CylinderBody(radius=0.00744, half_length=0.009039, density=7800.0, mass=None, foot_height=0.0, rounding=0.0)
system = ns.System([b0, b1], gravity=9.81)
laws0 = dict(
    normal=LinearCompliant(stiffness=5550.0, damping=2.746),
    friction=CoulombContensou(
        friction=0.4373,
        drilling_radius=0.001974,
        rolling_length=2.821e-05,
        presliding=1e-05,
        prerolling=0.001,
        relaxation=0.0,
    ),
    impact=None,
)
system.contact(b0, b1, **laws0)
system.place(
    b1,
    position=(0.036, -0.026, 0.097),
    orientation=(1.0, 0.0, 0.0, 0.0),
    velocity=(0.0, 0.0, 0.0),
    angular_velocity=(0.0, 0.0, 0.0),
)
ns.at_height(
    system,
    b1,
    height=0.00069,
    position=(0.036, -0.026, 0.097),
    orientation=(1.0, 0.0, 0.0, 0.0),
    velocity=(0.0, 0.0, 0.0),
    angular_velocity=(0.0, 0.0, 0.0),
)
try:
    solution = ns.simulate(system, 0.076, sample_interval=0.0005)
    print(solution.status, "energy residual", solution.energy.residual)
except ns.NonsmoothError as error:
    print(type(error).__name__, error)
