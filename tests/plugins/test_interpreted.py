"""What cannot be compiled runs in Python: the same motion, one warning that says where, why and at which cost."""

from __future__ import annotations

import inspect
import math
import re
import signal
import types
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Coordinate, FunctionLoad, FunctionMotion, GeneralisedBody, Plate, Point, PointFrame, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.binding.compile import bind, evaluate
from nonsmooth.compiled import compiled
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.dumbbell import DumbbellScenario
from tests.plugins import failing_laws as dummies

NATIVE = pytest.mark.skipif(PLAIN, reason="nothing is compiled")
TABLE = dummies.TABLE


def _fresh(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a copy that nobody has seen, so that it makes a warning of its own."""
    copy = types.FunctionType(function.__code__, function.__globals__, function.__name__)
    copy.__qualname__ = function.__qualname__
    return copy


def _with_warnings(run: Callable[[], Any]) -> tuple[Any, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = run()
    assert all(issubclass(one.category, ns.RunsInPython) for one in caught)
    return result, [str(one.message) for one in caught]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("function", "line", "reason"),
    [
        (dummies.by_dictionary, 'return TABLE["static"] if', "'TABLE': Cannot determine Numba type of <class 'dict'>"),
        (dummies.by_library, "return (0.3, level", "Unknown attribute 'bisect'"),
        (dummies.by_import, "import cmath", "unsupported opcode (IMPORT_NAME)"),
    ],
)
def test_a_friction_law_in_python_moves_as_the_compiled_one(
    function: Callable[..., float], line: str, reason: str
) -> None:
    """Ball on a plate, from slip to rolling; twice, and one warning."""
    law = dummies.Friction(_fresh(function))
    one = dummies.sliding(dummies.Friction(dummies.falling))
    two, told = _with_warnings(lambda: dummies.sliding(law))
    again, nothing = _with_warnings(lambda: dummies.sliding(law))
    assert "slip to stick" in one.events.causes()
    np.testing.assert_allclose(two.q, one.q, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(two.u, one.u, rtol=0.0, atol=1e-13)
    assert again.u.tolist() == two.u.tolist()
    assert nothing == []
    if PLAIN:
        return
    (message,) = told
    number = function.__code__.co_firstlineno
    for word in ("Friction", function.__name__, f"failing_laws.py, line {number},", f"line {number + 2}, `{line}"):
        assert word in message
    assert reason in message
    took = re.search(r"A call takes (\d+\.\d) us", message)
    assert took is not None
    assert 0.0 < float(took[1]) < 1e4
    assert "\n" not in message


@NATIVE
def test_the_warning_points_at_the_function() -> None:
    with pytest.warns(ns.RunsInPython) as caught:
        dummies.sliding(dummies.Friction(_fresh(dummies.by_dictionary)), 0.01)
    assert (caught[0].filename, caught[0].lineno) == (dummies.__file__, dummies.by_dictionary.__code__.co_firstlineno)


def test_it_carries_the_dumbbell_as_the_built_in_does() -> None:
    """Drift of the dumbbell with Coulomb friction out of a dictionary."""
    system = DumbbellScenario(mode="drift").build()
    law = dummies.Friction(_fresh(_constant))
    one = ns.simulate(ns.with_laws(system, friction=Coulomb(0.2)), 0.2)
    two, told = _with_warnings(lambda: ns.simulate(ns.with_laws(system, friction=law), 0.2))
    assert one.counters.impacts > 10
    assert two.counters.steps == one.counters.steps
    np.testing.assert_allclose(two.u_end, one.u_end, rtol=0.0, atol=1e-13)
    assert len(told) == (0 if PLAIN else 1)


def _constant(speed: float, level: float) -> float:
    return TABLE["kinetic"] / 0.2 * level


@pytest.mark.slow
def test_impact_laws() -> None:
    """A process and a map, against their compiled twins."""
    for one, two in (
        (dummies.Process(), dummies.Process(share_of=_fresh(_half_in_python))),
        (dummies.Map(dummies.newton), dummies.Map(_fresh(dummies.newton_in_python))),
    ):
        expected = dummies.bouncing(one)
        found, told = _with_warnings(lambda law=two: dummies.bouncing(law))  # type: ignore[misc]
        assert expected.counters.impacts == found.counters.impacts > 5
        np.testing.assert_allclose(found.q, expected.q, rtol=0.0, atol=1e-12)
        assert len(told) == (0 if PLAIN else 1)


def _half_in_python(rate: float, level: float) -> float:
    return {False: 0.5, True: TABLE["static"] / 0.3}[rate <= 0.0]


def _push_back(indentation: float, rate: float, closing_rate: float, level: float) -> float:
    return max(0.0, 1e5 * level * indentation * (1.0 + 0.5 * rate)) * TABLE["static"] / 0.3


def _drag(normal_force: float, motion: Any, state: Any, out: Any, level: float) -> None:
    scale = TABLE["static"] / 0.3
    dummies.drag(normal_force, motion, state, out, scale * level)


def _settle(speed: float, state: Any, out: Any, level: float) -> None:
    out[0] = TABLE["static"] / 0.3 * 20.0 * (speed - state[0])


def _remembering(speed: float, level: float, state: Any) -> float:
    return float(TABLE["static"] / 0.3 * (level + 0.1 * state[0]))


@pytest.mark.slow
def test_compliant_laws_traction_and_states() -> None:
    """The other forms of contact laws, against their compiled twins."""
    compliance, drag = dummies.Compliance(_fresh(_push_back)), dummies.Traction(_fresh(_drag))
    states = dummies.Stateful(_fresh(_remembering), _fresh(_settle))
    for one, two, functions in (
        (dummies.pressed(), dummies.pressed, {"normal": compliance}),
        (dummies.pressed(friction=dummies.Traction()), dummies.pressed, {"friction": drag}),
        (dummies.sliding(dummies.Stateful()), dummies.sliding, {"friction": states}),
    ):
        found, told = _with_warnings(lambda two=two, functions=functions: two(**functions))  # type: ignore[misc]
        np.testing.assert_allclose(found.q, one.q, rtol=0.0, atol=1e-11)
        assert len(told) == (0 if PLAIN else len(functions) + (states in functions.values()))


def _mass(q: Any, out: Any, length: float) -> None:
    out[0] = length**2 / 3.0


def _force(t: float, q: Any, u: Any, out: Any, length: float, gravity_z: float) -> None:
    out[0] = 0.5 * length * gravity_z * math.sin(q[0])


def _potential(q: Any, length: float, gravity_z: float) -> float:
    return 0.5 * length * gravity_z * math.cos(q[0])


def _tip(q: Any, out: Any, length: float) -> None:
    out[0], out[2] = length * math.sin(q[0]), -length * math.cos(q[0])


def _tip_in_python(q: Any, out: Any, length: float) -> None:
    out[0], out[2] = [length * f(q[0]) * (TABLE["static"] / 0.3) for f in (math.sin, lambda x: -math.cos(x))]


def _tip_jacobian(q: Any, out: Any, length: float) -> None:
    out[0], out[2] = length * math.cos(q[0]), length * math.sin(q[0])


def _tip_bias(q: Any, u: Any, out: Any, length: float) -> None:
    out[0], out[2] = -length * math.sin(q[0]) * u[0] ** 2, length * math.cos(q[0]) * u[0] ** 2


def _pendulum(tip: Callable[..., None]) -> ns.Solution:
    pendulum = GeneralisedBody(
        coordinates=(Coordinate("angle", "rad", start=1.2),),
        mass=_mass,
        force=_force,
        potential=_potential,
        moving_frames=(PointFrame(tip, _tip_jacobian, _tip_bias, carried=(Point(),)),),
        constants={"length": 0.5},
    )
    floor = Plate(Rest(position=(0.0, 0.0, -0.45)))
    system = ns.System([pendulum, floor])
    system.contact(pendulum, floor, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    return ns.simulate(system, 0.5)


@pytest.mark.slow
def test_a_body_with_one_function_in_python() -> None:
    """All of the body runs in Python then, its helpers and their pointers, too; the line named is that of the one."""
    one = _pendulum(_tip)
    two, told = _with_warnings(lambda: _pendulum(_fresh(_tip_in_python)))
    assert one.counters.impacts > 0
    np.testing.assert_allclose(two.q, one.q, rtol=0.0, atol=1e-11)
    if not PLAIN:
        assert any(f"line {_tip_in_python.__code__.co_firstlineno + 1}" in message for message in told)


def _push(t: float, a: Any, b: Any, out: Any, strength: float) -> None:
    for i in range(9):
        out[i] = 0.0
    out[2] = strength * math.sin(40.0 * t)


def _push_in_python(t: float, a: Any, b: Any, out: Any, strength: float) -> None:
    for i, x in enumerate((0.0, 0.0, strength * math.sin(40.0 * t) * TABLE["static"] / 0.3)):
        out[i], out[i + 3], out[i + 6] = x, 0.0, 0.0


def _lift(t: float) -> Any:
    return 0.0, 0.0, 1e-3 * math.sin(30.0 * t)


def _lift_in_python(t: float) -> Any:
    return 0.0, 0.0, 1e-3 * math.sin(30.0 * t) * TABLE["static"] / 0.3


def _lift_rate(t: float) -> Any:
    return 0.0, 0.0, 0.03 * math.cos(30.0 * t)


def _lift_bias(t: float) -> Any:
    return 0.0, 0.0, -0.9 * math.sin(30.0 * t)


def _carried(lift: Callable[[float], Any], push: Callable[..., None]) -> ns.Solution:
    plate = Plate(FunctionMotion(lift, _lift_rate, _lift_bias, duration=0.2, shortest_change=0.2))
    ball = Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.011))
    system.load(FunctionLoad(push, {"strength": 0.01}), plate, ball)
    return ns.simulate(system, 0.2)


@pytest.mark.slow
def test_a_motion_and_a_load_in_python() -> None:
    """One warning each."""
    one = _carried(_lift, _push)
    two, told = _with_warnings(lambda: _carried(_fresh(_lift_in_python), _fresh(_push_in_python)))
    assert one.counters.impacts > 3
    np.testing.assert_allclose(two.q, one.q, rtol=0.0, atol=1e-11)
    if not PLAIN:
        assert sum("_push_in_python" in message for message in told) == 1
        assert sum(f"line {_lift_in_python.__code__.co_firstlineno + 1}," in message for message in told) == 1
        assert len(told) == 2


@compiled
def _helper(speed: float) -> float:
    return TABLE["static"] * speed


def _by_helper(speed: float) -> float:
    return float(_helper(speed))


@NATIVE
def test_a_compiled_helper_that_cannot_be_compiled_is_the_one_named() -> None:
    with pytest.warns(ns.RunsInPython) as caught:
        address, heap = bind(_by_helper, "scalar", {}, "Law")
    assert evaluate(address, heap, 2.0) == 0.6
    assert f"line {inspect.unwrap(_helper).__code__.co_firstlineno + 2}, `return TABLE" in str(caught[0].message)


@NATIVE
def test_a_warning_made_an_error_stops_before_the_run() -> None:
    warnings.simplefilter("error")
    with pytest.raises(ns.RunsInPython):
        dummies.sliding(dummies.Friction(_fresh(dummies.by_dictionary)))


CALLS: list[float] = []


def _interrupting(speed: float, level: float) -> float:
    CALLS.append(speed)
    if len(CALLS) == 300:
        signal.raise_signal(signal.SIGINT)
    return level


def _stubborn(speed: float, level: float) -> float:
    CALLS.append(speed)
    if len(CALLS) >= 300:
        signal.raise_signal(signal.SIGINT)
    return level


@pytest.fixture
def _ctrl_c() -> Iterator[None]:
    """Python's own handler: a process in the background of a script is started with Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@NATIVE
@pytest.mark.usefixtures("_ctrl_c")
@pytest.mark.parametrize("function", [_interrupting, _stubborn])
def test_ctrl_c_in_python_is_an_interrupted_run(function: Callable[..., float]) -> None:
    """Once: the step is finished.  Again in the same call: it is given up.  What was computed is kept."""
    CALLS.clear()
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    law = dummies.Friction(_fresh(function))
    system.contact(plate, ball, normal=Unilateral(), friction=law, impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.01), velocity=(50.0, 0.0, 0.0))
    solution, _ = _with_warnings(lambda: ns.simulate(system, 1e3))
    assert solution.status == "interrupted"
    assert solution.message == "the run was interrupted"
    assert 0.0 < solution.t_end < 1e3
    assert np.all(np.isfinite(solution.u_end))
