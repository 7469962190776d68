"""Conformance checks of engines, by runs with known results."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from numpy.testing import assert_allclose

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.runs.model import Model
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution
from nonsmooth.system.materials import ContactLaws
from nonsmooth.system.system import System
from nonsmooth.testing import engine_scenes as scenes
from nonsmooth.testing.claims import Claims, rows
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.puck import Puck, over_slab
from nonsmooth.testing.reference import ReferenceContact, ReferenceFriction, ReferenceImpact
from nonsmooth.types import Array

_END, _SAMPLES = 0.3, 6
_MANY_SAMPLES = 5000
"""Number of samples that is larger than the buffers of samples."""
_START = np.array([0.3, -0.2, 1.0, 2.0, -1.0, 0.5])
_EXACT = 1e-6
"""Allowed error of free fall: position [m] and angular velocity [rad/s]. Also the allowed relative energy residual, if
the engine's ``promised_residual`` is None."""
_THROUGH = 0.1
"""Allowed overlap, relative to the height of a fall or to the radius of a ball. It is also the allowed relative error
of the height to which a plate throws a ball. It is large, because an engine with fixed steps finds contacts only at the
ends of steps."""
_HEAP_SAMPLES = 60
_HEIGHT = 0.5 * scenes.GRAVITY * (0.5 * _END) ** 2
"""Height of a fall that ends in the middle of the run [m]."""
_ENGINE = Claims()


def check_engine(engine: Engine) -> list[Property]:
    """Return the properties of an engine.

    It runs free bodies, a body that falls on a slab, a ball that a driven plate throws, and a heap of ten balls. If the
    engine's ``check`` refuses a system, the properties that need this system are not checked. There is one exception:
    the property "contact" then holds, because an engine may refuse contacts.
    """
    return properties(engine, _rows)


def _rows(engine: Engine) -> list[Row]:
    trial = _Trial(engine)
    return [*component_rows(engine), *rows(_ENGINE, lambda: [trial], 1)]


@final
@dataclass(frozen=True, eq=False)
class _Trial:
    """An engine and its run of a free body. The run is computed once, and several properties are checked with it."""

    engine: Engine

    @cached_property
    def system(self) -> System:
        """A free body."""
        puck = Puck()
        system = System([puck], scenes.GRAVITY)
        system.set_start(puck, puck.state()[0], _START)
        return system

    @cached_property
    def model(self) -> Model:
        """The model of the free body."""
        try:
            return assemble(self.system, self.engine)
        except InvalidInput as error:
            raise NotChecked(f"nothing can be laid out: {error}") from error

    @cached_property
    def solution(self) -> Solution:
        """The run of the free body."""
        return self.model.run(_END, sample_interval=_END / _SAMPLES)

    @property
    def promised(self) -> float:
        """Relative energy residual that the engine promises; other conserved quantities may change by the same part."""
        promised = self.engine.promised_residual
        return _EXACT if promised is None else promised

    def refusal(self, system: System) -> str:
        """Return the message with which the engine refuses a system; "" if it accepts the system."""
        try:
            self.engine.check(system)
        except InvalidInput as refused:
            if type(self.engine).__name__ not in str(refused):
                raise Broken("the refusal must name the engine", "check", str(refused)) from None
            return str(refused)
        return ""

    def run(self, system: System, n: int = _SAMPLES) -> Solution:
        """Return the run of a system. Raise NotChecked if the engine refuses it, Broken if the run is not "done"."""
        if refusal := self.refusal(system):
            raise NotChecked(f"the engine refuses the system: {refusal}")
        _ = self.model
        solution = assemble(system, self.engine).run(_END, sample_interval=_END / n)
        if solution.status != "done":
            raise Broken(f"the run must be done, but {solution.message}", "status", solution.status)
        return solution

    def require_account(self, solution: Solution) -> None:
        """Raise Broken if the energy residual of a run is larger than :attr:`promised`."""
        _require_at_most("energy residual", np.array([solution.energy.residual]), self.promised)

    def require_same(self, other: Solution) -> None:
        """Raise Broken unless another run of the free body ends with the same q and u, bit for bit."""
        for name in ("q_end", "u_end"):
            one, two = getattr(self.solution, name), getattr(other, name)
            if not np.array_equal(one, two):
                raise Broken("must be the same", name, float(np.abs(one - two).max()))


@_ENGINE.claim()
def _names(trial: _Trial) -> None:
    """The engine's `counts` and `settings` name existing numbers of the workspace, and its `own` only new numbers."""
    assemble(trial.system, trial.engine)


@_ENGINE.claim()
def _free_fall(trial: _Trial) -> None:
    """A free body falls on a parabola with constant angular velocity."""
    t, solution = trial.solution.t, trial.solution
    path = np.outer(t, _START[:3])
    path[:, 2] -= 0.5 * scenes.GRAVITY * t**2
    assert_allclose(solution.q[:, :3], path, rtol=0.0, atol=_EXACT)
    assert_allclose(solution.u[:, 3:], np.broadcast_to(_START[3:], (len(t), 3)), rtol=0.0, atol=_EXACT)


