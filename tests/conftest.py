"""Systems that many tests start from, and how the tests run.

They run on all processors, spread by pytest-xdist (``-n auto`` in pyproject.toml; ``-n 0`` is one process, for
``--pdb`` and for a few tests): each worker has a stretch of them, in order, and takes from the stretch of another when
its own is done, so that what neighbours share, a module's fixtures or a full run of a scenario, is mostly made once.
The process that spreads them compiles the engine before its workers start, which then find it in the cache.  The
workers must collect the same tests under the same names: a name without an address in memory is asked of every test.

``pytest`` runs the fast tier, ``pytest -m slow`` the other one (tests/README.md).
"""

from __future__ import annotations

import math
import re
import signal
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from numpy.typing import NDArray
from xdist import is_xdist_worker

import nonsmooth as ns
from bodies import Dumbbell, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.solution.modes import mode_shares
from tests import tiers
from tests.processor_time import ProcessorTimes

settings.register_profile("tests", deadline=None, derandomize=True, print_blob=False)
settings.load_profile("tests")

GRAVITY = 9.81
_ADDRESS = re.compile(r"\b0x[0-9a-f]{6,}")


def pytest_configure(config: pytest.Config) -> None:
    """Measure the tests, and choose their tier."""
    config.pluginmanager.register(ProcessorTimes())
    tiers.choose(config)


def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile the engine once, before the workers of pytest-xdist start and before the time of any test runs."""
    if not is_xdist_worker(session):
        entry_addresses()
    # under nohup and in the background of a script Ctrl-C is ignored, by the processes that tests start, too
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort cases into tiers, and refuse names of tests that are other ones in the next process."""
    tiers.mark_cases(items)
    for item in items:
        if _ADDRESS.search(item.name):
            raise pytest.UsageError(f"{item.nodeid}: its name has an address; give the parameters ids")


def pytest_runtest_teardown() -> None:
    """Close what a test drew with pyplot, which keeps it and, after twenty, warns in whichever test comes next."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    # a test may have put None there, so that it cannot be imported
    if pyplot is not None:
        pyplot.close("all")


class Builders:
    """Functions that put bodies on plates; all lengths in [m], angles in [rad]."""

    def laws(
        self, restitution: float = 0.5, friction: float = 0.2, static: float | None = None, **impact: Any
    ) -> dict[str, Any]:
        """Return the three laws of a contact; friction 0 is Frictionless."""
        return {
            "normal": Unilateral(),
            "friction": Frictionless() if friction == 0.0 else Coulomb(friction, static),
            "impact": EnergeticImpact(restitution, **impact),
        }

    def over(self, body: Any, motion: Any = None, gravity: float = GRAVITY, **laws: Any) -> ns.System:
        """Return a system of a plate and a body in contact with it."""
        plate = Plate(motion if motion is not None else Rest())
        system = ns.System([plate, body], gravity)
        system.contact(plate, body, **self.laws(**laws))
        return system

    def lived(self, solution: ns.Solution) -> list[str]:
        """Return the mode words that took time, the longest first."""
        return [word for word, share in mode_shares(solution).items() if share > 0.0]

    def axes(self, theta: float, beta: float, gamma: float) -> NDArray[np.float64]:
        """Return the rotation matrix of Eq. (2), body axes as columns."""
        from scipy.spatial.transform import Rotation

        return np.asarray(Rotation.from_euler("ZYX", [math.pi / 2 + theta, -beta, gamma]).as_matrix())

    def quaternion(self, theta: float, beta: float, gamma: float) -> NDArray[np.float64]:
        """Return the unit quaternion of Eq. (2), scalar first."""
        from scipy.spatial.transform import Rotation

        x, y, z, s = Rotation.from_euler("ZYX", [math.pi / 2 + theta, -beta, gamma]).as_quat()
        return np.array([s, x, y, z])

    def paper_start(self, dumbbell: Dumbbell, q: Any, rate: Any) -> Mapping[str, Any]:
        """Return the start of a dumbbell at (x1, y1, z1, theta, beta, gamma) and its rate."""
        x1, v1 = np.asarray(q[:3], dtype=float), np.asarray(rate[:3], dtype=float)
        theta, beta, gamma = q[3:]
        axes = self.axes(theta, beta, gamma)
        second = np.array([-math.cos(theta), -math.sin(theta), 0.0])
        omega = rate[3] * np.array([0.0, 0.0, 1.0]) - rate[4] * second + rate[5] * axes[:, 0]
        arm = 0.5 * dumbbell.centre_distance * axes[:, 0]
        return {
            "position": x1 + arm,
            "orientation": self.quaternion(theta, beta, gamma),
            "velocity": v1 + np.cross(omega, arm),
            "angular_velocity": axes.T @ omega,
        }


@pytest.fixture(scope="session")
def build() -> Builders:
    """Return the builders."""
    return Builders()
