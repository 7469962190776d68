"""Flush systems: what is drawn, and that the checks tell faces in contact from faces that are inside of each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bodies import Ball, BoxBody, CylinderBody, DiscBody, HullBody, OpenBox, Plate
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.checks import DEPTH
from tests.benchmarks.random_systems.families import FLUSH
from tests.benchmarks.random_systems.families.aligned import UPRIGHT, about, shift, small_turn
from tests.benchmarks.random_systems.gaps import distance, overlaps
from tests.benchmarks.random_systems.generate import FAMILIES, case_of, family_of
from tests.benchmarks.random_systems.pieces import pieces_of, poses_of, rotations
from tests.benchmarks.random_systems.through import passed

CUBE = tuple((x, y, z) for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.01, 0.01))
EQUAL = {"boxes": BoxBody(0.01, 0.01, 0.01), "hulls": HullBody(CUBE), "cylinders": CylinderBody(0.01, 0.01)}
AXIS = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("body", EQUAL.values(), ids=EQUAL)
def test_flush_faces_are_inside_of_each_other_from_a_depth_on(body: Body) -> None:
    for moved in (0.0, 1e-9, 1e-5):
        for angle in (0.0, 1e-9, 1e-3):
            for depth in (0.0, 0.9 * DEPTH, 1.1 * DEPTH, 1e-3):
                turns = rotations(np.array([UPRIGHT, about(AXIS, angle)]))
                places = np.array([[0.0, 0.0, 0.0], [moved, -moved, 0.02 - depth]])
                poses = (places[:1], turns[:1]), (places[1:], turns[1:])
                deepest = max((found.depth for found in overlaps(body, body, poses)), default=0.0)
                assert (deepest > DEPTH) == (depth > DEPTH)


def test_a_body_is_inside_of_a_wall_of_an_open_box() -> None:
    box, ball, still = OpenBox(0.03, 0.02, position=(0.1, 0.0, 0.0)), Ball(0.01), np.eye(3)[None]
    for place, gap in (((0.08, 0.0, 0.5), 0.0), ((0.1, 0.01 + 1e-4, 0.5), -1e-4), ((0.12 - 1e-5, 0.0, 0.5), 1e-5)):
        poses = (np.array([[0.1, 0.0, 0.0]]), still), (np.array([place]), still)
        depths = [found.depth for found in overlaps(box, ball, poses) if found.depth > 1e-12]
        assert depths == pytest.approx([-gap] if gap < 0.0 else [], abs=1e-12)
        assert distance(box, ball, poses) == pytest.approx(max(gap, 0.0), abs=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-2])
def test_discs_that_pass_each_other_are_seen_and_those_that_meet_or_miss_are_not(angle: float) -> None:
    disc, n = DiscBody(0.01), 5
    (piece,) = pieces_of(disc)
    turns = np.tile(rotations(np.array([about(AXIS[[2, 0, 1]], angle)])), (n, 1, 1))

    def numbers(aside: float, heights: list[float]) -> list[int]:
        places = np.column_stack([np.full(n, aside), np.zeros(n), heights])
        return list(passed(piece, piece, ((np.zeros((n, 3)), np.tile(np.eye(3), (n, 1, 1))), (places, turns))))

    down = [2e-3, 1e-3, -1e-3, -2e-3, -3e-3]
    assert numbers(0.0, down) == numbers(1e-5, down) == numbers(0.009, down) == [2]
    assert numbers(0.0, down[::-1]) == [3]
    assert numbers(0.0, [2e-3, 1e-3, 0.0, 1e-3, 2e-3]) == numbers(0.0, [1e-3, 0.0, -1e-8, 0.0, 1e-3]) == []
    assert numbers(0.021, down) == []


def test_discs_that_miss_each_other_by_their_rims_are_not_seen() -> None:
    (piece,), still = pieces_of(DiscBody(0.01)), np.tile(np.eye(3), (2, 1, 1))

    def count(aside: float) -> int:
        places = np.array([[aside, 0.0, 1e-3], [aside, 0.0, -1e-3]])
        return len(passed(piece, piece, ((np.zeros((2, 3)), still), (places, still))))

    assert (count(0.0194), count(0.0196)) == (1, 0)
    (rounded,) = pieces_of(DiscBody(0.01, rounding=0.001))
    assert (
        len(passed(rounded, rounded, ((np.zeros((2, 3)), still), (np.array([[0, 0, 1.0], [0, 0, -1.0]]), still)))) == 0
    )


def test_one_of_three_numbers_is_flush_and_its_family_can_be_named() -> None:
    families = [family_of(seed) for seed in range(900)]
    assert families.count("tumbling") == 600
    assert set(families) == set(FAMILIES) == {"tumbling", *FLUSH}
    assert min(families.count(name) for name in FLUSH) > 10
    for seed in (2, 5, 6):
        assert repr(case_of(seed)) == repr(case_of(seed, families[seed]))
    assert repr(case_of(2, "stack")) != repr(case_of(2, "head_on"))


def test_shifts_and_angles_are_zero_or_spread_over_their_decades() -> None:
    random = np.random.default_rng(1)
    shifts = np.abs([shift(random, 2.0) for _ in range(500)]) / 2.0
    angles = np.array(
        [2.0 * math.asin(min(1.0, float(np.linalg.norm(small_turn(random, AXIS)[1:])))) for _ in range(500)]
    )
    for sizes, low, high in ((shifts, 1e-12, 1e-3), (angles, 1e-9, 1e-2)):
        some = sizes[sizes > 0.0]
        assert 0.3 < np.mean(sizes == 0.0) < 0.5
        assert low <= some.min() < 1e2 * low
        assert 0.1 * high < some.max() <= high


def _poses(case: Case) -> list[tuple[np.ndarray, np.ndarray]]:
    found = []
    for body, start in zip(case.bodies, case.starts, strict=True):
        words = dict(start.arguments) if start is not None else {}
        q = np.array([[*words["position"], *words["orientation"]]]) if words else np.zeros((1, 0))
        found.append(poses_of(body, np.zeros(1), q))
    return found


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("family", FLUSH)
def test_flush_bodies_start_next_to_each_other_and_not_inside(family: str) -> None:
    nearest = []
    for seed in range(3):
        case = case_of(seed, family)
        poses = _poses(case)
        gaps = []
        for i, j, _ in case.contacts:
            found = overlaps(case.bodies[i], case.bodies[j], (poses[i], poses[j]))
            assert max((one.depth for one in found), default=0.0) < 1e-9
            gaps.append(distance(case.bodies[i], case.bodies[j], (poses[i], poses[j])))
        size = max(shape.extent for shapes in case.bodies[-1].frames for shape in shapes)
        nearest.append(min(gaps) / size)
    assert max(nearest) < 2.5
    assert family == "head_on" or min(nearest) < 1e-6


def test_bodies_move_by_a_part_of_their_widths_between_two_samples() -> None:
    for seed in range(8):
        case = case_of(seed, "head_on")
        speed = sum(float(np.linalg.norm(dict(start.arguments)["velocity"])) for start in case.starts if start)
        extents = [shape.extent for body in case.bodies for shapes in body.frames for shape in shapes]
        assert speed * case.sample_interval < 0.21 * sum(extents)
        assert case.sample_interval < case.t_end


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize(
    ("family", "kind", "least", "most"),
    [
        ("head_on", Plate, 2, 2),
        ("fall", Plate, 2, 2),
        ("slide", Plate, 2, 3),
        ("at_rest", Plate, 2, 3),
        ("stack", Plate, 2, 6),
        ("heap", OpenBox, 5, 12),
    ],
)
def test_families_have_as_many_bodies_as_they_should(family: str, kind: type[Body], least: int, most: int) -> None:
    cases = [case_of(seed, family) for seed in range(8)]
    counts = {sum(not isinstance(body, kind) for body in case.bodies) for case in cases}
    assert counts <= set(range(least, most + 1))
    assert len(counts) >= min(2, most - least + 1)
