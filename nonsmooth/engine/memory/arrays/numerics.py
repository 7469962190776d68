"""The coefficients of the Runge-Kutta pairs."""

from __future__ import annotations

from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, real, whole
from nonsmooth.engine.memory.layout import N_STAGES

ARRAYS = Arrays(
    scalars={
        **whole(
            "n_active",
            "first_grouped",
            "half_band",
            "crowded",
            "null_half",
        ),
        **real(
            "null_shift",
        ),
    },
    floats={
        "stages": fixed(6 * N_STAGES),
        "error_weights": fixed(N_STAGES),
        "implicit_stages": fixed(6 * N_STAGES),
        "implicit_predictor": fixed(6 * N_STAGES),
        "implicit_errors": fixed(N_STAGES),
        "implicit_bend": fixed(N_STAGES),
        "dense": fixed(4 * N_STAGES),
    },
    integers={},
)
