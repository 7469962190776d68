"""Closings, which end accumulations of bounces: what holds at each of them, in groups of contacts at random."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, CapsuleBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import PAST_END
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.engine.native.kernel import PLAIN, call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.model.assembly import assemble

pytestmark = pytest.mark.skipif(PLAIN, reason="compiled runs take seconds, plain ones minutes")

_GAP, _RATE = 1e-12, 3e-8
"""What counts as touching [m], the gap tolerance, and as approaching [m/s], a little more than that of velocities."""


def _laws(random: Any) -> dict[str, Any]:
    friction, restitution = Coulomb(float(random.uniform(0.0, 0.6))), EnergeticImpact(float(random.uniform(0.1, 0.6)))
    return {"normal": Unilateral(), "friction": friction, "impact": restitution}


def _groove(random: Any, *bodies: Any) -> ns.System:
    """Return bodies that may touch each other and two plates that make a groove."""
    slope, laws = float(random.uniform(0.2, 1.0)), _laws(random)
    plates = Plate(Rest(slope=slope)), Plate(Rest(slope=-slope))
    system = ns.System([*plates, *bodies])
    for i, body in enumerate(bodies):
        for other in (*plates, *bodies[:i]):
            system.contact(other, body, **laws)
    return system


def _balls(random: Any) -> ns.System:
    balls = [Ball(float(radius), 2700.0) for radius in random.uniform(0.005, 0.02, 2)]
    system = _groove(random, *balls)
    for i, ball in enumerate(balls):
        x, y = (float(part) for part in random.uniform(-0.005, 0.005, 2))
        system.place(ball, position=(x, y, 0.04 + 0.05 * i))
    return system


def _turn(random: Any, lean: float) -> Any:
    turn = np.array([1.0, *(lean * random.normal(size=3))])
    return turn / np.linalg.norm(turn)


def _capsule(random: Any) -> ns.System:
    capsule = CapsuleBody(0.005, 0.03, 2700.0)
    system = _groove(random, capsule)
    system.place(capsule, position=(0.0, 0.0, 0.1), orientation=tuple(_turn(random, 1.0)))
    return system


def _box(random: Any) -> ns.System:
    x, y, z = (float(side) for side in random.uniform(0.01, 0.03, 3))
    box, plate = BoxBody(x, y, z, 2700.0), Plate(Rest())
    system = ns.System([plate, box])
    system.contact(plate, box, **_laws(random))
    system.place(box, position=(0.0, 0.0, 0.04), orientation=tuple(_turn(random, 0.1)))
    return system


KINDS = {"balls": (_balls, 0.6), "capsule": (_capsule, 0.5), "box": (_box, 0.5)}


@pytest.mark.parametrize("kind", KINDS)
def test_closings_bring_to_rest_lose_energy_and_push_nothing_into_anything(kind: str) -> None:
    """What closes is at rest then, no contact that touches approaches, and each closing takes kinetic energy."""
    build, t_end = KINDS[kind]
    closings = 0
    for seed in (1, 2, 3, 5):
        system = build(np.random.default_rng(seed))
        solution = ns.simulate(system, t_end, sample_interval=t_end)
        assert solution.status == "done"
        events, model = solution.events, assemble(system, EventDriven())
        n = len(system.contacts)
        for e in np.flatnonzero(events.cause == CAUSES.index("closing of an accumulation")):
            closings += 1
            y = model.memory[owners.Island.y][: model.n_y]
            kinetic = []
            for u in (events.u_before[e], events.u_after[e]):
                y[: model.n_q], y[model.n_q : model.n_q + model.n_u] = events.q[e], u
                kinetic.append(model.energy()[0])
            scale = max(kinetic[0], 1e-16)
            assert kinetic[1] <= kinetic[0] + 1e-9 * scale
            assert kinetic[0] - kinetic[1] == pytest.approx(events.closing_loss[e], abs=1e-6 * scale)
            call_entry("evaluate_at", model.memory)
            geometry = model.memory[owners.ContactRecord.geometry][:n]
            rates = model.memory[owners.ContactRecord.rate][:n][:, 0]
            # past the end of its features a gap has no rate
            touching = (np.abs(geometry[:, 0]) < _GAP) & (geometry[:, PAST_END] <= 0.0)
            assert np.all(rates[touching] > -_RATE)
            assert abs(rates[events.contact[e]]) < _RATE
    assert closings > 10
