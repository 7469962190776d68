"""Values of the guards, with and without the contact forces."""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_kinematics
from nonsmooth.engine.flow.deflation import deflate
from nonsmooth.engine.flow.flow import right_hand_side, value_of_normal_guard, value_of_slip_guard
from nonsmooth.engine.flow.guard_numbers import end_of, first_user_guard, friction_of, normal_of
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, at, call_guard, entry_point, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED

NO_FEATURE = -1
"""Number of features that is stored for a contact whose change of features is no event."""
_END_DISTANCE = 2.0
"""Distance past the end of a feature at which a closed contact ends, in gap tolerances. A contact may close up to one
gap tolerance past the end, and must not end at once."""


@kernel("f8(ws, ContactRecord)")
def feature_guard(ws: Workspace, contact: ContactRecord) -> float:
    """End guard of a closed contact [m]: the distance to the end of its features, negative past it.

    Features are the faces, edges or corners in contact. The guard fires if they change: a positive distance then gets a
    negative sign. They have changed if their number differs from that at the start of the step. They have changed, too,
    if the gap of a closed rigid contact changes faster than the tolerances allow: the normal is then that of another
    face. A contact with averaged forces is excepted.
    """
    # a contact may close a gap tolerance past the end, so the guard ends two of them past it; without an end it is 1
    distance = _END_DISTANCE * ws.tolerance.gap - contact.past_feature if contact.past_feature != 0.0 else 1.0
    # features are numbered; with NO_FEATURE a change is no event in this step
    is_unchanged = contact.feature == NO_FEATURE or int(contact.feature_now) == contact.feature
    is_held = not (contact.is_compliant or contact.is_averaged)
    leaves = is_held and abs(contact.normal_rate) > ALLOWED * ws.tolerance.velocity
    return distance if distance < 0.0 or (is_unchanged and not leaves) else -distance


