"""The seam for engines: a second one, of a test, runs the same models with the same solutions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Engine
from nonsmooth.testing.engine import check_engine
from tests.runs.faulty_engines import FAULTS, Blind
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
        np.testing.assert_array_equal(run.at()["u"], run.u)
        with pytest.raises(ns.InvalidInput, match="is known between its samples only where"):
            run.at(0.05)
        with pytest.raises(ns.InvalidInput, match="is known between its samples only where"):
            run.history("kinetic_energy", times=0.05)
    assert errors[1] <= 1e-5
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_what_an_engine_stored_is_known() -> None:
    """States, poses, energies and, where no contact is closed, contact forces at the samples; modes at all times."""
    system, box = _tumbling()
    run, exact = (ns.simulate(system, 0.5, sample_interval=0.1, engine=e) for e in (Midpoint(), ns.EventDriven()))
    names = ("kinetic_energy", "potential_energy")
    energies, expected = run.history(*names), exact.history(*names)
    for name in names:
        np.testing.assert_allclose(energies[name], expected[name], rtol=1e-5)
    assert np.ptp(energies["kinetic_energy"]) > 1.0
    np.testing.assert_array_equal(run.history("position", of=box)["position"][:, 0], run.q[:, :3])
    assert run.history("normal_force")["normal_force"].shape == (6, 0)
    assert run.history("mode_word", times=0.05)["mode_word"] == "{,,}"


def _plate_and_ball() -> ns.System:
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.1))
    return system


def test_driven_bodies_are_evaluated_at_the_start_for_every_engine() -> None:
    """Whose settings say nothing of them."""
    model = ns.assemble(_plate_and_ball(), Blind())
    assert model._laid.gaps().tolist() == pytest.approx([0.08])


@pytest.mark.slow
def test_the_kit_finds_an_engine_that_knows_no_contacts() -> None:
    """It lets bodies fall through each other, and does not refuse them."""
    assert [*failures(check_engine(Blind()))] == ["contact", "driven plate", "heap"]


@pytest.mark.parametrize(("fault", "message"), FAULTS, ids=[fault.__name__ for fault, _ in FAULTS])
def test_an_engine_that_breaks_the_contract_is_refused(fault: type[Engine], message: str) -> None:
    """By its name, the rule, the value and the remedy."""
    with pytest.raises(ns.InvalidInput, match=f"^(Unknown )?{fault.__name__}.{message}"):
        ns.simulate(_tumbling()[0], 0.1, engine=fault())


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
