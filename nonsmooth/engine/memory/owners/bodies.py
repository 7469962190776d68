"""Numbers of bodies and of the articulations, joints and loads that tie them. An offset counts all floats."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import Life, Record, address, question, real, whole

_PARAMETER, _REUSED = Life.PARAMETER, Life.REUSED


@final
class BodyRecord(Record, key="bodies", capacity="n_bodies", length="model.n_bodies"):
    """A body."""

    q: int = whole(_PARAMETER, "First of its coordinates among all.")
    u: int = whole(_PARAMETER, "First of its velocities among all.")
    n_q: int = whole(_PARAMETER, "Number of its coordinates.")
    n_u: int = whole(_PARAMETER, "Number of its velocities, 0 for a driven body.")
    function: int = address(_PARAMETER, "Address of the function that writes its frames and its tail.")
    parameters: int = whole(_PARAMETER, "Offset of the parameters of that function.")
    out: int = whole(_PARAMETER, "Offset of its frames.")
    tail: int = whole(_PARAMETER, "Offset of its rates of q, forces, inverse mass and energies.")
    quaternion: int = whole(_PARAMETER, "First of its quaternion among its coordinates, or -1.")
    spin: int = whole(_PARAMETER, "First of its spin among its velocities, or -1.")
    ballistic_function: int = address(_PARAMETER, "Address of its ballistic motion in closed form, or 0.")
    ballistic_parameters: int = whole(_PARAMETER, "Offset of the parameters of that function.")
    ballistic_out: int = whole(_PARAMETER, "Offset at which that function writes.")
    is_ballistic: bool = question(Life.DERIVED, "It is in ballistic motion in closed form.")
    spins_apart: bool = question(_REUSED, "Its spin is integrated apart, along axes in space.")
    has_own_step: bool = question(Life.STATE, "It takes a step of its own (multirate).")
    own_step_time: float = real(Life.STATE, "s", "Start of its own step.")
    own_step: float = real(Life.STATE, "s", "Length of its own step.")
    n_closed: int = whole(_REUSED, "Number of its closed contacts.")
    version: int = whole(_REUSED, "Number of its last evaluation.")
    evaluated_version: int = whole(_REUSED, "Evaluation at `evaluated_time` and `y_evaluated`.")
    evaluated_time: float = real(_REUSED, "s", "Time of that evaluation.")
    accelerated_version: int = whole(_REUSED, "Evaluation for which its free acceleration is known.")


@final
class Articulation(Record, key="articulations", capacity="n_articulations", length="model.n_articulations"):
    """Bodies that joints tie together, which stand next to each other; a single body is one, too."""

    u: int = whole(_PARAMETER, "First of its velocities among all.")
    n_u: int = whole(_PARAMETER, "Number of its velocities.")
    first_body: int = whole(_PARAMETER, "Its first body.")
    n_bodies: int = whole(_PARAMETER, "Number of its bodies.")
    inverse: int = whole(_PARAMETER, "Offset of its inverse mass matrix.")
    first_joint: int = whole(_PARAMETER, "Its first joint.")
    n_joints: int = whole(_PARAMETER, "Number of its joints.")
    n_rows: int = whole(_PARAMETER, "Number of rows of its joints.")
    is_driven: bool = question(_PARAMETER, "A joint ties it to a driven body.")
    jacobian: int = whole(_PARAMETER, "Offset of the Jacobian of its joints.")
    response: int = whole(_PARAMETER, "Offset of the Jacobian times the inverse mass matrix of the single bodies.")
    solved_response: int = whole(_PARAMETER, "Offset of that response, solved for the forces of the joints.")
    factor: int = whole(_PARAMETER, "Offset of the factor of the matrix of its joints.")
    residual: int = whole(_PARAMETER, "Offset of the residuals of its joints.")
    rate: int = whole(_PARAMETER, "Offset of the rates that its joints prescribe.")
    bias: int = whole(_PARAMETER, "Offset of the accelerations that its joints prescribe.")
    forces: int = whole(_PARAMETER, "Offset of the forces of its joints.")
    root: int = whole(Life.SOLUTION, "Parent in the forest that finds the groups.")
    group: int = whole(Life.SOLUTION, "Its group.")
    first_colliding: int = whole(Life.IMPACT, "First entry of its list of colliding contacts, or -1.")
    first_linked: int = whole(Life.SOLUTION, "First entry of its list of active contacts, or -1.")


@final
class JointRecord(Record, key="joints", capacity="n_joints", length="model.n_joints"):
    """A joint between two bodies of an articulation."""

    function: int = address(_PARAMETER, "Address of the function that writes its rows.")
    parameters: int = whole(_PARAMETER, "Offset of the parameters of that function.")
    frame_a: int = whole(_PARAMETER, "Offset of the frame on the first body.")
    frame_b: int = whole(_PARAMETER, "Offset of the frame on the second body.")
    n_u_a: int = whole(_PARAMETER, "Number of velocities of the first body.")
    n_u_b: int = whole(_PARAMETER, "Number of velocities of the second body.")
    column_a: int = whole(_PARAMETER, "First velocity of the first body in its articulation.")
    column_b: int = whole(_PARAMETER, "First velocity of the second body in its articulation.")
    first_row: int = whole(_PARAMETER, "First of its rows in its articulation.")
    n_rows: int = whole(_PARAMETER, "Number of its rows.")
    out: int = whole(_PARAMETER, "Offset at which the function writes.")


@final
class LoadRecord(Record, key="loads", capacity="n_loads", length="model.n_loads"):
    """A load on two bodies: a spring, a damper, a force of the user."""

    function: int = address(_PARAMETER, "Address of the function that writes force, point and moment.")
    parameters: int = whole(_PARAMETER, "Offset of the parameters of that function.")
    frame_a: int = whole(_PARAMETER, "Offset of the frame on the first body.")
    frame_b: int = whole(_PARAMETER, "Offset of the frame on the second body.")
    body_a: int = whole(_PARAMETER, "First body.")
    body_b: int = whole(_PARAMETER, "Second body.")
    depends_on_time: bool = question(_PARAMETER, "Its force depends on time other than through the two bodies.")
    out: int = whole(_PARAMETER, "Offset at which the function writes.")
