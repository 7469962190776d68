"""The checks see what they are for, and nothing where nothing is: depths in closed form, and runs spoilt on purpose."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    BoxBody,
    CapsuleBody,
    ConeBody,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    Plate,
    SuperellipsoidBody,
)
from laws import Coulomb, EnergeticImpact, HuntCrossley, Unilateral
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from nonsmooth.solution.events import COLUMNS, Events
from nonsmooth.solution.recorded import Recorded
from tests.benchmarks.random_systems import convex, drops, generate
from tests.benchmarks.random_systems.campaign import _kept, table
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.checks import findings
from tests.benchmarks.random_systems.gaps import distance, overlaps
from tests.benchmarks.random_systems.minimise import minimise
from tests.benchmarks.random_systems.misbehaving import task
from tests.benchmarks.random_systems.pieces import pieces_of
from tests.benchmarks.random_systems.pool import spread
from tests.benchmarks.random_systems.run import Outcome, run

LAWS = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5))
# pairs along the third axis, and the distance of the origins at which they touch
PAIRS = [
    (Ball(0.01), Ball(0.02), 0.03),
    (BoxBody(0.02, 0.02, 0.01), BoxBody(0.01, 0.03, 0.005, rounding=0.001), 0.015),
    (CylinderBody(0.01, 0.02), CapsuleBody(0.005, 0.01), 0.035),
    (CylinderBody(0.01, 0.02, rounding=0.002), DiscBody(0.02), 0.02),
    (BoxBody(0.02, 0.02, 0.01), ConeBody(0.01, 0.02), 0.015),
    (EllipsoidBody(0.01, 0.02, 0.03), SuperellipsoidBody(0.01, 0.01, 0.02, 0.6, 0.7, rounding=0.001), 0.051),
    (EllipsoidBody(0.01, 0.02, 0.03), SuperellipsoidBody(0.01, 0.01, 0.02, 1.3, 1.4), 0.05),
]


def _rotation(seed: int) -> Vector:
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.asarray(axes * np.linalg.det(axes))


@pytest.mark.slow
@pytest.mark.parametrize(("one", "two", "reach"), PAIRS)
def test_depth_and_distance_along_the_axis_in_any_orientation(one: Body, two: Body, reach: float) -> None:
    for seed in range(3):
        turn = _rotation(seed)
        for gap in (-3e-4, -2e-6, 2e-6, 3e-4):
            places = [np.zeros((1, 3)), (turn @ [0.0, 0.0, reach + gap])[None]]
            poses = (places[0], turn[None]), (places[1], turn[None])
            depths = [found.depth for found in overlaps(one, two, poses)]
            if gap < 0.0:
                assert max(depths) == pytest.approx(-gap, abs=1e-9)
                assert distance(one, two, poses) == 0.0
            else:
                assert not [depth for depth in depths if depth > 0.0]
                assert distance(one, two, poses) == pytest.approx(gap, abs=1e-9)


@pytest.mark.parametrize("falling", [CylinderBody(0.005, 0.007), ConeBody(0.007, 0.02), DiscBody(0.006)])
def test_depth_of_a_rim_across_an_edge_whatever_the_lean(falling: Body) -> None:
    box, (piece,) = BoxBody(0.03, 0.02, 0.01), pieces_of(falling)
    for seed in range(40):
        # along a normal of the edge the rim's farthest point is the depth below it
        random, lean, turn = np.random.default_rng(seed), _rotation(seed), _rotation(seed + 100)
        angle, depth = random.uniform(0.3, 1.2), 10.0 ** -(4.0 + seed % 3)
        normal, point = np.array([0.0, np.sin(angle), np.cos(angle)]), np.empty(3)
        convex._core(piece.kind, piece.numbers, piece.corners, -lean.T @ normal, point)
        tangent = lean @ np.cross([0.0, 0.0, 1.0], point)
        if np.hypot(*tangent[1:]) < 0.3 * np.linalg.norm(tangent) or np.linalg.norm(tangent) == 0.0:
            # a rim next to parallel to the edge has a shorter way out, an apex another test
            continue
        edge = np.array([random.uniform(-0.01, 0.01), 0.02, 0.01])
        place = turn @ (edge - depth * normal - lean @ (piece.place + point))
        poses = (np.zeros((1, 3)), turn[None]), (place[None], (turn @ lean)[None])
        assert max(found.depth for found in overlaps(box, falling, poses)) == pytest.approx(depth, abs=1e-9)


def test_depth_below_a_plate_is_that_of_the_lowest_point() -> None:
    box, turn = BoxBody(0.01, 0.02, 0.03), _rotation(5)
    low = float(np.abs(turn[2]) @ [0.01, 0.02, 0.03])
    plate = np.zeros((1, 3)), np.eye(3)[None]
    for height in (low - 1e-5, low + 1e-5):
        found = overlaps(Plate(), box, (plate, (np.array([[0.3, 0.1, height]]), turn[None])))
        assert [round(o.depth, 12) for o in found] == ([1e-5] if height < low else [])


def _swinging() -> tuple[Case, ns.Solution]:
    """Return two balls on a joint that meet a third in the air: everything but a plate."""
    bodies = Ball(0.01), Ball(0.01), Ball(0.01)
    speeds = ((0.4, 0.0, 0.0), (0.4, 0.0, 0.0), (-0.5, 0.1, 0.0))
    places = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.03), (0.05, 0.0, 0.004))
    starts = tuple(Start("place", (("position", p), ("velocity", v))) for p, v in zip(places, speeds, strict=True))
    contacts = ((0, 2, LAWS), (1, 2, LAWS))
    case = Case(bodies, starts, contacts, ((0, 1, BallJoint((0.0, 0.0, 0.015), (0.0, 0.0, -0.015))),), 0.0, 0.1)
    return case, ns.simulate(case.build(), case.t_end, sample_interval=case.sample_interval)


def _shifted(array: Vector, rows: slice, column: int, change: float, factor: float = 1.0) -> Vector:
    changed = array.copy()
    changed[rows, column] = factor * changed[rows, column] + change
    return changed


def _spoilt(solution: ns.Solution, q: Any = None, u: Any = None, **at_end: Any) -> ns.Solution:
    """Return the solution with other samples, and another state at its end."""
    rows, n_q, n_u = solution.recorded.rows.copy(), len(solution.state.q), len(solution.state.u)
    rows[:, 1 : 1 + n_q] = solution.q if q is None else q
    rows[:, 1 + n_q : 1 + n_q + n_u] = solution.u if u is None else u
    names = {"u_end": "u", "energy": "energy"}
    state = dataclasses.replace(solution.state, **{names[name]: value for name, value in at_end.items()})
    end = dataclasses.replace(solution.end, state=state)
    return ns.Solution(solution.system, dataclasses.replace(solution.recorded, rows=rows), end)


def test_a_run_that_is_right_passes_and_one_that_is_spoilt_does_not() -> None:
    case, right = _swinging()
    assert right.counters.impacts > 0
    assert findings(case, right) == []

    def kinds(**changes: Any) -> set[str]:
        return {text.split(":")[0] for text in findings(case, _spoilt(right, **changes))}

    late = slice(len(right.t) // 2, None)
    assert kinds(q=_shifted(right.q, late, 0, 1e-4)) >= {"jump", "joint"}
    assert "quaternion" in kinds(q=_shifted(right.q, late, 3, 0.0, 1.0 + 1e-6))
    assert "turn-jump" in kinds(q=_shifted(right.q, late, 4, 1e-2))
    assert "inside" in kinds(q=_shifted(right.q, slice(None), 14, right.q[0, 0] - right.q[0, 14]))
    assert kinds(u=_shifted(right.u, late, 0, 1e-4)) >= {"momentum", "spin"}
    assert "energy-gained" in kinds(u=np.where(np.arange(len(right.t))[:, None] < late.start, 1.0, 1.01) * right.u)
    assert "energy-end" in kinds(u_end=1.001 * right.u_end)
    assert "energy" in kinds(energy=dataclasses.replace(right.energy, friction_loss=right.energy.friction_loss + 1e-8))
    assert kinds(q=_shifted(right.q, late, 0, math.nan)) == {"not-finite"}


def test_compliant_bodies_may_start_indented_but_must_feel_it() -> None:
    law = ns.ContactLaws(HuntCrossley(stiffness=1e6, dissipation=0.1), Coulomb(0.3), None)
    starts = tuple(Start("place", (("position", (x, 0.0, 0.0)),)) for x in (0.0, 0.019))
    case = Case((Ball(0.01), Ball(0.01)), starts, ((0, 1, law),), (), 0.0, 0.01)
    right = ns.simulate(case.build(), case.t_end, sample_interval=case.sample_interval)
    assert findings(case, right) == []
    unmoved = _spoilt(right, 0.0 * right.q + right.q[0], 0.0 * right.u)
    none = {name: getattr(right.events, name)[: int(name == "first")] for name in COLUMNS}
    still = Events.held(right.events.n_contacts, none)
    recorded = Recorded.of(still, unmoved.recorded.rows, unmoved.recorded.engine)
    found = findings(case, dataclasses.replace(unmoved, recorded=recorded))
    assert "unfelt" in {text.split(":")[0] for text in found}
    # deeper than all that the start holds
    deeper = _spoilt(right, _shifted(right.q, slice(len(right.t) // 2, None), 7, 0.005, 0.0))
    assert "inside" in {text.split(":")[0] for text in findings(case, deeper)}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
def test_a_system_of_a_number_is_always_the_same_and_all_kinds_occur() -> None:
    names: set[str] = set()
    for seed in range(120):
        case = generate.case_of(seed, "tumbling")
        names |= {type(body).__name__ for body in case.bodies} | {type(joint).__name__ for _, _, joint in case.joints}
        names |= {
            type(law).__name__ for _, _, laws in case.contacts for law in (laws.normal, laws.friction, laws.impact)
        }
        names |= {start.how for start in case.starts if start is not None}
    some = "Dumbbell Rod ConeBody DiscBody HullBody SuperellipsoidBody MeshBody DrivenBody Hinge Slider Fixed Distance"
    laws = "Cohesive HuntCrossley Bristle CoulombContensou Directional RateAndState StrongeImpact MoreauImpact touching"
    assert set(f"{some} {laws} BallJoint resting at_height".split()) <= names
    for module in (generate, drops):
        assert repr(module.case_of(7)) == repr(module.case_of(7))
        assert repr(module.case_of(7)) != repr(module.case_of(8))


def test_a_script_runs_alone_and_does_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    case, solution = _swinging()
    exec(compile(case.script("a case"), "script", "exec"), {})
    assert capsys.readouterr().out.strip() == f"done energy residual {solution.energy.residual}"


def test_minimise_leaves_what_is_at_fault() -> None:
    speed = (0.123456, 0.0, 0.0)
    places = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.03), (0.05, 0.0, 0.004), (0.05, 0.0, 0.01))
    starts = tuple(Start("place", (("position", place), ("velocity", speed))) for place in places)
    joint = (0, 1, BallJoint((0.0, 0.0, 0.015), (0.0, 0.0, -0.015)))
    spoilt = Case(tuple(Ball(0.01) for _ in range(4)), starts, ((0, 2, LAWS), (2, 3, LAWS)), (joint,), 0.0, 1e-3, 1e-3)
    outcome, noted = run(spoilt), list[Case]()
    assert outcome.end == "refused"
    assert "must not overlap" in outcome.cause
    smallest = minimise(spoilt, outcome, 20.0, noted.append)
    assert len(smallest.bodies) == 2
    assert len(smallest.contacts) == 1
    assert not smallest.joints
    assert noted[-1] == smallest
    assert run(smallest).kind == outcome.kind


def test_what_hangs_or_crashes_is_ended_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.benchmarks.random_systems.pool.LOADING", 30.0)
    tasks = [("one",), ("crash",), ("two",), ("hang",), ("three",)]
    ends = {name: (word, value) for (name,), word, value in spread(task, tasks, 1, 0.5)}
    expected = {name: ("back", name) for name in ("one", "two", "three")}
    assert ends == {**expected, "crash": ("crash", None), "hang": ("hang", None)}


def test_results_are_read_back_and_counted(tmp_path: Path) -> None:
    outcomes = {1: Outcome("done", found=("inside: by 1 mm",)), 2: Outcome("done"), 3: Outcome("failed", "no step", ())}
    path, families = tmp_path / "results.jsonl", {1: "stack", 2: "stack", 3: "heap"}
    rows = [json.dumps({"seed": seed, "family": families[seed], **o.row()}) for seed, o in outcomes.items()]
    path.write_text("\n".join(rows), encoding="utf-8")
    assert _kept(path) == outcomes
    lines = list(table(outcomes, families.__getitem__))
    assert "| stack | 2 | 0 | 2 | 0 | 0 | 0 | 0 | 0 | **1** | 0.00 |" in lines
    assert "| heap | 1 | 0 | 0 | 1 | 0 | 0 | 0 | 0 | **0** | 0.00 |" in lines
    assert "| stack | done, wrong in silence | inside | 1 | 1 |" in lines
    assert "| heap | failed | no step | 1 | 3 |" in lines
