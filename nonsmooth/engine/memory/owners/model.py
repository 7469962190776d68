"""Numbers of the model, which never change once a system is laid out."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import (
    FloatRow,
    IntegerRow,
    Life,
    Singleton,
    address,
    floats,
    integers,
    one_of,
    real,
    whole,
)
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.modes import Painleve
from nonsmooth.engine.memory.sizes import ends, fixed, per
from nonsmooth.engine.memory.solvers import Solver

_PARAMETER = Life.PARAMETER


@final
class ModelNumbers(Singleton, key="model"):
    """Sizes of a system, and what holds for all of its contacts.

    Counts size the workspace. Another number of bodies or contacts recompiles nothing.
    """

    n_bodies: int = whole(_PARAMETER, "Number of bodies.")
    n_slots: int = whole(_PARAMETER, "Largest number of contacts that can be listed at once.")
    n_declared: int = whole(_PARAMETER, "Number of declared contacts.")
    n_rows: int = whole(_PARAMETER, "Number of rows: pairs of shapes between which contacts are declared.")
    n_kinds: int = whole(_PARAMETER, "Number of kinds of declared contacts.")
    n_spheres: int = whole(_PARAMETER, "Number of bounding spheres.")
    n_partners: int = whole(_PARAMETER, "Number of pairs of bounding spheres between which contacts are declared.")
    n_paired: int = whole(_PARAMETER, "Number of rows between bounding spheres.")
    n_half_spaces: int = whole(_PARAMETER, "Number of rows with an unbounded shape.")
    n_searches: int = whole(_PARAMETER, "Number of searches for candidate features.")
    n_pairs: int = whole(_PARAMETER, "Number of pairs of convex parts.")
    n_carriers: int = whole(_PARAMETER, "Number of frames that carry convex parts.")
    n_own_guards: int = whole(_PARAMETER, "Number of guards that the user declared.")
    n_loads: int = whole(_PARAMETER, "Number of loads.")
    n_joints: int = whole(_PARAMETER, "Number of joints.")
    n_articulations: int = whole(_PARAMETER, "Number of sets of bodies that joints tie together; a single body is one.")
    n_q: int = whole(_PARAMETER, "Number of coordinates of all bodies.")
    n_u: int = whole(_PARAMETER, "Number of velocities of all bodies.")
    n_y: int = whole(_PARAMETER, "Length of the integrated state: q, u, energy accounts, inner states of laws.")
    n_states: int = whole(_PARAMETER, "Number of inner states of all laws.")
    most_velocities: int = whole(_PARAMETER, "Largest number of velocities of an articulation with contacts.")
    n_pivoted: int = whole(_PARAMETER, "Largest number of contacts that Lemke's method solves together.")
    map_width: int = whole(_PARAMETER, "Numbers that an impact law which maps velocities takes of a contact.")
    event_floats: int = whole(_PARAMETER, "Length of the buffer of floats of events.")
    event_integers: int = whole(_PARAMETER, "Length of the buffer of integers of events.")
    sample_capacity: int = whole(_PARAMETER, "Number of samples that the buffer holds.")
    entry_points: IntegerRow = integers(
        _PARAMETER, fixed(len(ENTRY_POINTS)), "Addresses of the entry points.", is_address=True
    )
    partner: IntegerRow = integers(
        _PARAMETER, per(1, "n_partners"), "Second bounding sphere of each pair, ascending for each first one."
    )
    partner_row: IntegerRow = integers(_PARAMETER, ends("n_partners"), "First of each pair in `paired_row`.")
    paired_row: IntegerRow = integers(_PARAMETER, per(1, "n_paired"), "Rows of contacts, sphere pair after pair.")


@final
class Options(Singleton, key="options"):
    """Options of the engine, and what the laws of a system need of it."""

    impact_map: int = address(_PARAMETER, "Address of the impact law that maps velocities, or 0.")
    painleve_policy: Painleve = one_of(Painleve, _PARAMETER, "What to do if sliding has no contact force.")
    solver: Solver = one_of(Solver, _PARAMETER, "Solver of the contact problem.")
    widest_margin: float = real(_PARAMETER, "m", "Largest margin of the neighbour list.")


@final
class Tolerance(Singleton, key="tolerance"):
    """Tolerances of time, gaps and velocities, and of the integration."""

    gap: float = real(_PARAMETER, "m", "Gap that counts as zero.")
    velocity: float = real(_PARAMETER, "m/s", "Velocity that counts as zero.")
    resolution: float = real(_PARAMETER, "s", "Least time tolerance.")
    relative: float = real(_PARAMETER, "1", "Relative tolerance of a step.")
    impact: float = real(_PARAMETER, "1", "Relative tolerance of a step of an impact.")
    largest_step: float = real(_PARAMETER, "s", "Largest step.")
    time: float = real(
        Life.REUSED, "s", "Time that counts as zero: the resolution, or a few spacings of floats at the present time."
    )


@final
class Coefficients(Singleton, key="coefficients"):
    """Coefficients of the Runge-Kutta pairs."""

    nodes: FloatRow = floats(_PARAMETER, fixed(N_STAGES), "1", "Times of the explicit stages within a step.")
    stages: FloatRow = floats(_PARAMETER, fixed(6 * N_STAGES), "1", "Coefficients of the explicit stages.")
    error_weights: FloatRow = floats(_PARAMETER, fixed(N_STAGES), "1", "Weights of the explicit error estimate.")
    dense: FloatRow = floats(_PARAMETER, fixed(4 * N_STAGES), "1", "Coefficients of the explicit dense output.")
    implicit_nodes: FloatRow = floats(_PARAMETER, fixed(N_STAGES), "1", "Times of the implicit stages within a step.")
    implicit_stages: FloatRow = floats(_PARAMETER, fixed(6 * N_STAGES), "1", "Coefficients of the implicit stages.")
    implicit_predictor: FloatRow = floats(_PARAMETER, fixed(6 * N_STAGES), "1", "Coefficients of the implicit guess.")
    implicit_errors: FloatRow = floats(_PARAMETER, fixed(N_STAGES), "1", "Weights of the implicit error estimate.")
    implicit_bend: FloatRow = floats(_PARAMETER, fixed(N_STAGES), "1", "Weights of the curvature of an implicit step.")
