"""Properties of engines."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.runs.model import Model
from nonsmooth.simulate import assemble
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from nonsmooth.testing import engine_scenes as scenes
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.property import Broken, NotChecked, Property, properties
from nonsmooth.testing.puck import Puck, over_slab
from nonsmooth.testing.reference import Constant, Rigid, Spring

_END, _SAMPLES = 0.3, 6
_MANY_SAMPLES = 5000
"""More than the buffers of samples hold at once."""
_START = np.array([0.3, -0.2, 1.0, 2.0, -1.0, 0.5])
_EXACT = 1e-6
"""Relative error allowed of smooth motion, and of the account of an engine that promises no residual."""
_THROUGH = 0.1
"""Part of its way that a body may go on into another: an engine of fixed steps stops it at their ends."""
_HEAP_SAMPLES = 60


def check_engine(engine: Engine) -> list[Property]:
    """Return the properties of an engine.

    It runs free bodies, a body that falls on a slab, a ball that a driven plate throws, and a heap of ten balls.  Of
    systems that its ``check`` refuses, all but the slab are skipped.
    """
    look = _Look(engine)
    rows = [
        ("names", "`own`, `counts` and `settings` name what the workspace has, or is to have", look.names),
        ("free fall", "a free body moves as gravity has it", look.falls),
        ("samples", "the samples are at the times asked for, from the start to the end", look.samples),
        ("many samples", "no sample is lost where they fill the buffers many times", look.many_samples),
        ("energy", "the account of energy closes", look.energy),
        ("repeatable", "a second run of one model is the same to the last bit", look.repeats),
        ("contact", "a body does not fall through a slab, or `check` refuses it and names the engine", look.lands),
        ("modes", "a body that lies on a slab is closed, and one that lands has impulses", look.records),
        ("quaternion", "a box that tumbles keeps its angular momentum and the length of its quaternion", look.tumbles),
        ("driven plate", "a plate that swings throws a ball to the height of the closed form", look.throws),
        ("heap", "of ten balls on a plate the energy never rises, and none passes into another", look.heaps),
        ("continues", "a run that is stopped and goes on is the run that is not, to the last bit", look.continues),
    ]
    return properties(engine, [*component_rows(engine), *rows])


class _Look:
    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @cached_property
    def _system(self) -> System:
        puck = Puck()
        system = System([puck], scenes.GRAVITY)
        system.set_start(puck, np.zeros(3), _START)
        return system

    @cached_property
    def _model(self) -> Model:
        try:
            return assemble(self._system, self._engine)
        except InvalidInput as error:
            raise NotChecked(f"nothing can be laid out: {error}") from error

    @cached_property
    def _solution(self) -> Solution:
        return self._model.run(_END, sample_interval=_END / _SAMPLES)

    def names(self) -> None:
        """Lay out a system, which refuses others."""
        assemble(self._system, self._engine)

    def falls(self) -> None:
        """Compare with the parabola."""
        t, solution = self._solution.t, self._solution
        path = np.outer(t, _START[:3])
        path[:, 2] -= 0.5 * scenes.GRAVITY * t**2
        assert_allclose(solution.q, path, rtol=0.0, atol=_EXACT)
        assert_allclose(solution.u[:, 3:], np.broadcast_to(_START[3:], (len(t), 3)), rtol=0.0, atol=_EXACT)

    def samples(self) -> None:
        """Compare the times."""
        self._compare_times(self._solution, _SAMPLES)
        if self._solution.t_end != _END:
            raise Broken("the run must end there", "t_end", self._solution.t_end)

    def many_samples(self) -> None:
        """Compare the times of many."""
        self._compare_times(self._model.run(_END, sample_interval=_END / _MANY_SAMPLES), _MANY_SAMPLES)

    def energy(self) -> None:
        """Look at the residual."""
        self._check_account(self._solution)

    def repeats(self) -> None:
        """Run again."""
        self._compare(self._model.run(_END, sample_interval=_END / _SAMPLES))

    def lands(self) -> None:
        """Drop a body from a height, and look at the gap there and from then on."""
        height = 0.5 * scenes.GRAVITY * (0.5 * _END) ** 2
        system = _slab(height)
        if self._refusal(system):
            return
        _ = self._model
        lowest = float(assemble(system, self._engine).run(_END, sample_interval=_END / _SAMPLES).q[:, 2].min())
        if not lowest >= -_THROUGH * height:
            raise Broken(f"it must stay over the slab, but for {_THROUGH:g} of the way it fell", "gap", lowest)

    def records(self) -> None:
        """Let one body lie on a slab, and another one land there."""
        if not self._engine.records_contacts:
            raise NotChecked("the engine records no contacts")
        lying = self._run(_slab(0.0), _END, _SAMPLES).history("mode")["mode"][1:]
        if not np.all(lying):
            raise Broken("must be 1 (stick) or 2 (slide) at all samples after the first", "modes", lying.ravel())
        landed = self._run(_slab(0.5 * scenes.GRAVITY * (0.5 * _END) ** 2), _END, _SAMPLES)
        if not np.any(landed.history("normal_impulse")["normal_impulse"] > 0.0):
            raise Broken("one must be positive after a landing", "impulses", landed.events.listed_impulse[:, 0])

    def tumbles(self) -> None:
        """Compare angular momentum and length of the quaternion with those at the start."""
        solution = self._run(scenes.tumbling(), _END, _SAMPLES)
        momentum = scenes.momentum(solution)
        size = float(np.linalg.norm(momentum[0]))
        _check_size("change of angular momentum", np.linalg.norm(momentum - momentum[0], axis=1) / size, self._promised)
        long = np.linalg.norm(solution.of(solution.system.bodies[1])[0][:, 3:7], axis=1) - 1.0
        _check_size("length of the quaternion less 1", np.abs(long), self._promised)
        self._check_account(solution)

    def throws(self) -> None:
        """Compare the height at the end with that of the closed form."""
        solution = self._run(scenes.thrown(), _END, _SAMPLES)
        height = solution.of(solution.system.bodies[1])[0][-1, 2] - scenes.RADIUS
        exact = scenes.thrown_height(_END)
        if not abs(height - exact) <= _THROUGH * exact:
            raise Broken(f"must be {exact:.6g} m, but for {_THROUGH:g} of it", "height of the ball", float(height))
        self._check_account(solution)

    def heaps(self) -> None:
        """Look at energies and distances."""
        if PLAIN:
            raise NotChecked("a heap takes minutes in plain mode")
        solution = self._run(scenes.heap(), _END, _HEAP_SAMPLES)
        deep, energy = scenes.overlap(solution), scenes.energies(solution)
        if not deep <= _THROUGH * scenes.RADIUS:
            raise Broken(f"must be at most {_THROUGH * scenes.RADIUS:g} m", "deepest overlap", deep)
        _check_size("rise of the energy", (energy - np.minimum.accumulate(energy)) / energy[0], self._promised)
        self._check_account(solution)

    def continues(self) -> None:
        """Stop between two samples, and go on."""
        half = self._model.run(0.55 * _END)
        self._compare(self._model.run(_END, start=half.state))

    @property
    def _promised(self) -> float:
        """The residual that it promises, and as much of other quantities that motion keeps."""
        promised = self._engine.promised_residual
        return _EXACT if promised is None else promised

    def _refusal(self, system: System) -> str:
        """Return why the engine refuses a system, "" if it does not."""
        try:
            self._engine.check(system)
        except InvalidInput as refused:
            if type(self._engine).__name__ not in str(refused):
                raise Broken("the refusal must name the engine", "check", str(refused)) from None
            return str(refused)
        return ""

    def _run(self, system: System, t_end: float, n: int) -> Solution:
        """Run a system, unless the engine refuses it; the run must be a good one."""
        if refusal := self._refusal(system):
            raise NotChecked(f"the engine refuses the system: {refusal}")
        _ = self._model
        solution = assemble(system, self._engine).run(t_end, sample_interval=t_end / n)
        if solution.status != "done":
            raise Broken(f"the run must be done, but {solution.message}", "status", solution.status)
        return solution

    def _check_account(self, solution: Solution) -> None:
        """Compare the residual of the energy account with the promise."""
        _check_size("energy residual", np.array([solution.energy.residual]), self._promised)

    def _compare_times(self, solution: Solution, n: int) -> None:
        """Compare the times of so many samples after the first with those asked for."""
        if len(solution.t) != n + 1:
            raise Broken(f"must be {n + 1}", "number of samples", len(solution.t))
        assert_allclose(solution.t, np.linspace(0.0, _END, n + 1), rtol=0.0, atol=1e-12)

    def _compare(self, other: Solution) -> None:
        for name in ("q_end", "u_end"):
            one, two = getattr(self._solution, name), getattr(other, name)
            if not np.array_equal(one, two):
                raise Broken("must be the same", name, float(np.abs(one - two).max()))


def _slab(height: float) -> System:
    """Return a puck at a height over a slab."""
    return over_slab(Puck(), height, np.zeros(6), (Rigid(), Constant(), Spring()), gravity=scenes.GRAVITY)


def _check_size(what: str, values: NDArray[np.float64], most: float) -> None:
    """Raise Broken where one of some values is not at most so large."""
    worst = float(np.max(values))
    if not worst <= most:
        raise Broken(f"must be at most {most:g}", what, worst)