def _require_times(solution: Solution, n: int) -> None:
    """Raise Broken or AssertionError unless n samples follow the first one, at equal intervals of time."""
    if len(solution.t) != n + 1:
        raise Broken(f"must be {n + 1}", "number of samples", len(solution.t))
    assert_allclose(solution.t, np.linspace(0.0, _END, n + 1), rtol=0.0, atol=1e-12)


@_ENGINE.claim()
def _samples(trial: _Trial) -> None:
    """The samples are at the requested times, from the start to the end."""
    _require_times(trial.solution, _SAMPLES)
    if trial.solution.t_end != _END:
        raise Broken("the run must end there", "t_end", trial.solution.t_end)


@_ENGINE.claim()
def _many_samples(trial: _Trial) -> None:
    """No sample is lost if the samples fill the buffers many times."""
    _require_times(trial.model.run(_END, sample_interval=_END / _MANY_SAMPLES), _MANY_SAMPLES)


@_ENGINE.claim()
def _energy(trial: _Trial) -> None:
    """The energy residual of a run is at most the residual that the engine promises, or 1e-6 without a promise."""
    trial.require_account(trial.solution)


@_ENGINE.claim()
def _repeatable(trial: _Trial) -> None:
    """A second run of the same model has the same end to the last bit."""
    trial.require_same(trial.model.run(_END, sample_interval=_END / _SAMPLES))


@_ENGINE.claim()
def _contact(trial: _Trial) -> None:
    """A body does not fall through a slab, or `check` refuses it and names the engine."""
    system = _slab(_HEIGHT)
    if trial.refusal(system):
        return
    _ = trial.model
    lowest = float(assemble(system, trial.engine).run(_END, sample_interval=_END / _SAMPLES).q[:, 2].min())
    if not lowest >= -_THROUGH * _HEIGHT:
        raise Broken(f"it must stay over the slab, but for {_THROUGH:g} of the way it fell", "gap", lowest)


@_ENGINE.claim()
def _modes(trial: _Trial) -> None:
    """The contact of a body that lies on a slab is closed, and the contact of a body that falls on it has impulses."""
    if not trial.engine.records_contacts:
        raise NotChecked("the engine records no contacts")
    lying = trial.run(_slab(0.0)).history("mode")["mode"][1:]
    if not np.all(lying):
        raise Broken("must be 1 (stick) or 2 (slide) at all samples after the first", "modes", lying.ravel())
    landed = trial.run(_slab(_HEIGHT))
    if not np.any(landed.history("normal_impulse")["normal_impulse"] > 0.0):
        raise Broken("one must be positive after a landing", "impulses", landed.events.listed_impulse[:, 0])


@_ENGINE.claim()
def _quaternion(trial: _Trial) -> None:
    """A box that tumbles keeps its angular momentum and the length of its quaternion."""
    solution = trial.run(scenes.tumbling())
    momentum = scenes.momentum(solution)
    changes = np.linalg.norm(momentum - momentum[0], axis=1) / float(np.linalg.norm(momentum[0]))
    lengths = np.linalg.norm(solution.of(solution.system.bodies[1])[0][:, 3:7], axis=1)
    _require_at_most("change of angular momentum", changes, trial.promised)
    _require_at_most("length of the quaternion less 1", np.abs(lengths - 1.0), trial.promised)
    trial.require_account(solution)


@_ENGINE.claim()
def _driven_plate(trial: _Trial) -> None:
    """A plate that swings throws a ball as high as the solution in closed form."""
    solution = trial.run(scenes.thrown())
    height = solution.of(solution.system.bodies[1])[0][-1, 2] - scenes.RADIUS
    exact = scenes.thrown_height(_END)
    if not abs(height - exact) <= _THROUGH * exact:
        raise Broken(f"must be {exact:.6g} m, but for {_THROUGH:g} of it", "height of the ball", float(height))
    trial.require_account(solution)


@_ENGINE.claim()
def _heap(trial: _Trial) -> None:
    """In a heap of ten balls on a plate, the energy never rises, and no ball passes into another ball."""
    if PLAIN:
        raise NotChecked("a heap takes minutes in plain mode")
    solution = trial.run(scenes.heap(), _HEAP_SAMPLES)
    deep, energy = scenes.overlap(solution), scenes.energies(solution)
    if not deep <= _THROUGH * scenes.RADIUS:
        raise Broken(f"must be at most {_THROUGH * scenes.RADIUS:g} m", "deepest overlap", deep)
    rises = (energy - np.minimum.accumulate(energy)) / energy[0]
    _require_at_most("rise of the energy", rises, trial.promised)
    trial.require_account(solution)


@_ENGINE.claim()
def _continues(trial: _Trial) -> None:
    """A run that is stopped and resumed has the same end as a run without a stop, to the last bit."""
    half = trial.model.run(0.55 * _END)
    trial.require_same(trial.model.run(_END, start=half.state))


def _slab(height: float) -> System:
    """Return a puck at rest at a height over a slab [m]."""
    laws = ContactLaws(ReferenceContact(), ReferenceFriction(), ReferenceImpact())
    return over_slab(Puck(), height, np.zeros(6), laws, gravity=scenes.GRAVITY)


def _require_at_most(name: str, values: Array, most: float) -> None:
    """Raise Broken unless all values are at most ``most``."""
    worst = float(np.max(values))
    if not worst <= most:
        raise Broken(f"must be at most {most:g}", name, worst)
