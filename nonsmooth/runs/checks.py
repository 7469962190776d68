"""Checks before a run begins: of the arguments of the call, and of the initial state.

A user may write any arrays into a state, and a state may come from a file.
"""

from __future__ import annotations

import numpy as np

from nonsmooth.checks import check_callable, is_finite
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.numerics.tolerances import ALLOWED
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.model.declared import searched
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.loop import Progress
from nonsmooth.runs.so_far import Until
from nonsmooth.solution.end import RunRequest
from nonsmooth.solution.state import State
from nonsmooth.system.input_checks import check_quaternion

_DEFAULT_SAMPLES = 2000
"""Number of samples if no interval is given: enough for a curve as wide as a screen."""
_MOST_SAMPLES = 10**8
"""Largest number of samples of a run. The samples of one small body then fill the memory of most machines."""
_MOST_STEPS = 10**10
"""Largest number of steps of a run. At a microsecond a step, the shortest possible time, they take three hours."""


def check_calls(name: str, until: Until | None, progress: Progress | None) -> None:
    """Check that ``until`` and ``progress`` of the method ``name`` can be called.

    Raises
    ------
    InvalidInput
        If one of them is not a function, or takes other arguments.
    """
    check_callable(f"{name}: until", until, "until(run)")
    check_callable(f"{name}: progress", progress, "progress(t, t_end)")


def check_steps(duration: float, largest_step: float) -> None:
    """Check that a run of a duration [s] can end within hours if no step exceeds ``largest_step`` [s], 0 if unlimited.

    Raises
    ------
    InvalidInput
        If the run would take more than 1e10 steps.
    """
    if largest_step > 0.0 and duration > _MOST_STEPS * largest_step:
        raise InvalidInput(
            "run: largest step",
            f"must be at least {duration / _MOST_STEPS:.3g} s for a run of {duration:.6g} s, {_MOST_STEPS:.0e} steps",
            largest_step,
            "It is the least of EventDriven.largest_step and, of prescribed motions, the time scale over "
            "EventDriven.steps_per_period. Run for a shorter time, or let the motion change more slowly.",
        )


def check_times(name: str, t_end: float, sample_interval: float | None, start: float = 0.0) -> float:
    """Check the times of a run that begins at ``start`` [s], and return the time between its samples [s].

    The default ``None`` gives a 2000th of the run. ``name`` is the user's call, for messages. The comparisons are
    written so that NaN fails them.

    Raises
    ------
    InvalidInput
        If the end time is not after the start, a time is not finite, or the interval is not positive or too short.
    """
    if not is_finite(t_end) or not t_end > start:
        rule = "must be positive and finite" if start == 0.0 else f"must be finite and after the start at {start:.9g} s"
        raise InvalidInput(f"{name}: t_end", rule, t_end, "Give it in [s].")
    interval = (t_end - start) / _DEFAULT_SAMPLES if sample_interval is None else sample_interval
    if not (is_finite(interval) and interval > 0.0):
        raise InvalidInput(f"{name}: sample_interval", "must be positive and finite", interval, "Give it in [s].")
    if not t_end - start <= _MOST_SAMPLES * interval:
        rule = f"must give at most {_MOST_SAMPLES:.0e} samples within {t_end - start:.6g} s"
        raise InvalidInput(f"{name}: sample_interval", rule, interval, "Take a longer one, in [s].")
    return interval


def checked_request(folder: SolutionFolder, until: Until | None) -> RunRequest:
    """Arguments of a run that was cut off, read from its folder, so that it can be resumed with them.

    Raises
    ------
    InvalidInput
        If the run was not cut off, the condition ``until`` that it had is not given, or the folder is damaged.
    """
    folder.check_cut_off()
    request = folder.request
    if request.is_conditional and until is None:
        raise InvalidInput(
            f"resume {folder.place}: until",
            "must be given for a run that was to end on a condition, which no file holds",
            None,
            "Give the same function: nonsmooth.resume(folder, until=...).",
        )
    check_times(f"resume {folder.place}", request.t_end, request.sample_interval, request.sample_start)
    return request


_INTEGERS = ("modes", "guards_spent")
_REALS = ("q", "u", "slip_directions", "closing_rates", "features", "law_states")
_REMEDY = "Take a state of this system: solution.state of a run of it, or State.at(system, ...)."