@kernel("b1(ws, ContactRecord)")
def has_other_features(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a contact whose end guard fired has passed to other features, False if its features ended."""
    # after a change the witness points are within the new features, so the distance past their end is not positive
    return contact.past_feature <= ws.tolerance.gap


@kernel()
def store_features(ws: Workspace) -> None:
    """Store the features of the closed contacts. The step that begins compares its features with them.

    Right after a change of features ``NO_FEATURE`` is stored: a contact that moves along the border of two features
    would change them again and again.
    """
    may_change = ws.island.time - ws.island.last_feature_change > ws.tolerance.time
    for contact in ws.contacts:
        contact.feature = int(contact.feature_now) if may_change and contact.mode != Mode.OPEN else NO_FEATURE


@entry_point("void(ws, f8, i8, b1)")
def write_guards(ws: Workspace, t: float, y: int, forces_are_known: bool) -> None:
    """Write all guards at time ``t`` [s] and state ``y``, where the right-hand side was evaluated.

    Without known forces the normal and friction guards of closed contacts keep their values. Gaps are evaluated here.
    """
    _write_guards_of_forces_and_user(ws, t, y, forces_are_known)
    for contact in ws.contacts:
        # the closed contact of a body with an own step (multirate) is not in the right-hand side
        steps_alone = has_own_step(ws, contact.index)
        _write_end_guard(ws, contact, forces_are_known and not steps_alone)
        if contact.mode == Mode.OPEN or steps_alone:
            _write_gap(ws, contact)
        if steps_alone:
            # its gap is needed for the drift from its constraint, but no guard may fire before the own step ends
            normal_of(ws, contact).value = 1.0


@kernel("void(ws, ContactRecord)")
def _write_gap(ws: Workspace, contact: ContactRecord) -> None:
    """Evaluate the geometry and the rates of an open contact, and write its gap as its normal guard."""
    evaluate_kinematics(ws, contact.index)
    normal_of(ws, contact).value = contact.gap
    # an open contact has no friction: its guard is positive and cannot fire
    friction_of(ws, contact).value = 1.0
    # the rate of the guard: later evaluations of the contact overwrite normal_rate
    contact.gap_rate = contact.normal_rate


@kernel("void(ws, f8, i8, b1)")
def _write_guards_of_forces_and_user(ws: Workspace, t: float, y: int, forces_are_known: bool) -> None:
    """Write the force guards of closed contacts, and the guards of the user: functions of time and state alone."""
    # gaps need the driven bodies, which the right-hand side evaluates only with closed contacts
    if ws.island.n_grouped == 0:
        evaluate_driven_bodies(ws, t, y)
    elif forces_are_known:
        for i in range(ws.island.n_grouped):
            _write_force_guards(ws, ws.contacts[ws.island.grouped[i]])
    for user in ws.own_guards:
        value = call_guard(
            user.function, t, at(ws.floats, y), at(ws.floats, y + ws.model.n_q), at(ws.floats, user.parameters)
        )
        ws.guards[first_user_guard(ws) + user.index].value = value


@kernel("void(ws, ContactRecord, b1)")
def _write_end_guard(ws: Workspace, contact: ContactRecord, may_end: bool) -> None:
    """Write the end guard of a contact. It is 1, so that it cannot fire, for an open contact, or unless it ``may_end``.

    No contact may end without known forces, nor that of a body with an own step.
    """
    end_of(ws, contact).value = feature_guard(ws, contact) if may_end and contact.mode != Mode.OPEN else 1.0


@kernel("void(ws, ContactRecord)")
def _write_force_guards(ws: Workspace, contact: ContactRecord) -> None:
    """Write the normal and the friction guard of a closed contact, whose force was evaluated.

    The friction guard is the distance to the static bound if the contact sticks, else the slip.
    """
    # the rate of the guard: later evaluations of the contact overwrite normal_rate
    contact.gap_rate, sticks = contact.normal_rate, contact.mode == Mode.STICK
    normal_of(ws, contact).value = value_of_normal_guard(ws, contact.index)
    friction_of(ws, contact).value = contact.static_margin if sticks else value_of_slip_guard(ws, contact.index)


@kernel("void(ws, f8, i8)")
def evaluate_motion(ws: Workspace, t: float, y: int) -> None:
    """Evaluate the bodies at time ``t`` [s] and state ``y``, without contact forces: enough for gaps and user guards.

    Bodies in ballistic motion are evaluated only if one of their gaps may close in the step.
    """
    evaluate_driven_bodies(ws, t, y)
    evaluate_free_bodies(ws, t, y, of_all_bodies=False)
    _evaluate_ballistic_bodies(ws, t, y)


@kernel("void(ws, f8, i8)")
def _evaluate_ballistic_bodies(ws: Workspace, t: float, y: int) -> None:
    """Evaluate the ballistic bodies of the gaps that may close in the step, at time ``t`` [s] and state ``y``."""
    for i in range(ws.step.n_may_close):
        _evaluate_ballistic_bodies_of(ws, t, y, ws.contacts[ws.step.may_close[i]])


@kernel("void(ws, f8, i8, ContactRecord)")
def _evaluate_ballistic_bodies_of(ws: Workspace, t: float, y: int, contact: ContactRecord) -> None:
    """Evaluate the ballistic bodies among the two of a contact, at time ``t`` [s] and state ``y``.

    Bodies in ballistic motion follow a closed form, so the right-hand side does not evaluate them.
    """
    if ws.bodies[contact.body_a].is_ballistic:
        evaluate_body(ws, t, y, contact.body_a)
    if ws.bodies[contact.body_b].is_ballistic:
        evaluate_body(ws, t, y, contact.body_b)


@kernel("void(ws, f8, i8, f8, b1)")
def evaluate_guards(ws: Workspace, t: float, y: int, elapsed: float, needs_forces: bool) -> None:
    """Evaluate motion and guards within the step, ``elapsed`` [s] after its start: at time ``t`` [s] and state ``y``.

    Gaps that cannot close in the step keep their values. Guards of closed contacts do so unless it ``needs_forces``.
    Of guards that are zero at the start of the step, the growth over the elapsed time takes the place of the value.
    """
    if needs_forces:
        right_hand_side(ws, t, y, may_choose=False, of_all_bodies=False)
        _evaluate_ballistic_bodies(ws, t, y)
    else:
        evaluate_motion(ws, t, y)
    _write_guards_of_forces_and_user(ws, t, y, needs_forces)
    for contact in ws.contacts:
        _write_end_guard(ws, contact, needs_forces and not has_own_step(ws, contact.index))
    for i in range(ws.step.n_may_close):
        _write_gap(ws, ws.contacts[ws.step.may_close[i]])
    deflate(ws, elapsed)
