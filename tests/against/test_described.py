"""Systems survive being written as data: the same components, the same starts, the same bits of a run."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Coordinate, DrivenBody, Harmonic, Plate, Rest, Sphere
from laws import Coulomb
from tests.benchmarks.described.cases import describe
from tests.benchmarks.described.components import component, data_of
from tests.benchmarks.described.running import observe
from tests.benchmarks.described.systems import build, contact_laws
from tests.benchmarks.described.vocabulary import KINDS, WORDS
from tests.benchmarks.random_systems.generate import case_of

pytestmark = pytest.mark.filterwarnings("ignore")
_DRAWS = 12


def _stored(description: Any) -> Any:
    return json.loads(json.dumps(description))


@pytest.mark.slow
def test_components_of_random_systems_come_back_as_they_were() -> None:
    for seed in range(_DRAWS):
        case = case_of(seed)
        description = _stored(describe(case))
        assert description == describe(case)
        assert repr(component(description["bodies"])) == repr(case.bodies)
        laws = contact_laws(description)
        contacts = [(one, other, laws[number]) for one, other, number in description["contacts"]]
        assert repr(contacts) == repr(list(case.contacts))
        assert repr([component(one) for _, _, one in description["joints"]]) == repr([one for *_, one in case.joints])
        starts = [start and (start.how, *start.arguments) for start in case.starts]
        again = [
            one and (one["how"], *((k, component(v)) for k, v in one.items() if k != "how"))
            for one in description["starts"]
        ]
        assert repr(again) == repr(starts)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("seed", [0, 5, 8])
def test_a_run_of_the_described_system_has_the_same_bits(seed: int) -> None:
    case = case_of(seed)
    solution = ns.simulate(case.build(), 0.01, sample_interval=1e-3)
    again = observe(_stored(describe(case)) | {"t_end": 0.01, "sample_interval": 1e-3}, 10.0)
    assert again.end == solution.status
    assert again.q.tobytes() == solution.q.tobytes()
    assert again.times.tobytes() == solution.events.time.tobytes()
    assert again.impulses.tobytes() == solution.events.listed_impulse.tobytes()


def test_floats_come_back_to_the_last_bit() -> None:
    for number in (0.1 + 0.2, -0.0, 5e-324, math.pi):
        body = component(_stored(data_of(Plate(Harmonic(1.0, 1.0, phase=number)))))
        assert np.float64(body.motion.phase).tobytes() == np.float64(number).tobytes()


def test_defaults_are_left_out_and_signs_of_zero_are_kept() -> None:
    assert data_of(Plate(Rest())) == {"kind": "body.plate", "motion": {"kind": "motion.rest"}}
    assert data_of(Coulomb(0.3)) == {"kind": "friction.coulomb", "friction": 0.3}
    held = data_of(DrivenBody(Rest(slope=-0.0), (Sphere(1.0),)))
    assert math.copysign(1.0, held["motion"]["slope"]) == -1.0


def test_a_word_names_one_class() -> None:
    assert len(WORDS) == len(KINDS)


def test_a_class_without_a_word_is_named() -> None:
    with pytest.raises(TypeError, match=r"Coordinate\(.* has no word"):
        data_of(Coordinate("angle", "rad"))


def test_all_bodies_touch_each_other_where_the_description_says_so() -> None:
    balls = [Ball(0.1), Ball(0.2)]
    laws = [
        {
            "normal": {"kind": "normal.unilateral"},
            "friction": data_of(Coulomb(0.3)),
            "impact": {"kind": "impact.plastic"},
        }
    ]
    places = [{"how": "place", "position": [0.0, 0.0, z]} for z in (0.0, 1.0)]
    description = {"gravity": 1.0, "bodies": data_of(balls), "starts": places, "laws": laws, "contact_all": 0}
    system = build(description)
    assert len(system.contacts) == 1
    assert [system.start(body)[0][2] for body in system.bodies] == [0.0, 1.0]
