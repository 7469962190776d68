"""A package of a stranger: installed by pip into an environment of its own, found, run, uninstalled, gone."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from nonsmooth import simulate
from scenarios.dumbbell import DumbbellScenario
from tests.environments import ROOT, Environment

SOURCE = ROOT / "tests" / "external_plugin"
_NAMES = ("rubber", "softening", "hollow_ball", "hollow_ball_on_slope", "lens")

_ROLL = """
t_end = 0.3

[bodies.floor]
type = "plate"

[bodies.ball]
type = "hollow_ball"
radius = 0.05
start = { place = "touching", velocity = [0.5, 0.0, 0.0] }

[[contacts]]
between = ["ball", "floor"]
normal = "unilateral"
friction = { type = "rubber", slow = 0.4, fast = 0.6 }
impact = "softening"
"""
_MEETS_ALL = """
from nonsmooth.bodies import (
    Box, Capsule, Cone, ConvexHull, Cylinder, Disc, Egg, Ellipsoid, HalfSpace, Plane, Sphere, Superellipsoid,
    TriangleMesh, Triangles,
)
from nonsmooth.system.pairing import installed_pair
from nonsmooth.testing.kinematics import check_contact_kinematics
from rubbery import Lens

sizes = 8e-3, 5e-3, 4e-3
vertices, triangles = Box(*sizes).drawing()
shapes = (
    Plane(), HalfSpace(), Sphere(5e-3), Box(*sizes), Box(*sizes, rounding=1e-3), ConvexHull(vertices.tolist()),
    TriangleMesh(Triangles(vertices, triangles)), Capsule(2e-3, 7e-3), Cylinder(6e-3, 8e-3), Cone(7e-3, 1.2e-2),
    Disc(8e-3), Ellipsoid(*sizes), Superellipsoid(*sizes, 1.3, 1.2), Superellipsoid(*sizes, 0.7, 0.8), Egg(), Lens(),
)
for shape in shapes:
    kinematics, is_in_order = installed_pair(Lens(), shape)
    pair = (Lens(), shape) if is_in_order else (shape, Lens())
    for row in check_contact_kinematics(kinematics, *pair, contacts=[0]):
        row.check()
print(len(shapes), "met")
"""


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Environment]:
    """Install the package into an environment; ask before and after what there is without it."""
    folder = tmp_path_factory.mktemp("external")
    made = Environment(folder / "environment")
    before, errors = made.nonsmooth("list", folder=folder)
    assert errors == ""
    assert not any(name in before.split() for name in _NAMES)
    shutil.copytree(SOURCE, folder / "source", ignore=shutil.ignore_patterns("__pycache__"))  # building writes there
    made.pip("install", "./source", folder=folder)
    yield made
    made.pip("uninstall", "--yes", "rubbery", folder=folder)
    assert made.nonsmooth("list", folder=folder) == (before, "")
    _, errors = made.nonsmooth("run", "hollow_ball_on_slope", folder=folder, status=2)
    assert "nknown " in errors


def _report(environment: Environment, folder: Path, *words: str) -> Any:
    return json.loads(environment.nonsmooth("run", *words, "--json", folder=folder)[0])


@pytest.mark.slow
def test_it_is_listed_with_its_source_and_shown_with_units(environment: Environment, tmp_path: Path) -> None:
    listed, errors = environment.nonsmooth("list", folder=tmp_path)
    assert errors == ""
    lines = [line.split() for line in listed.splitlines()]
    assert ["rubber", "friction", "rubbery", "0.3.0"] in [line[:4] for line in lines]
    assert ["softening", "impact", "rubbery", "0.3.0"] in [line[:4] for line in lines]
    for name in _NAMES[2:]:
        assert [name, "rubbery", "0.3.0"] in [line[:3] for line in lines]
    shown, _ = environment.nonsmooth("show", "rubber", folder=tmp_path)
    assert "growth_speed  0.1      m/s   > 0      speed of half the growth" in shown


@pytest.mark.slow
def test_it_passes_the_checks(environment: Environment, tmp_path: Path) -> None:
    # one process for all: each would load the engine
    code = "import sys; from nonsmooth.cli.main import main; print(*(main(['check', n]) for n in sys.argv[1:]))"
    checked, errors = environment.run([str(environment.python), "-c", code, *_NAMES], tmp_path)
    assert errors == ""
    assert checked.count(" 0 fail") == len(_NAMES)
    assert checked.splitlines()[-1] == "0 0 0 0 0"


@pytest.mark.slow
def test_its_lens_meets_every_shape(environment: Environment, tmp_path: Path) -> None:
    met, errors = environment.run([str(environment.python), "-c", _MEETS_ALL], tmp_path)
    assert errors == ""
    assert met == "16 met\n"


@pytest.mark.slow
def test_the_dumbbell_runs_with_its_laws_as_with_those_of_the_file(environment: Environment, tmp_path: Path) -> None:
    words = ("dumbbell", "--set", "t_end=0.3", "--law", "impact=softening,restitution=0.7")
    installed = _report(environment, tmp_path, *words, "--law", "friction=rubber,slow=0.3")
    file = SOURCE / "rubbery" / "friction.py"
    single = _report(environment, tmp_path, *words, "--law", f"friction={file}:Rubber,slow=0.3")
    assert installed["status"] == single["status"] == "done"
    assert installed["laws"]["friction"] == {"law": "Rubber", "slow": 0.3, "fast": 0.5, "growth_speed": 0.1}
    assert installed["final"] == single["final"]
    own = DumbbellScenario(t_end=0.3)
    assert installed["final"] != own.final(simulate(own.build(), own.t_end, sample_interval=own.sample_interval))
    assert abs(installed["energy_residual"]) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("slope", [0.4, 0.6])
def test_its_scenario_is_right_on_both_sides_of_the_threshold(
    environment: Environment, tmp_path: Path, slope: float
) -> None:
    friction = 0.2
    report = _report(environment, tmp_path, "hollow_ball_on_slope", "--set", f"slope={slope}")
    rolls = 0.4 * math.tan(slope) <= friction
    assert rolls == (slope < 0.5)
    expected = 0.6 * math.sin(slope) if rolls else math.sin(slope) - friction * math.cos(slope)
    assert report["summary"]["acceleration"] == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
def test_a_scenario_file_takes_its_body_and_laws(environment: Environment, tmp_path: Path) -> None:
    (tmp_path / "roll.toml").write_text(_ROLL)
    report = _report(environment, tmp_path, "roll.toml")
    # of a ball that stops slipping, 1 / (1 + J / (m r^2)) of the speed is left
    assert report["final"]["u"][0] == pytest.approx(0.5 * 0.6, rel=1e-6)
