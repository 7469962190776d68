"""What is drawn is what happened: lines, stems, lanes and stacks against closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth import plot
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.draw_graph import draw
from nonsmooth.solution.modes import transition_graph

GRAVITY = 9.81
HEIGHT, RESTITUTION = 0.1, 0.8


def _drawn(ax: Axes, line: int = 0) -> tuple[Any, Any]:
    x, y = ax.lines[line].get_data()
    return np.asarray(x), np.asarray(y)


def _bounce(times: Any) -> tuple[Any, Any, Any]:
    """Return impact times, and height and velocity just after times, of the ball that bounces."""
    fall = math.sqrt(2.0 * HEIGHT / GRAVITY)
    flights = 2.0 * fall * RESTITUTION ** np.arange(1, 40)
    impacts = np.concatenate([[fall], fall + np.cumsum(flights)])
    k = np.searchsorted(impacts, times, side="right") - 1
    start = np.where(k < 0, 0.0, impacts[np.maximum(k, 0)])
    speed = np.where(k < 0, 0.0, GRAVITY * fall * RESTITUTION ** (k + 1.0))
    since = times - start
    return impacts, np.where(k < 0, HEIGHT, 0.0) + speed * since - GRAVITY / 2 * since**2, speed - GRAVITY * since


def test_dollar_signs_of_names_are_shown_as_they_are(tmp_path: Path) -> None:
    """Two of them would make a formula, which fails here, as matplotlib knows no such symbol."""
    ball, plate = Ball(0.01), Plate()
    system = ns.System([ball, plate])
    system.name(ball, r"5 $\oops$ ball")
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.011))
    solution = ns.simulate(system, 0.05)
    for drawn in (
        plot.gaps(solution),
        plot.modes(solution),
        plot.impulses(solution),
        plot.path(solution, ball),
        plot.phase_portrait(solution, r"5 $\oops$ ball z"),
    ):
        assert isinstance(drawn.figure, Figure)
        drawn.figure.savefig(tmp_path / "picture.png")
    draw(transition_graph(solution)).savefig(tmp_path / "picture.png")
    legend = plot.gaps(solution).get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [r"plate - 5 \$\oops\$ ball"]


def test_the_gap_of_a_ball_that_bounces(bounces: ns.Solution) -> None:
    """Parabolas between the impacts of the closed form, which are among the times drawn."""
    ax = plot.gaps(bounces)
    times, gaps = _drawn(ax)
    impacts, heights, _ = _bounce(times)
    np.testing.assert_allclose(gaps, heights, rtol=0, atol=1e-9)
    inside = impacts[impacts < 0.9]
    assert len(inside) > 3
    assert np.min(np.abs(times[:, None] - inside), axis=0).max() < 1e-9
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", "gap [m]")


def test_its_velocity_jumps_by_the_restitution(bounces: ns.Solution) -> None:
    """It is that of the closed form, and -e of it behind each impact: both sides are drawn."""
    times, rates = _drawn(plot.velocities(bounces, "plate - ball"))
    events = bounces.events.time[bounces.events.cause == Cause.IMPACT]
    after = np.searchsorted(times, events)
    np.testing.assert_allclose(rates[after], -RESTITUTION * rates[after - 1], rtol=1e-9)
    apart = np.min(np.abs(times[:, None] - events), axis=1) > 1e-9
    np.testing.assert_allclose(rates[apart], _bounce(times[apart])[2], rtol=0, atol=1e-8)
    assert np.all(_drawn(plot.velocities(bounces, part="slip"))[1] < 1e-12)


def test_stems_are_the_impulses_at_the_times_of_impacts(bounces: ns.Solution) -> None:
    ball = bounces.system.bodies[1]
    assert isinstance(ball, Ball)
    times, sizes = _drawn(plot.impulses(bounces))
    impacts = _bounce(0.0)[0]
    np.testing.assert_allclose(times, impacts[: len(times)], rtol=0, atol=1e-9)
    speeds = math.sqrt(2.0 * GRAVITY * HEIGHT) * RESTITUTION ** np.arange(len(times))
    np.testing.assert_allclose(sizes, ball.total_mass * (1.0 + RESTITUTION) * speeds, rtol=1e-8)
    assert len(_drawn(plot.impulses(bounces, part="friction"))[0]) == 0


def test_its_phase_portrait_is_a_parabola_on_each_flight(bounces: ns.Solution) -> None:
    """v^2 / 2 + g z is one number a flight; dotted lines lead from v to -e v."""
    ax = plot.phase_portrait(bounces, "ball z")
    x, y = _drawn(ax)
    flights = np.split(y**2 / 2.0 + GRAVITY * (x - 0.01), np.flatnonzero(np.isnan(y)))
    expected = GRAVITY * HEIGHT * RESTITUTION ** (2.0 * np.arange(len(flights)))
    for flight, energy in zip(flights, expected, strict=True):
        np.testing.assert_allclose(flight[~np.isnan(flight)], energy, rtol=1e-8)
    jumps = _drawn(ax, 1)[1].reshape(-1, 3)
    np.testing.assert_allclose(jumps[:, 1], -RESTITUTION * jumps[:, 0], rtol=1e-9)
    assert ax.get_xlabel() == "ball z [m]"
    assert ax.get_ylabel() == "its rate [m/s]"


def test_the_path_of_a_throw() -> None:
    ball = Ball(0.01)
    system = ns.System([ball])
    system.place(ball, position=(0.1, 0.0, 1.0), velocity=(2.0, 0.0, 3.0))
    solution = ns.simulate(system, 0.4)
    x, z = _drawn(plot.path(solution, "ball", plane="xz"))
    since = (x - 0.1) / 2.0
    np.testing.assert_allclose(z, 1.0 + 3.0 * since - GRAVITY / 2 * since**2, rtol=0, atol=1e-9)
    np.testing.assert_allclose(_drawn(plot.path(solution, ball, times=[0.1, 0.2]))[0], [0.3, 0.5], rtol=1e-9)


@pytest.mark.slow
def test_forces_on_a_slope(build: Any) -> None:
    """A ball that slides bears its share of the weight, and friction to the coefficient."""
    ball = Ball(0.1)
    system = build.over(ball, Rest(slope=0.3), friction=0.05)
    ns.resting(system, ball)
    solution = ns.simulate(system, 0.3)
    weight = ball.total_mass * GRAVITY
    np.testing.assert_allclose(_drawn(plot.forces(solution))[1], weight * math.cos(0.3), rtol=1e-9)
    rubbed = _drawn(plot.forces(solution, part="friction"))[1]
    np.testing.assert_allclose(rubbed, 0.05 * weight * math.cos(0.3), rtol=1e-8)
    times, slip = _drawn(plot.velocities(solution, part="slip"))
    np.testing.assert_allclose(slip, GRAVITY * times * (math.sin(0.3) - 3.5 * 0.05 * math.cos(0.3)), atol=1e-9)


def test_forces_stop_where_a_contact_is_open(bounces: ns.Solution) -> None:
    assert np.all(np.isnan(_drawn(plot.forces(bounces))[1]))


def test_the_stack_of_energies_closes(drift: ns.Solution) -> None:
    """At every time its top is the energy at the start and all work since; each layer is what the account says."""
    ax = plot.energies(drift)
    times, total = _drawn(ax)
    tops = [_top(layer, times) for layer in ax.collections]
    np.testing.assert_allclose(tops[-1], total, rtol=0, atol=1e-7 * total.max())
    heights = np.diff([np.zeros(len(times)), *tops], axis=0)
    account = drift.energy
    assert heights[1, -1] == pytest.approx(account.kinetic_end, rel=1e-9)
    assert heights[2, -1] == pytest.approx(account.friction_loss, rel=1e-9)
    assert heights[3, -1] == pytest.approx(account.restitution_loss, rel=1e-9)
    assert np.all(np.diff(heights[2:4], axis=1) > -1e-12)
    least = account.potential_end - heights[0, -1]
    start = account.kinetic_start + account.potential_start
    assert total[-1] == pytest.approx(start - least + account.driven_work, rel=1e-9)
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()][1:3] == ["kinetic", "lost to friction"]


def _top(layer: Any, times: Any) -> Any:
    """Return the upper edge of a filled layer at the times: its path goes there last, from right to left."""
    vertices = layer.get_paths()[0].vertices
    found = vertices[len(times) + 2 : 2 * len(times) + 2][::-1]
    np.testing.assert_array_equal(found[:, 0], times)
    return found[:, 1]


def test_lanes_follow_the_modes(drift: ns.Solution) -> None:
    """At times drawn at random the lane of each contact has the bar of its mode, or none where it is open."""
    ax = plot.modes(drift)
    times = np.random.default_rng(5).uniform(0.0, 0.3, 200)
    modes = drift.at(times)["mode"]
    assert {*modes.ravel().tolist()} == {0, 2}
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names == [contact.name for contact in drift.system.contacts]
    found = np.zeros_like(modes)
    for contact in range(2):
        stick, slip, struck = ax.collections[3 * contact : 3 * contact + 3]
        for mode, bars in ((1, stick), (2, slip)):
            for bar in bars.get_paths():
                corners = np.asarray(bar.vertices)
                (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
                assert low < contact < high
                found[(times > left) & (times < right), contact] += mode
        pushed = drift.events.time[drift.events.impulse[:, contact, 0] > 0.0]
        np.testing.assert_array_equal([stroke[0, 0] for stroke in struck.get_segments()], pushed)  # type: ignore[attr-defined]
    np.testing.assert_array_equal(found, modes)


def test_stick_and_slip_differ_without_colour(drift: ns.Solution) -> None:
    stick, slip = plot.modes(drift).collections[:2]
    weigh = np.array([0.2126, 0.7152, 0.0722])
    light = [float(np.asarray(bars.get_facecolor())[0, :3] @ weigh) for bars in (stick, slip)]
    assert light[1] - light[0] > 0.25
    assert stick.get_hatch() != slip.get_hatch()


def test_round_off_is_no_motion_to_be_seen(build: Any) -> None:
    """A gap of a contact that stays closed is a line at zero, however little the axes would have to show."""
    ball = Ball(0.1)
    system = build.over(ball, Rest(slope=0.3))
    ns.resting(system, ball)
    assert plot.gaps(ns.simulate(system, 0.1)).get_ylim()[1] >= 1e-7


def test_of_many_contacts_the_busiest() -> None:
    """The two balls that strike, of twelve; the legend says so."""
    plate, balls = Plate(), [Ball(0.01) for _ in range(12)]
    system = ns.System([plate, *balls])
    laws: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.2), "impact": EnergeticImpact(0.5)}
    for i, ball in enumerate(balls):
        system.contact(plate, ball, **laws)
        system.place(ball, position=(0.03 * i, 0.0, 0.011 if i in (3, 11) else 5.0))
    ax = plot.impulses(ns.simulate(system, 0.03))
    names = [line.get_label() for line in ax.lines]
    assert len(names) == 8
    assert {"plate - ball 4", "plate - ball 12"} <= {*names}
    legend = ax.get_legend()
    assert legend is not None
    assert legend.get_title().get_text() == "8 of 12 contacts"


def test_they_are_composed(bounces: ns.Solution) -> None:
    """Several on axes of one's own."""
    top, bottom = Figure().subplots(2, 1, sharex=True)
    assert plot.gaps(bounces, ax=top) is top
    assert plot.energies(bounces, bottom) is bottom
    assert plot.modes(bounces, ax=top) is top


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("draw", [plot.gaps, plot.energies, plot.modes])
@pytest.mark.parametrize("layout", [None, "tight", "constrained"])
def test_the_legend_is_whole_on_axes_of_any_figure(bounces: ns.Solution, draw: Any, layout: Any) -> None:
    figure = Figure(layout=layout)
    ax = draw(bounces, ax=figure.subplots())
    figure.draw_without_rendering()
    legend, axes = ax.get_legend().get_window_extent(), ax.get_window_extent()
    assert figure.bbox.x0 <= legend.x0
    assert legend.x1 <= figure.bbox.x1
    assert (legend.x0 >= axes.x1) == (layout is not None)  # beside the curves where there is room
