"""Properties of engines."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.testing import assert_allclose

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.runs.model import Model
from nonsmooth.simulate import assemble
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.property import Broken, NotChecked, Property, properties
from nonsmooth.testing.puck import Puck, over_slab
from nonsmooth.testing.reference import Constant, Rigid, Spring

_GRAVITY, _END, _SAMPLES = 9.81, 0.3, 6
_MANY_SAMPLES = 5000
"""More than the buffers of samples hold at once."""
_START = np.array([0.3, -0.2, 1.0, 2.0, -1.0, 0.5])
_EXACT = 1e-6
_THROUGH = 0.1
"""Part of its way that a body may go on into another: an engine of fixed steps stops it at their ends."""


def check_engine(engine: Engine) -> list[Property]:
    """Return the properties of an engine; it is looked at with a free body, and with one that falls on a slab."""
    look = _Look(engine)
    rows = [
        ("names", "`layers`, `own`, `counts` and `settings` name what the memory has, and is to have", look.names),
        ("free fall", "a free body moves as gravity has it", look.falls),
        ("samples", "the samples are at the times asked for, from the start to the end", look.samples),
        ("many samples", "no sample is lost where they fill the buffers many times", look.many_samples),
        ("energy", "the account of energy closes", look.energy),
        ("repeatable", "a second run of one model is the same to the last bit", look.repeats),
        ("contact", "a body does not fall through a slab, or `check` refuses it and names the engine", look.lands),
        ("continues", "a run that is stopped and goes on is the run that is not, to the last bit", look.continues),
    ]
    return properties(engine, [*component_rows(engine), *rows])


class _Look:
    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @cached_property
    def _system(self) -> System:
        puck = Puck()
        system = System([puck], _GRAVITY)
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
        path[:, 2] -= 0.5 * _GRAVITY * t**2
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
        if not self._solution.energy.residual <= _EXACT:
            raise Broken(f"must be at most {_EXACT:g}", "energy residual", self._solution.energy.residual)

    def repeats(self) -> None:
        """Run again."""
        self._compare(self._model.run(_END, sample_interval=_END / _SAMPLES))

    def lands(self) -> None:
        """Drop a body from a height, and look at the gap there and from then on."""
        puck, height = Puck(), 0.5 * _GRAVITY * (0.5 * _END) ** 2
        system = over_slab(puck, height, np.zeros(6), (Rigid(), Constant(), Spring()), gravity=_GRAVITY)
        try:
            self._engine.check(system)
        except InvalidInput as refused:
            if type(self._engine).__name__ not in str(refused):
                raise Broken("the refusal must name the engine", "check", str(refused)) from None
            return
        _ = self._model
        lowest = float(assemble(system, self._engine).run(_END, sample_interval=_END / _SAMPLES).q[:, 2].min())
        if not lowest >= -_THROUGH * height:
            raise Broken(f"it must stay over the slab, but for {_THROUGH:g} of the way it fell", "gap", lowest)

    def continues(self) -> None:
        """Stop between two samples, and go on."""
        half = self._model.run(0.55 * _END)
        self._compare(self._model.run(_END, start=half.state))

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
