"""The seam for engines: a second one, of a test, runs the same models with the same solutions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.testing.engine import check_engine
from tests.runs.own_engine import Midpoint
from tests.testing.caught import failures


def _tumbling() -> tuple[ns.System, Any]:
    box = BoxBody(0.1, 0.2, 0.3, mass=1.0)
    system = ns.System([box])
    system.place(box, position=(0.0, 0.0, 1.0), velocity=(0.1, 0.2, 3.0), angular_velocity=(3.0, 0.2, -1.0))
    return system, box


def test_an_engine_of_a_stranger_passes_the_kit() -> None:
    """By the same properties as the built-in one."""
    assert failures(check_engine(Midpoint())) == {}


def test_engines_agree_on_a_body_that_tumbles() -> None:
    """The midpoint rule with its order, against the event-driven engine."""
    system, _ = _tumbling()
    exact = ns.simulate(system, 0.5, engine=ns.EventDriven(tolerance=1e-12))
    errors = []
    for step in (2e-3, 1e-3):
        run = ns.simulate(system, 0.5, sample_interval=0.1, engine=Midpoint(step))
        assert (run.status, run.t_end, run.counters.steps) == ("done", 0.5, round(0.5 / step))
        errors.append(float(np.abs(run.u_end - exact.u_end).max()))
        # what it has stored is told, what lies between is asked of the event-driven engine only
        np.testing.assert_array_equal(run.at().u, run.u)
        with pytest.raises(ns.InvalidInput, match="is known between its samples only where"):
            run.at(0.05)
    assert errors[1] <= 1e-5
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_an_engine_refuses_what_it_cannot_run() -> None:
    """Before anything is laid out."""
    ball, plate = Ball(0.1), Plate()
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.1), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 1.0))
    with pytest.raises(ns.InvalidInput, match="Midpoint must have free bodies only"):
        ns.simulate(system, 1.0, engine=Midpoint())


@pytest.mark.parametrize("given", ["event_driven", ns.EventDriven])
def test_what_is_no_engine_is_refused(given: Any) -> None:
    """A name, and a class without its options."""
    with pytest.raises(ns.InvalidInput, match=r"must be of the kind Engine, .*Give nonsmooth\.EventDriven"):
        ns.assemble(_tumbling()[0], given)


def test_arrays_of_layers_that_an_engine_does_not_name_have_no_length() -> None:
    """Scratch has an owner: another engine's costs nothing."""
    system, _ = _tumbling()
    sizes = [
        sum(part.nbytes for part in ns.assemble(system, engine)._laid.memory.kept)
        for engine in (ns.EventDriven(), Midpoint())
    ]
    assert sizes[1] < 0.5 * sizes[0]
