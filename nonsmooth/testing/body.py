"""Properties of bodies that have coordinates, and of driven bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import UNITS_OF_Q, UNITS_OF_U
from nonsmooth.testing.body_block import State, offered, places_of, plain, state_at, state_of
from nonsmooth.testing.body_motion import DRIVEN, FLIGHT, free_claims
from nonsmooth.testing.claims import GIVEN, claim, rows
from nonsmooth.testing.functions import CheckedFunction, all_rows, left_over, place_of_function
from nonsmooth.testing.inputs import draws
from nonsmooth.testing.outcome import Broken, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.shape import require_look

_DRAWS = 12
_UNKNOWN = "no_such_word"


def check_body(body: Body) -> list[Property]:
    """Return the properties of a body.

    Parameters
    ----------
    body : Body
        The body; it is checked around its start.
    """
    return properties(body, _rows)


def _rows(body: Body) -> list[Row]:
    claims = [_start, _writes_its_block, _sketch, *DRIVEN]
    if body.n_u > 0:
        claims += free_claims(body)
    if body.flight is not None:
        claims.append(FLIGHT)
    functions = [name for name in ("evaluator", "flight") if getattr(body, name)]
    found = rows(claims, lambda: [body], _DRAWS, [state_of(body)])
    return all_rows(body, lambda: [_function(body, name) for name in functions], found)


def _function(body: Body, name: str) -> CheckedFunction:
    size = places_of(body).size if name == "evaluator" else body.n_q + body.n_u
    inputs = [(f"t = {case['t']:.3g}", state_at(body, case)) for case in draws([state_of(body)], 6)]
    return CheckedFunction(body, name, "body", offered(body), inputs, size)


@claim()
def _start(body: Body) -> None:
    """The start has the sizes that the body names, each number a unit, and unknown words are refused."""
    q, u = body.state()
    for name, once, again in zip(("q", "u"), (q, u), body.state(), strict=True):
        if not np.array_equal(once, again):
            both = f"{np.asarray(once).tolist()} and {np.asarray(again).tolist()}"
            place = place_of_function(type(body).state)
            raise Broken(f"`state` gives another start each time: {place}", name, both)
    sizes, scales, labels = (body.n_q, body.n_u), body.scales, (body.q_labels, body.u_labels)
    for name, given, size in zip(("q", "u"), (q, u), sizes, strict=True):
        if np.shape(given) != (size,) or not np.all(np.isfinite(given)):
            raise Broken(f"`state` must give {size} finite numbers", name, given)
    for name, scale, size in zip(("q", "u"), scales, sizes, strict=True):
        if np.shape(scale) != (size,) or not np.all(np.isfinite(scale)) or not np.all(np.asarray(scale) > 0.0):
            raise Broken(f"`scales` must give {size} positive numbers", name, scale)
    for name, named, units in zip(("q_labels", "u_labels"), labels, (UNITS_OF_Q, UNITS_OF_U), strict=True):
        wrong = [label for label in named if not label[0] or label[1] not in units]
        if wrong or len(dict(named)) < len(named):
            raise Broken(f"`{name}` must give each number a name of its own and a unit of {units}", name, named)
    if body.quaternion >= 0 and abs(float(np.linalg.norm(q[body.quaternion : body.quaternion + 4])) - 1.0) > 1e-12:
        raise Broken("the quaternion has no unit length", "quaternion", q.tolist())
    if not body.time_scale > 0.0:
        raise Broken("it must be positive", "time_scale", body.time_scale)
    try:
        body.state(**{_UNKNOWN: 0.0})
    except InvalidInput:
        return
    raise Broken("`state` takes words that it does not know", _UNKNOWN, 0.0)


@claim(GIVEN)
def _writes_its_block(body: Body, at: State) -> str:
    """It writes every number that can be non-zero, whatever stood there, and nothing beyond the block."""
    call, (t, q, u), (start, rest) = plain(body), at, body.state()
    # another state, on the other side of the start
    before = 1.0 - t, start - 0.9 * (q - start) + 0.1, rest - 0.9 * (u - rest) + 0.1
    return left_over(lambda out: call(*at, out), lambda out: call(*before, out), places_of(body).size)


@claim()
def _sketch(body: Body) -> None:
    """What is seen of it besides its shapes can be drawn."""
    sketch = body.sketch
    if not isinstance(sketch, Sequence) or len(sketch) > len(body.frames):
        raise Broken(f"it must be a look for each of {len(body.frames)} frames at most", "sketch", sketch)
    for look in sketch:
        require_look("sketch", look)
    q = body.state()[0]
    shape = np.shape(body.strokes(q))
    if len(shape) != 3 or shape[1:] != (2, 3) or np.shape(body.strokes(q + 0.01)) != shape:
        raise Broken("it must give the ends of the same number of lines at all q, shape [n, 2, 3]", "strokes", shape)
    if not np.all(np.isfinite(body.strokes(q))):
        raise Broken("ends of lines must be finite [m]", "strokes", body.strokes(q))
