"""Nothing that is given to a public function ends in an error without a name."""

from __future__ import annotations

import contextlib
import copy
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Fixed, Harmonic, Plate, Spring
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.histories.distances import distances

Given = Callable[[Any], object]
LAWS: Any = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.5)}
PLATE, BALL, OTHER = Plate(), Ball(0.02), Ball(0.02)


def _system() -> ns.System:
    system = ns.System([PLATE, BALL, OTHER])
    system.contact(PLATE, BALL, **LAWS)
    system.exclude(PLATE, OTHER)
    system.exclude(BALL, OTHER)
    system.place(BALL, position=(0.0, 0.0, 0.1))
    system.place(OTHER, position=(1.0, 0.0, 0.1))
    return system


SYSTEM = _system()
MODEL = ns.assemble(SYSTEM)
SOLUTION = MODEL.run(0.2)
MATERIALS = ns.Materials(default=ns.ContactLaws(**LAWS))
MATRICES: Any = {"mass": [[1.0]], "normal": [[1.0]], "tangential": np.zeros((1, 1, 2)), "friction": [Coulomb(0.1)]}
AT_REST: Any = MATRICES | {"force": [-1.0]}
MEETING: Any = MATRICES | {"velocity": [-1.0], "impact": [EnergeticImpact(0.5)]}


def _changed(call: Callable[..., object], given: dict[str, Any], name: str) -> Given:
    return lambda value: call(**given | {name: value})


NOTHINGS: tuple[Any, ...] = (None, 3, math.nan, 1j, "", "a", [1], {}, (), ns)
DOORS: dict[str, Given] = {
    "assemble": ns.assemble,
    "assemble: engine": lambda x: ns.assemble(SYSTEM, x),
    "simulate": lambda x: ns.simulate(x, 1.0),
    "simulate: t_end": lambda x: ns.simulate(SYSTEM, x),
    "run": MODEL.run,
    "run: sample_interval": lambda x: MODEL.run(0.1, sample_interval=x),
    "run: start": lambda x: MODEL.run(0.1, start=x),
    "run: until": lambda x: MODEL.run(0.1, until=x),
    "run: most_steps": lambda x: MODEL.run(0.1, most_steps=x),
    "run: progress": lambda x: MODEL.run(0.1, progress=x),
    "run: output": lambda x: MODEL.run(0.1, output=x),
    "with_laws_of": MODEL.with_laws_of,
    "with_laws": lambda x: ns.with_laws(x, friction=Coulomb(0.1)),
    "with_laws: friction": lambda x: ns.with_laws(SYSTEM, friction=x),
    "State.at": ns.State.at,
    "State.at: time": lambda x: ns.State.at(SYSTEM, x),
    "State.at: q": lambda x: ns.State.at(SYSTEM, q=x),
    "Output": ns.Output,
    "open_solution": ns.open_solution,
    "resume": ns.resume,
    "load_system": ns.load_system,
    "save_system": lambda x: ns.save_system(x, "x.toml"),
    "save_system: path": lambda x: ns.save_system(SYSTEM, x),
    "save_system: t_end": lambda x: ns.save_system(SYSTEM, "x.toml", t_end=x),
    "save_system: title": lambda x: ns.save_system(SYSTEM, "x.toml", title=x),
    "distance": lambda x: ns.distance(x, BALL),
    "distance: at": lambda x: ns.distance(BALL, OTHER, at=x),
    "distance: by": lambda x: ns.distance(BALL, OTHER, by=x),
    "proximity": ns.proximity,
    "proximity: within": lambda x: ns.proximity(SYSTEM, x),
    "touching": lambda x: ns.touching(x, BALL),
    "touching: body": lambda x: ns.touching(_system(), x),
    "touching: direction": lambda x: ns.touching(_system(), BALL, direction=x),
    "at_height: height": lambda x: ns.at_height(_system(), BALL, x),
    "resting": lambda x: ns.resting(x, BALL),
    "resting: body": lambda x: ns.resting(_system(), x),
    "restitution": lambda x: ns.restitution(x, 1.0),
    "restitution: speed": lambda x: ns.restitution(EnergeticImpact(0.5), x),
    "System": ns.System,
    "System: gravity": lambda x: ns.System([PLATE], x),
    "System.name": lambda x: ns.System([PLATE]).name(PLATE, x),
    "System.place": lambda x: _system().place(x),
    "System.joint: frames": lambda x: _system().joint(Fixed(), BALL, OTHER, frames=x),
    "System.load: frames": lambda x: _system().load(Spring(1.0, 1.0), BALL, OTHER, frames=x),
    "System.contact_all": lambda x: _system().contact_all(x),
    "System.contact_all: of": lambda x: _system().contact_all(MATERIALS, x),
    "System.contact_all: bodies": lambda x: _system().contact_all(MATERIALS, bodies=x),
    "System.contact_all: exclude": lambda x: _system().contact_all(MATERIALS, exclude=x),
    "System.contact_all: a pair": lambda x: _system().contact_all(MATERIALS, exclude=[x]),
    "Materials": ns.Materials,
    "ContactLaws": lambda x: ns.ContactLaws(x, x, x),
    "Solution.at": SOLUTION.at,
    "Solution.of": SOLUTION.of,
    "Solution.history": SOLUTION.history,
    "Solution.history: times": lambda x: SOLUTION.history("mode_word", times=x),
    "Solution.history: of": lambda x: SOLUTION.history("position", of=x),
    "distances": lambda x: distances(SOLUTION, x, BALL),
    **{f"solve_contact: {name}": _changed(ns.solve_contact, AT_REST, name) for name in AT_REST},
    "solve_contact: solver": lambda x: ns.solve_contact(**AT_REST, solver=x),
    **{f"solve_impact: {name}": _changed(ns.solve_impact, MEETING, name) for name in MEETING},
    "solve_impact: an impact law": lambda x: ns.solve_impact(**MEETING | {"impact": [x]}),
    "solve_impact: tolerance": lambda x: ns.solve_impact(**MEETING, tolerance=x),
}


