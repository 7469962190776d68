"""The overview: panels for what a run has, of any scenario."""

from __future__ import annotations

import pytest

import nonsmooth as ns
from bodies import Ball
from nonsmooth.plugins import registry

_CONTACTS = {"Modes of the contacts", "Gaps"}
_ALWAYS = "Energies and losses, stacked"
_STRUCK, _BORNE = "Impulses of impacts", "Normal forces between events"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "t_end", "more"),
    [
        ("bouncing_ball", 0.2, {_STRUCK, "Path of 'ball'"}),
        ("dumbbell", 0.2, {_STRUCK, _BORNE, "Path of 'dumbbell'"}),
        ("woodpecker", 0.4, {_STRUCK, _BORNE, "Path of 'generalised'"}),
        ("rattleback", 0.2, {_BORNE, "Path of 'rigid body'"}),
        ("dice_throw", 0.12, {_STRUCK, _BORNE, "Path of 'box 3'"}),
        ("mesh_drop", 0.11, {_STRUCK, "Path of 'mesh'"}),
        ("newtons_cradle", None, {_STRUCK, _BORNE, "Path of 'ball 5'"}),
    ],
)
def test_panels_are_what_the_run_has(name: str, t_end: float | None, more: set[str]) -> None:
    scenario = registry.load("scenarios", name)()
    solution = ns.simulate(scenario.build(), scenario.t_end if t_end is None else t_end)
    figure = solution.plot()
    assert {axis.get_title() for axis in figure.axes} == {*_CONTACTS, _ALWAYS, *more}
    figure.draw_without_rendering()
    assert all(axis.has_data() for axis in figure.axes)


def test_without_contacts_there_are_no_panels_of_them() -> None:
    ball = Ball(0.01)
    system = ns.System([ball], gravity=0.0)
    assert [axis.get_title() for axis in ns.simulate(system, 0.1).plot().axes] == [_ALWAYS]
