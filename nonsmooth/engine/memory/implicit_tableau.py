"""The stiffly accurate pair ESDIRK4(3)6L[2]SA (Kennedy and Carpenter 2003, Appl. Numer. Math. 44, 139-181).

Its six stages are the last six of seven rows. The first row belongs to the slope at the start of the step, the second
to the slope after fast motion has decayed.
"""

from __future__ import annotations

DIAGONAL = 1 / 4
ITERATIONS = 12
"""Most fixed-point iterations of the part of a stage that is not stiff."""
SETTLED = 0.01
"""Iterations end when the change is below this fraction of the tolerance."""
NODES = (0.0, 0.0, 1 / 2, 83 / 250, 31 / 50, 17 / 20, 1.0)
STAGES = (
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 1 / 4, 0.0, 0.0, 0.0, 0.0),
    (0.0, 8611 / 62500, -1743 / 31250, 0.0, 0.0, 0.0),
    (0.0, 5012029 / 34652500, -654441 / 2922500, 174375 / 388108, 0.0, 0.0),
    (0.0, 15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912, 0.0),
    (0.0, 82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211),
)
"""Weights of the earlier stages. The weight of the stage itself is :data:`DIAGONAL`."""
PREDICTOR = (
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 1 / 2, 0.0, 0.0, 0.0, 0.0),
    (0.0, 13861 / 62500, 6889 / 62500, 0.0, 0.0, 0.0),
    (0.0, -116923316275 / 2393684061468, -2731218467317 / 15368042101831, 9408046702089 / 11113171139209, 0.0, 0.0),
    (
        0.0,
        -451086348788 / 2902428689909,
        -2682348792572 / 7519795681897,
        12662868775082 / 11960479115383,
        3355817975965 / 11060851509271,
        0.0,
    ),
    (
        0.0,
        647845179188 / 3216320057751,
        73281519250 / 8382639484533,
        552539513391 / 3454668386233,
        3354512671639 / 8306763924573,
        4040 / 17871,
    ),
)
"""Weights of the earlier stages in the first guess of a stage: the explicit pair that belongs to this implicit one."""
ERROR = (
    0.0,
    82889 / 524892 - 4586570599 / 29645900160,
    0.0,
    15625 / 83664 - 178811875 / 945068544,
    69875 / 102672 - 814220225 / 1159782912,
    -2260 / 8211 + 3700637 / 11593932,
    1 / 4 - 61727 / 225920,
)
BEND = (0.0, -189857 / 172391, 3253 / 1407, 55156250 / 19502427, -10625 / 2077, 0.0, 12047 / 11189)
"""Weights of the slopes in the interpolant of fourth order: h theta^2 (1 - theta)^2 times their sum is added to the
cubic Hermite interpolant. This changes neither values nor slopes at the ends of the step."""
