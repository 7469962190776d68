"""Gaps where a smooth body is flat or sharp, next to the end of a cap, a rim, an apex or a side; in any frame.

Most poses are wrong by round-off or not at all, so that each is looked at in many frames.
"""

from __future__ import annotations

import numpy as np
import pytest

from bodies import Capsule, Cone, Cylinder, Disc, Superellipsoid
from nonsmooth.engine.kernel import PLAIN
from nonsmooth.interfaces import ConvexShape
from nonsmooth.testing.rotations import rotation
from tests.benchmarks.gap_draws import Pose, directions
from tests.benchmarks.gap_poses import WAY, WRONG, Gaps, proved
from tests.benchmarks.outlines import outline_of

pytestmark = pytest.mark.skipif(PLAIN, reason="calls compiled functions by their addresses")

FRAMES = 60
POSES: dict[str, tuple[ConvexShape, ConvexShape, list[float], list[float]]] = {
    "a point farthest from the body": (
        Capsule(0.0025270732296618615, 0.01778856741208146),
        Superellipsoid(
            0.00638463626845639,
            0.0026789731641091957,
            0.01826515293250866,
            1.5926854918268627,
            0.8985815471496787,
            0.0014138600470278509,
        ),
        [-0.0003615547162419717, 0.008456627582704958, 0.009408713891578623],
        [-0.07234130194048062, 0.012101315661574245, -0.11302401339911676, 0.9908813584824228],
    ),
    "another point farthest from the body": (
        Capsule(0.0025270732296618615, 0.01778856741208146),
        Superellipsoid(
            0.00638463626845639,
            0.0026789731641091957,
            0.01826515293250866,
            1.5926854918268627,
            0.8985815471496787,
            0.0014138600470278509,
        ),
        [0.007475103816313967, 0.011283410568631143, 0.013811320677808187],
        [0.06234461868511033, 0.43919967430938045, 0.8102965720399685, 0.38293114256719657],
    ),
    "a pole before a side": (
        Cylinder(0.0036863435683508992, 0.012048581889852278, rounding=0.0),
        Superellipsoid(
            0.007495810356311795,
            0.00441530119235842,
            0.011247815914156939,
            1.32768152162592,
            0.22776557478118262,
            0.0010901029719757962,
        ),
        [-0.015175662875468439, -0.007088569849589224, -0.012048581889852276],
        [-0.16430980864675662, 0.6926624682681481, 0.142192492954715, 0.6877516170700483],
    ),
    "a flat line before a side": (
        Cylinder(0.009933414202633805, 0.009321976112462521, rounding=0.0),
        Superellipsoid(
            0.012270670002635367,
            0.019348686732633968,
            0.007206974120502477,
            0.5928747933797995,
            0.3365419679311608,
            0.0,
        ),
        [0.035647666251498, 9.286824518307812e-05, 2.818820640839402e-05],
        [0.7071067811865477, 0.0, 0.0, 0.7071067811865475],
    ),
    "a flat line over the end of a cap": (
        Cylinder(0.002403207251521988, 0.003721651663753433, rounding=0.0),
        Superellipsoid(
            0.005379929597535069,
            0.018888991747878548,
            0.00686380385054052,
            0.5073845647343258,
            0.21444785513054887,
            0.0,
        ),
        [-0.00625214614234309, 0.014046166751547896, -0.01730571860494679],
        [-0.6158406470439196, 0.01478085258057844, 0.7069522801413057, -0.34747704593041295],
    ),
    "a flat place over the end of a cap": (
        Disc(0.005482827481103317, rounding=0.003017315334346074),
        Superellipsoid(
            0.019001520965255324,
            0.017637990154890988,
            0.0029583294094700746,
            0.25721999037002485,
            0.31673622942399043,
            0.0,
        ),
        [-0.001835419370005988, 0.0028299930449231145, 0.02641396617140422],
        [0.5830714633200407, 0.05750311977239459, 0.7047647772246011, 0.40003458433218797],
    ),
    "a tip through a rim": (
        Cone(0.004272544589443058, 0.005672363071948804, rounding=0.0),
        Superellipsoid(
            0.010958764177111713,
            0.0020828862387308783,
            0.01261610207158476,
            1.5933407695487092,
            1.4390641947749971,
            0.0,
        ),
        [-0.01014629274030096, -0.010146291538313382, 0.007589819757308609],
        [-0.4238839064254982, 0.7989997091439275, -0.4030164130763906, 0.13964121688247663],
    ),
    "an apex through a ridge, beside it": (
        Cone(0.004842538263192171, 0.009803672512848208, rounding=0.0),
        Superellipsoid(
            0.015517758975618124, 0.002414372668605181, 0.011534761856120042, 0.9877351749681618, 1.553784698830591, 0.0
        ),
        [0.006162698012937118, 0.012183575715052616, 0.01717602184480506],
        [-0.5384846141541952, -0.10700533968644785, -0.2850308886349333, 0.7857108692908451],
    ),
    "an apex through a ridge": (
        Cone(0.002201490684026233, 0.006093826370733608, rounding=0.0),
        Superellipsoid(
            0.013143025084052731,
            0.004235236131448997,
            0.0023065268112508783,
            1.5477760262952254,
            0.6404032893409359,
            0.0,
        ),
        [-0.00492295952888423, -0.0014650865359322437, 0.01788960104266742],
        [-0.4281407813022772, 0.24252401323914602, 0.6666069088145146, 0.559922140577609],
    ),
    "a ridge that leaves an apex": (
        Cone(0.0021511205519965347, 0.02617828791261337, rounding=0.0),
        Superellipsoid(
            0.019272150875721858,
            0.0028460005802343202,
            0.014733565422151837,
            0.32549550415597334,
            1.5675474505052818,
            0.0,
        ),
        [-0.01364068579533488, -0.012865870893640123, 0.03513052016340178],
        [0.057936508996318754, -0.4497514565207776, 0.8647825016328635, -0.21568081312987678],
    ),
    "a pole that is nearly round": (
        Capsule(0.016281572669769494, 0.004741504382801757),
        Superellipsoid(
            0.0022298008021726327,
            0.008815067665611643,
            0.014231903380048901,
            0.9960427949611843,
            0.4387469520901173,
            0.0,
        ),
        [0.0014619479305251763, -0.04353092531554037, -0.004741504399666758],
        [-0.2828432184981317, 0.2609311170703503, 0.6572023675821608, 0.6480738491394631],
    ),
    "a pole that is nearly round, on the axis": (
        Capsule(0.016281572669769494, 0.004741504382801757),
        Superellipsoid(
            0.0022298008021726327,
            0.008815067665611643,
            0.014231903380048901,
            0.9960427949611843,
            0.4387469520901173,
            0.0,
        ),
        [-5.480173606575711e-13, 6.4878658001532585e-15, -0.0675911556646338],
        [0.9963657434658147, 6.772834358407878e-12, 2.0684284281808426e-11, 0.08517807962037155],
    ),
}
"""Both shapes, and the second one's place and quaternion in the frame of the first."""