def check_arrays(model: LaidOut, state: State) -> None:
    """Check kind and shape of the arrays of a state, and the values of its modes and of its marks of guards.

    A mark is 1 if the guard of the user has just fired.

    Raises
    ------
    InvalidInput
        If the state does not fit the model.
    """
    n = len(model.system.contacts)
    shapes = {
        "q": (model.n_q,),
        "u": (model.n_u,),
        "modes": (n,),
        "slip_directions": (n, 2),
        "closing_rates": (n,),
        "features": (n, CANDIDATE),
        "law_states": (model.n_states,),
        "guards_spent": (len(model.system.guards),),
    }
    if not is_finite(state.time):
        raise InvalidInput("State.time", "must be finite", state.time, "Give it in [s].")
    for name, shape in shapes.items():
        # kinds of numpy types: booleans, signed and unsigned integers, floats
        value, kinds = getattr(state, name), "biu" if name in _INTEGERS else "biuf"
        if value.dtype.kind not in kinds:
            rule = f"must be {'integers' if name in _INTEGERS else 'numbers'}"
            raise InvalidInput(f"State.{name}", rule, f"an array of {value.dtype}", _REMEDY)
        if value.shape != shape:
            raise InvalidInput(f"State.{name}", f"must have the shape {shape} of this model", value.shape, _REMEDY)
    if not {*state.modes.tolist()} <= {Mode.OPEN, Mode.STICK, Mode.SLIDE}:
        raise InvalidInput("State.modes", "must be 0 (open), 1 (stick) or 2 (slide)", state.modes.tolist(), _REMEDY)
    if not {*state.guards_spent.tolist()} <= {0, 1}:
        raise InvalidInput("State.guards_spent", "must be 0 or 1", state.guards_spent.tolist(), _REMEDY)


def check_numbers(model: LaidOut, state: State) -> None:
    """Check that the numbers of a state are finite and its quaternions have unit length.

    Raises
    ------
    InvalidInput
        If a number is not finite, or the length of a quaternion is not 1.
    """
    for name in _REALS:
        value = getattr(state, name).ravel()
        wrong = np.flatnonzero(~np.isfinite(value))
        if len(wrong) > 0:
            remedy = f"Correct entry {wrong[0]}. A failed run may leave such a state."
            raise InvalidInput(f"State.{name}", "must be finite numbers", float(value[wrong[0]]), remedy)
    # q has the coordinates of each body in turn
    first = 0
    for body in model.system.bodies:
        check_quaternion(f"State.q of {model.system.name_of(body)!r}", body, state.q[first : first + body.n_q])
        first += body.n_q


def check_closed(model: LaidOut, state: State) -> None:
    """Check that the closed contacts of the state in the memory have no gap, as a user's change of q may open one.

    Raises
    ------
    InvalidInput
        If the gap of a closed contact exceeds the reach of its law by more than a thousand gap tolerances.
    """
    if not np.any(state.modes):
        return
    gaps = model.gaps()
    allowed = ALLOWED * float(model.memory[owners.Tolerance.gap])
    for number in np.flatnonzero(state.modes).tolist():
        normal = model.system.contacts[number].normal
        # a compliant law may act before the surfaces touch
        reach = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0
        # the gap is infinite if the bodies are far apart, and may be NaN
        if not gaps[number] <= reach + allowed:
            raise InvalidInput(
                f"State.modes[{number}], the {model.system.contacts[number]},",
                f"must be 0, open, because its gap is {gaps[number]:.3g} m",
                int(state.modes[number]),
                "If you changed q, begin with State.at(system, time, q, u).",
            )


def check_candidates(model: LaidOut) -> None:
    """Check the pair of features that a search has found for each contact, in a state that comes from a file.

    The kinematics of the contact uses the numbers of the features as places in a table. A wrong number would read
    outside of the table. Contacts without a search, or for which no pair was found, are not checked.

    Raises
    ------
    InvalidInput
        If a feature does not exist, or the distance up to which the pair is valid is negative or not finite.
    """
    # offset of the numbers of a pair. These are the kind of the pair, 0 if none
    # were found; one feature of either shape; behind these, the distance up to which the pair is valid [m]
    numbers, places = searched(model.memory)
    has_pair = model.memory.floats[places] != 0.0
    for number, place in zip(numbers[has_pair].tolist(), places[has_pair].tolist(), strict=True):
        contact = model.system.contacts[number]
        search = contact.kinematics.candidates
        assert search is not None
        kind, *features, distance = model.memory.floats[place:][: CANDIDATE + 1].tolist()
        # counts has, by kind, how many features each of the shapes has; an unknown kind has none
        pair = zip(features, search.counts.get(kind, (0, 0)), strict=True)
        exist = all(feature.is_integer() and 0 <= feature < count for feature, count in pair)
        if not (exist and 0.0 <= distance < np.inf):
            kinds = " or ".join(f"({key:g}, below {one}, below {two})" for key, (one, two) in search.counts.items())
            raise InvalidInput(
                f"State.continuation: the features of the {contact}",
                f"must be one of {kinds}, with a finite distance",
                (kind, *features, distance),
                "The file is damaged: take another.",
            )
