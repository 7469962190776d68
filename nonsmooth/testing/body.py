"""Properties of bodies that have coordinates, and of driven ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import UNITS_OF_Q, UNITS_OF_U
from nonsmooth.testing import block
from nonsmooth.testing.block import state, state_space, written
from nonsmooth.testing.body_flight import compiled_flight, flight_rows, flown, plain_flight
from nonsmooth.testing.body_frames import frame_rows
from nonsmooth.testing.body_free import free_rows
from nonsmooth.testing.budget import where
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, draws
from nonsmooth.testing.examine import examine
from nonsmooth.testing.functions import Function, Functions
from nonsmooth.testing.look import check_sketch
from nonsmooth.testing.property import Broken, Property, properties

_DRAWS = 12
_UNKNOWN = "no_such_word"


def check_body(body: Body) -> list[Property]:
    """Return the properties of a body.

    Parameters
    ----------
    body : Body
        The body; it is looked at around its start.
    """
    functions = Functions(lambda: [_evaluator(body), *([_flight(body)] if body.flight is not None else [])])
    rows = [
        (
            "start",
            "the start has the sizes that the body names, each number a unit, and unknown words are refused",
            lambda: _check_start(body),
        ),
        (
            "writes its block",
            "it writes every number that can be non-zero, whatever stood there, and nothing beyond the block",
            lambda: examine("writes its block", [body], state_space(body), _writes, _DRAWS),
        ),
        ("sketch", "what is seen of it besides its shapes can be drawn", lambda: check_sketch(body)),
        *frame_rows(body),
    ]
    if body.n_u > 0:
        rows += free_rows(body)
    if body.flight is not None:
        rows += flight_rows(body)
    return properties(body, [*component_rows(body), *functions.rows(), *functions.guarded(rows)])


def _evaluator(body: Body) -> Function:
    inputs = [(_words(case), state(body, case)) for case in draws(state_space(body), 6, "states")]

    def plain(at: Any) -> Any:
        return written(body, block.plain(body), *at)

    def compiled() -> Callable[[Any], Any]:
        call = block.compiled(body)
        return lambda at: written(body, call, *at)

    return Function(body, "evaluator", body.evaluator, "body", block.offered(body), plain, compiled, inputs)


def _flight(body: Body) -> Function:
    inputs = [(_words(case), state(body, case)) for case in draws(state_space(body), 6, "states")]

    def plain(at: Any) -> Any:
        return flown(body, plain_flight(body), *at)

    def compiled() -> Callable[[Any], Any]:
        call = compiled_flight(body)
        return lambda at: flown(body, call, *at)

    assert body.flight is not None
    return Function(body, "flight", body.flight, "body", block.offered(body), plain, compiled, inputs)


def _words(case: Case) -> str:
    return ", ".join(f"{name} = {value:.3g}" for name, value in case.items() if name == "t")


def _check_start(body: Body) -> None:
    q, u = body.state()
    for name, once, again in zip(("q", "u"), (q, u), body.state(), strict=True):
        if not np.array_equal(once, again):
            told = f"{np.asarray(once).tolist()} and {np.asarray(again).tolist()}"
            raise Broken(f"`state` gives another start each time: {where(type(body).state)}", name, told)
    for name, given, size in (("q", q, body.n_q), ("u", u, body.n_u)):
        if np.shape(given) != (size,) or not np.all(np.isfinite(given)):
            raise Broken(f"`state` must give {size} finite numbers", name, given)
    for name, scale, size in zip(("q", "u"), body.scales, (body.n_q, body.n_u), strict=True):
        if np.shape(scale) != (size,) or not np.all(np.isfinite(scale)) or not np.all(np.asarray(scale) > 0.0):
            raise Broken(f"`scales` must give {size} positive numbers", name, scale)
    for name, labels, units in (("q_labels", body.q_labels, UNITS_OF_Q), ("u_labels", body.u_labels, UNITS_OF_U)):
        wrong = [label for label in labels if not label[0] or label[1] not in units]
        if wrong or len(dict(labels)) < len(labels):
            raise Broken(f"`{name}` must give each number a name of its own and a unit of {units}", name, labels)
    if body.quaternion >= 0 and abs(float(np.linalg.norm(q[body.quaternion : body.quaternion + 4])) - 1.0) > 1e-12:
        raise Broken("the quaternion has no unit length", "quaternion", q.tolist())
    if not body.time_scale > 0.0:
        raise Broken("it must be positive", "time_scale", body.time_scale)
    try:
        body.state(**{_UNKNOWN: 0.0})
    except InvalidInput:
        return
    raise Broken("`state` takes words that it does not know", _UNKNOWN, 0.0)


def _writes(body: Body, case: Case) -> str:
    call, here = block.plain(body), state(body, case)
    clean = written(body, call, *here)
    other = {name: -0.9 * value + 0.11 for name, value in case.items()}
    # what only surroundings add to is emptied by them: forces of loads
    again = written(body, call, *here, written(body, call, *state(body, other)))
    wrong = np.flatnonzero(again != clean)
    return f"number {wrong[0]} of the block is left from the call before" if len(wrong) else ""