def _frames(place: list[float], quaternion: list[float], rng: np.random.Generator) -> tuple[Pose, Pose]:
    """Return the same pose in frames anywhere, the first of which is that of the first body."""
    q = rng.normal(size=(FRAMES, 4))
    q[0] = [1.0, 0.0, 0.0, 0.0]
    turns = np.array([rotation(one / np.linalg.norm(one)) for one in q])
    origin = rng.uniform(-0.1, 0.1, (FRAMES, 3)) * (np.arange(FRAMES) > 0)[:, None]
    second = rotation(np.array(quaternion) / np.linalg.norm(quaternion))
    return (origin, turns), (origin + turns @ np.array(place), np.ascontiguousarray(turns @ second))


@pytest.mark.parametrize("name", POSES)
def test_the_gap_is_right_in_any_frame_and_does_not_jump(name: str) -> None:
    first, second, place, quaternion = POSES[name]
    rng = np.random.default_rng(0)
    one, two = _frames(place, quaternion, rng)
    gaps = Gaps(first, second)
    rows = gaps(one, two)
    assert np.all(np.isfinite(rows))
    found = proved(outline_of(first), outline_of(second), one, two, rows, rng)
    assert np.max(found.error) <= WRONG
    assert np.ptp(rows[:, 0]) <= WRONG
    aside = gaps(one, (two[0] + WAY * directions(rng, FRAMES), two[1]))
    assert np.max(np.abs(aside[:, 0] - rows[:, 0])) <= WAY + 1e-12