@pytest.mark.fast_cases(47)
@pytest.mark.parametrize("door", DOORS)
def test_what_is_of_no_kind_is_refused_by_name(door: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Text, numbers and lists are of some kind somewhere, and else refused as well; an object is of none."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ns.InvalidInput) as caught:
        DOORS[door](object())
    assert all((caught.value.thing, caught.value.rule, caught.value.remedy))
    for value in NOTHINGS:
        with contextlib.suppress(ns.InvalidInput):
            DOORS[door](value)


@pytest.mark.parametrize(
    ("door", "value"),
    [
        ("assemble", None),
        ("run", "1"),
        ("run: start", SOLUTION),
        ("run: until", 3),
        ("run: until", lambda: True),
        ("run: until", lambda run: np.array([True, False])),
        ("run: most_steps", 0),
        ("run: most_steps", 2.5),
        ("run: output", 3),
        ("run: output", ""),
        ("run: output", "a\0b"),
        ("run: output", "a" * 300),
        ("run: sample_interval", "a"),
        ("Output", 3),
        ("Solution.of", Ball(0.02)),
        ("Solution.history: of", "ball 3"),
        ("Solution.history: of", 3),
        ("Solution.history: of", -1),
        ("Solution.history: times", [-1.0, 5.0]),
    ],
)
def test_what_looks_right_and_is_not_is_refused(
    door: str, value: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ns.InvalidInput):
        DOORS[door](value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("take", [pickle.dumps, copy.copy, copy.deepcopy])
def test_a_model_says_how_it_is_copied(take: Given) -> None:
    with pytest.raises(ns.InvalidInput, match=r"model\.copy\(\)"):
        take(MODEL)


@pytest.mark.parametrize("door", [ns.open_solution, ns.resume])
def test_a_folder_without_results_is_told_as_one(door: Given, tmp_path: Path) -> None:
    for folder in (tmp_path, tmp_path / "nowhere"):
        with pytest.raises(ns.InvalidInput, match="must be a folder of results, but it is 'not there'"):
            door(folder)


def test_parts_are_found_by_name_and_as_objects() -> None:
    """The same ones, everywhere."""
    times = [0.1, 0.15]
    for name, body in zip(SYSTEM.names.bodies, SYSTEM.bodies, strict=True):
        assert [one.tolist() for one in SOLUTION.of(name)] == [one.tolist() for one in SOLUTION.of(body)]
        places = [SOLUTION.history("position", times=times, of=one)["position"].tolist() for one in (name, body)]
        assert places[0] == places[1]
    falls = [0.08 - 0.5 * 9.81 * t**2 for t in times]
    assert distances(SOLUTION, "plate", "ball 2", times)["gap"] == pytest.approx(falls, rel=1e-12)
    (contact,) = SYSTEM.contacts
    others: tuple[Any, ...] = (contact, contact.name, 0, np.int64(0))
    for asked in others:
        assert SOLUTION.history("gap", times=times, of=asked).labels["contact"] == ("plate - ball 1",)


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("limit", ["largest step", "period"])
def test_a_run_of_more_steps_than_hours_hold_is_refused(limit: str) -> None:
    """Up to 1e10 of the largest steps are taken on; the bound is not reached by a run that comes to its end."""
    system, engine = _system(), ns.EventDriven(largest_step=1e-15)
    if limit == "period":
        plate, ball = Plate(Harmonic(1e-3, 1e30)), Ball(0.02)
        system, engine = ns.System([plate, ball]), ns.EventDriven()
        system.exclude(plate, ball)
        system.place(ball, position=(0.0, 0.0, 0.1))
    with pytest.raises(ns.InvalidInput, match="largest step must be at least"):
        ns.simulate(system, 0.1, engine=engine)
    near = ns.simulate(_system(), 1e-5, engine=ns.EventDriven(largest_step=1.1e-15), until=lambda run: run.time > 0.0)
    assert near.status == "done"


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
def test_numbers_too_large_for_a_mass_are_refused() -> None:
    with pytest.raises(ns.InvalidInput, match="mass and inertia must be finite"):
        Ball(1e200)


def test_a_run_that_runs_out_of_memory_ends_by_name_and_keeps_what_it_has() -> None:
    def progress(t: float, t_end: float) -> None:
        if t > 0.0:
            raise MemoryError("no room")

    with pytest.raises(ns.RunFailed, match=r"At t = .* s the memory ran out: no room\.") as caught:
        ns.simulate(_system(), 1e3, sample_interval=1.0, progress=progress)
    kept = caught.value.solution
    assert isinstance(kept, ns.Solution)
    assert kept.status == "failed"
    assert len(kept.events) > 0
