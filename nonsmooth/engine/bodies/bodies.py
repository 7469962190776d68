"""Bodies, loads and articulations at a state: their frames, forces and inverse masses.

Every body writes its own output block. Each evaluation gets a new version number, by which contacts recognise that they
were evaluated at the same motion. An instant evaluates most bodies several times at the same state. Then only the
bodies whose state changed are evaluated.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.articulations import evaluate_articulation
from nonsmooth.engine.bodies.equations import force_without_contacts
from nonsmooth.engine.bodies.kinematics import entry_of_column, evaluate_contact
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import (
    BodyRecord,
    Workspace,
    at,
    call_body,
    call_load,
    entry_point,
    frame_at,
    kernel,
    load_wrench,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import minus, opposite


@kernel("void(ws, f8, i8, BodyRecord)")
def _call_body(ws: Workspace, t: float, y: int, body: BodyRecord) -> None:
    """Call the function of a body. It writes the output block of the body at time ``t`` [s] and the state at ``y``."""
    q, u = at(ws.floats, y + body.q), at(ws.floats, y + ws.model.n_q + body.u)
    call_body(body.function, t, q, u, at(ws.floats, body.parameters), at(ws.floats, body.out))


@kernel("void(ws, f8, i8, i8)")
def evaluate_body(ws: Workspace, t: float, y: int, number: int) -> None:
    """Evaluate body ``number`` at time ``t`` [s] and the state at offset ``y``.

    Its output block gets a new version, by which contacts see that they must be evaluated again. ``free_time``, the
    time at which all bodies with coordinates were evaluated, becomes unknown (NaN).
    """
    body = ws.bodies[number]
    _call_body(ws, t, y, body)
    body.version += 1
    # a driven body has no velocities, and keeps a time of its own
    if body.n_u > 0:
        ws.island.free_time = math.nan


@kernel("b1(ws, f8, i8, BodyRecord)")
def _is_evaluated_at(ws: Workspace, t: float, y: int, body: BodyRecord) -> bool:
    """True if the last evaluation of a body was at time ``t`` [s] and the state at ``y``.

    ``y_evaluated`` holds q and u of the evaluation ``evaluated_version``. It is not the last one if the body was then
    evaluated at a state that is not stored, such as a stage of a step. Version 0: the body was never evaluated.
    """
    if body.version == 0 or body.evaluated_version != body.version or body.evaluated_time != t:
        return False
    for i in range(body.q, body.q + body.n_q):
        if ws.island.y_evaluated[i] != ws.floats[y + i]:
            return False
    for i in range(ws.model.n_q + body.u, ws.model.n_q + body.u + body.n_u):
        if ws.island.y_evaluated[i] != ws.floats[y + i]:
            return False
    return True


@kernel("void(ws, f8, i8, i8)")
def evaluate_if_changed(ws: Workspace, t: float, y: int, number: int) -> None:
    """Evaluate body ``number`` at time ``t`` [s] and state ``y``, and store these for later comparison.

    At the time and state of its last evaluation it keeps its version, so that its contacts are not evaluated again.
    Loads add to the forces in its output block. So the block is written again even then, except for a body with a
    ballistic motion in closed form, which is for bodies without loads and joints.
    """
    body = ws.bodies[number]
    if _is_evaluated_at(ws, t, y, body):
        if body.ballistic_function == 0:
            _call_body(ws, t, y, body)
        return
    evaluate_body(ws, t, y, number)
    body.evaluated_version, body.evaluated_time = body.version, t
    for i in range(body.q, body.q + body.n_q):
        ws.island.y_evaluated[i] = ws.floats[y + i]
    for i in range(ws.model.n_q + body.u, ws.model.n_q + body.u + body.n_u):
        ws.island.y_evaluated[i] = ws.floats[y + i]


@kernel("b1(ws, f8, i8)")
def _are_all_evaluated_at(ws: Workspace, t: float, y: int) -> bool:
    """True if all bodies with coordinates were evaluated last at time ``t`` [s] and state ``y``.

    Then none needs to be evaluated. It is never true with loads or joints: they must be evaluated again in any case.
    ``free_time`` is the time of the last evaluation of all, or NaN, which equals no time, if one was evaluated since.
    """
    if ws.island.free_time != t or ws.model.n_loads + ws.model.n_joints > 0:
        return False
    n_different = 0
    # without a branch the compiler compares several numbers at once
    for i in range(ws.model.n_q + ws.model.n_u):
        n_different += 1 if ws.island.y_evaluated[i] != ws.floats[y + i] else 0
    return n_different == 0


@kernel("void(ws, f8, i8)")
def evaluate_driven_bodies(ws: Workspace, t: float, y: int) -> None:
    """Evaluate the driven bodies at time ``t`` [s], unless that was their last evaluation.

    They have no velocities (n_u = 0), and depend on time only. ``y`` is the offset of any state.
    """
    if t == ws.island.driven_time:
        return
    ws.island.driven_time = t
    for body in ws.bodies:
        if body.n_u == 0:
            evaluate_body(ws, t, y, body.index)


@kernel("void(ws, f8, i8)")
def evaluate_integrated_bodies(ws: Workspace, t: float, y: int) -> None:
    """Evaluate the bodies that the integrator steps at time ``t`` [s] and state ``y``, without loads and joints.

    The other bodies are driven, or move in closed form. The powers of driven bodies and loads begin at zero.
    """
    _start_evaluation(ws, y)
    for i in range(ws.island.n_integrated):
        evaluate_body(ws, t, y, ws.island.integrated[i])


@kernel("void(ws, i8)")
def _start_evaluation(ws: Workspace, y: int) -> None:
    """Set the powers of driven bodies and loads to zero, and let kinematics use the velocities of the state ``y``.

    Also counts the work, so that a long run can be interrupted.
    """
    # the loop over steps handles an interruption, so the result is not used
    interrupted(ws, ws.island.n_contacts + ws.model.n_bodies)
    ws.island.velocities = y + ws.model.n_q
    ws.step.driven_power = 0.0
    ws.step.load_power = 0.0


@entry_point("void(ws, f8, i8, b1)")
def evaluate_free_bodies(ws: Workspace, t: float, y: int, of_all_bodies: bool) -> None:
    """Evaluate the bodies with coordinates at time ``t`` [s] and state ``y``, then the loads and joints on them.

    ``of_all_bodies``: all bodies with coordinates, else only those that the integrator steps. The powers of driven
    bodies and loads begin at zero, and get the parts of loads and joints.
    """
    # the frequent case, without the tests of the loop below
    if not of_all_bodies and ws.model.n_loads + ws.model.n_joints == 0:
        evaluate_integrated_bodies(ws, t, y)
        return
    _start_evaluation(ws, y)
    # loads and joints may act on driven bodies
    if ws.model.n_loads + ws.model.n_joints > 0:
        evaluate_driven_bodies(ws, t, y)
    # then there are no loads and joints either
    if of_all_bodies and _are_all_evaluated_at(ws, t, y):
        return
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        number = i if of_all_bodies else ws.island.integrated[i]
        # a driven body has no coordinates
        if ws.bodies[number].n_u == 0:
            continue
        _clear_forces(ws, ws.bodies[number])
        # an event evaluates all bodies repeatedly at one state; the states of stages of a step differ
        if of_all_bodies:
            evaluate_if_changed(ws, t, y, number)
        else:
            evaluate_body(ws, t, y, number)
    # each evaluation above has set it to NaN
    if of_all_bodies:
        ws.island.free_time = t
    for load in range(ws.model.n_loads):
        _apply_load(ws, load, t, y)
    if ws.model.n_joints > 0:
        _evaluate_articulations(ws, y)


@kernel("void(ws, BodyRecord)")
def _clear_forces(ws: Workspace, body: BodyRecord) -> None:
    """Set the generalised forces of a body to zero before it is evaluated.

    Loads have added to them, and the function of a body need not write zeros. A body with a ballistic motion in closed
    form has no loads.
    """
    if ws.model.n_loads > 0 and body.ballistic_function == 0:
        force = force_without_contacts(ws, body)
        for j in range(body.n_u):
            force[j] = 0.0


@kernel("void(ws, i8)")
def _evaluate_articulations(ws: Workspace, y: int) -> None:
    """Evaluate the articulations (groups of bodies tied by joints) that have joints, at the state ``y``.

    The velocities are copied to ``u_free``, which loses the part that driven bodies prescribe through joints. Contacts
    then take their velocities from there, and count the rest as prescribed.
    """
    for i in range(ws.model.n_u):
        ws.island.u_free[i] = ws.floats[y + ws.model.n_q + i]
    ws.island.velocities = ws.island.u_free.start
    for articulation in ws.articulations:
        if articulation.n_rows > 0:
            evaluate_articulation(ws, articulation)


@kernel("void(ws, f8, i8)")
def evaluate_bodies(ws: Workspace, t: float, y: int) -> None:
    """Evaluate all bodies, loads and joints at time ``t`` [s] and the state at offset ``y``."""
    evaluate_driven_bodies(ws, t, y)
    evaluate_free_bodies(ws, t, y, of_all_bodies=True)


@kernel("void(ws, i8, f8, i8)")
def _apply_load(ws: Workspace, number: int, t: float, y: int) -> None:
    """Add the generalised forces of a load at time ``t`` [s] to those of its bodies, and its power to ``load_power``.

    The wrench acts on the second body, and the opposite wrench on the first one. A driven body gets no forces, and its
    power does not count, because it has no energy. The velocities for the power are those of the state ``y``.
    """
    load = ws.loads[number]
    frame_a, frame_b = at(ws.floats, load.frame_a), at(ws.floats, load.frame_b)
    call_load(load.function, t, frame_a, frame_b, at(ws.floats, load.parameters), at(ws.floats, load.out))
    wrench = load_wrench(ws.floats, load.out)
    for side in range(2):
        body = ws.bodies[load.body_a if side == 0 else load.body_b]
        frame = load.frame_a if side == 0 else load.frame_b
        n_u, generalised = body.n_u, force_without_contacts(ws, body)
        force = opposite(wrench.force) if side == 0 else wrench.force
        moment = opposite(wrench.moment) if side == 0 else wrench.moment
        rx, ry, rz = minus(wrench.point, frame_at(ws.floats, frame).origin)
        fx, fy, fz = force
        # the moment about the origin of the frame
        mx = moment[0] + ry * fz - rz * fy
        my = moment[1] + rz * fx - rx * fz
        mz = moment[2] + rx * fy - ry * fx
        for j in range(n_u):
            # column j of the Jacobian of the frame, which is stored behind its motion
            added = entry_of_column(ws.floats, frame + FRAME + j, n_u, force, (mx, my, mz))
            generalised[j] += added
            ws.step.load_power += added * ws.floats[y + ws.model.n_q + body.u + j]


@entry_point()
def evaluate_at(ws: Workspace) -> None:
    """Evaluate all bodies and all contacts on the neighbour list at the present time and state, for Python."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for contact in ws.contacts:
        evaluate_contact(ws, contact.index, rows=3)
