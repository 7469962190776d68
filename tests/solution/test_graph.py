"""The graph of modes: it counts every event of the run, and its drawing shows what it says it shows."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, final

import pytest

import nonsmooth as ns
from bodies import Ball, Dumbbell, Harmonic, Plate, Rest
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.interfaces import Guard
from nonsmooth.solution.draw_graph import draw, places_of
from nonsmooth.solution.modes import ContactModes, TransitionGraph, grouped, mode_shares, transition_graph, transitions


@pytest.fixture(scope="module")
def sliding(build: Any) -> ns.Solution:
    """Return a dumbbell thrown on a slope: it bounces, slides, sticks."""
    body = Dumbbell()
    system = build.over(body, Rest(slope=0.1), restitution=0.3, friction=0.25, static=0.3)
    system.place(body, position=(0, 0, 0.03), velocity=(0.3, 0.2, 0.0), angular_velocity=(3.0, 2.0, 1.0))
    return ns.simulate(system, 1.0)


@pytest.fixture(scope="module")
def driven(build: Any) -> ns.Solution:
    """Return balls that dance on a vibrating plate: many modes."""
    plate, balls = Plate(Harmonic(4e-4, 25.0)), [Ball(0.005) for _ in range(6)]
    system = ns.System([plate, *balls])
    for i, ball in enumerate(balls):
        system.contact(plate, ball, **build.laws(restitution=0.5 + 0.05 * i))
        system.place(ball, position=(0.02 * i, 0.0, 0.006 + 1e-3 * i))
    return ns.simulate(system, 1.0)


def _check(solution: ns.Solution) -> TransitionGraph:
    graph = transition_graph(solution)
    assert graph.nodes == pytest.approx(mode_shares(solution))
    assert sum(graph.shares.values()) == pytest.approx(1.0)
    passed = {graph.word(mode) for mode in graph.passing}
    assert passed == set(solution.events.words("during")) - set(solution.events.words("after"))
    expected: Counter[tuple[str, str, str]] = Counter()
    for _, cause, before, during, after in transitions(solution)[1:]:
        for step in [(before, after)] if during in (before, after) else [(before, during), (during, after)]:
            expected[(*step, cause)] += 1
    assert graph.edges == expected
    # what comes to a mode leaves it, but for the start and the end of the run
    ends = Counter([graph.word(graph.start)])
    ends.subtract(solution.events.words("after")[-1:])
    for node in graph.nodes:
        into = sum(n for (_, other, _), n in graph.edges.items() if other == node)
        out = sum(n for (one, _, _), n in graph.edges.items() if one == node)
        assert out - into == ends[node]
    return graph


def test_every_event_is_counted(sliding: ns.Solution, driven: ns.Solution) -> None:
    """Words, shares, causes and numbers are those of the list of events; nothing is lost on the way."""
    graph = _check(sliding)
    assert graph.word(graph.start) == "{00,00,00}"
    assert {cause for _, _, cause in graph.edges} >= {"impact", "closing of an accumulation", "slip to stick"}
    assert len(_check(driven).nodes) > 14


def test_a_ball_that_bounces(build: Any) -> None:
    """Three impacts are three ways there and three back."""
    ball = Ball(0.01)
    system = build.over(ball, restitution=1.0, friction=0.0)
    system.place(ball, position=(0.0, 0.0, 0.11))
    graph = transition_graph(ns.simulate(system, 6.5 * (0.2 / 9.81) ** 0.5))
    assert graph.nodes == {"{0,0,0}": 1.0, "{1,1,0}": 0.0}
    assert graph.edges == {("{0,0,0}", "{1,1,0}", "impact"): 3, ("{1,1,0}", "{0,0,0}", "impact"): 3}
    assert list(graph.visits.values()) == [3, 4]


def _height(t: float, q: Any, u: Any) -> float:
    return float(q[2] - 0.5)


@final
@dataclass(frozen=True)
class Height(Guard):
    """Half a metre."""

    @property
    def value(self) -> Any:
        """The height above it."""
        return _height

    @property
    def ends_run(self) -> bool:
        """Go on."""
        return False


def test_a_guard_leads_to_the_same_mode() -> None:
    """A loop; a run without contacts has one mode, an empty word."""
    ball = Ball(0.01)
    system = ns.System([ball])
    system.guard(Height())
    system.place(ball, position=(0.0, 0.0, 1.0))
    graph = transition_graph(ns.simulate(system, 0.5))
    assert graph.nodes == {"{,,}": 1.0}
    assert graph.edges == {("{,,}", "{,,}", "guard of the scenario"): 1}
    assert len(_labels(graph)) == 3  # the node, the number at the loop, the axis label of the figure


def test_the_most_visited_part(driven: ns.Solution) -> None:
    """The start stays, the rest by visits; transitions to what is left out go."""
    whole = transition_graph(driven)
    part = whole.most_visited(5)
    assert len(part.shares) == 5
    assert part.start in part.shares
    kept = [whole.visits[mode] for mode in part.shares if mode != part.start]
    assert min(kept) >= max(n for mode, n in whole.visits.items() if mode not in part.shares)
    assert set(part.counts) == {edge for edge in whole.counts if {edge[0], edge[1]} <= set(part.shares)}
    assert whole.most_visited(1000) == whole


def _labels(graph: TransitionGraph, most: int = 14) -> list[str]:
    figure = draw(graph, most)
    found = [text.get_text() for axis in figure.axes for text in axis.texts]
    return [*found, figure.subfigs[1].texts[0].get_text()]


def _title(graph: TransitionGraph, most: int = 14) -> str:
    return str(draw(graph, most).subfigs[0].get_suptitle())


def _legend(graph: TransitionGraph) -> list[str]:
    return [text.get_text() for text in draw(graph).subfigs[0].legends[0].get_texts()]


@pytest.mark.slow
def test_the_drawing_names_modes_and_numbers(sliding: ns.Solution, driven: ns.Solution) -> None:
    """Each mode is written where it stands, or in the list beside; the title says how many are missing."""
    graph = transition_graph(sliding)
    labels = "\n".join(_labels(graph))
    for node in graph.nodes:
        assert node in labels
    letters = {cause: letter for letter, cause in (text.split(" ", 1) for text in _legend(graph))}
    assert {*letters} == {cause for _, _, cause in graph.edges}
    for (_, _, cause), number in graph.counts.items():
        assert f"\n{number} {letters[cause]}\n" in labels
    many = transition_graph(driven)
    listed = "\n".join(_labels(many, 6))
    assert sum(node in listed for node in many.nodes) == 6
    title = _title(many, 6)
    assert f"{len(many.nodes)} visited" in title
    assert f"the {len(many.nodes) - 6} modes visited least are left out" in title
    assert "left out" not in _title(graph)


@pytest.fixture(scope="module")
def shaken(build: Any) -> ns.Solution:
    """Return twenty balls on a vibrating plate, with two hundred and ten contacts."""
    plate, balls = Plate(Harmonic(4e-4, 25.0)), [Ball(0.005) for _ in range(20)]
    system = ns.System([plate, *balls])
    for i, ball in enumerate(balls):
        for other in [plate, *balls[:i]]:
            system.contact(other, ball, **build.laws(restitution=0.5))
        system.place(ball, position=(0.012 * i, 0.0, 0.006 + 2e-4 * i))
    return ns.simulate(system, 0.3)


def test_modes_of_many_contacts_are_grouped(shaken: ns.Solution) -> None:
    """By how many are closed, strike and slip: shares and transitions from group to group are those of the run."""
    graph = transition_graph(shaken)
    assert len(graph.contacts) == 210
    assert len(graph.shares) > 100
    whole, words = grouped(graph)
    assert words.keys() == whole.shares.keys()
    assert len(words) < 30
    assert sum(whole.shares.values()) == pytest.approx(1.0)
    open_ = sum(share for mode, share in graph.shares.items() if not mode)
    assert open_ == pytest.approx(next(whole.shares[mode] for mode, word in words.items() if word == "all open"))
    between = [(words[one], words[other]) for (one, other, _), n in whole.counts.items() for _ in range(n)]
    assert all(one != other for one, other in between)
    closed = [len([bits for _, bits in mode if bits & 1]) for mode in whole.shares]
    for n, word in zip(closed, words.values(), strict=True):
        low, _, high = word.split()[0].partition("-")
        if word.endswith("slip"):
            assert int(low) <= n <= int(high or low)
    struck = sum(one.startswith("impact") for one, _ in between)
    assert struck == sum(n for (one, _, _), n in graph.counts.items() if one in graph.passing)


def test_a_mode_that_gets_other_features_right_away_is_in_the_group_of_its_kind() -> None:
    """It is no mode that lasted, but one that was left."""
    rests: ContactModes = ((0, 1),)
    other: ContactModes = ((1, 1),)
    struck: ContactModes = ((1, 3),)
    edges: dict[tuple[ContactModes, ContactModes, str], int] = {
        (other, struck, "impact"): 2,
        (struck, rests, "impact"): 2,
        (((1, 5),), rests, "slip to stick"): 1,
    }
    graph = TransitionGraph(("a", "b"), rests, {rests: 1.0, struck: 0.0}, frozenset([struck]), edges)
    whole, words = grouped(graph)
    assert words == {rests: "1 closed, none slip", struck: "impact, 1 strike"}
    assert whole.counts == {(rests, struck, "impact"): 2, (struck, rests, "impact"): 2}


@pytest.mark.slow
def test_the_list_of_groups_has_the_commonest_first(shaken: ns.Solution) -> None:
    graph = transition_graph(shaken)
    rows = next(text for text in _labels(graph) if "\n" in text and " x " in text).splitlines()
    visits = [int(row.split()[1]) for row in rows]
    assert visits == sorted(visits, reverse=True)
    assert len(rows) <= 14
    assert max(map(len, rows)) < 60
    assert "groups" in _title(graph)


@pytest.mark.slow
def test_modes_stand_apart(sliding: ns.Solution, driven: ns.Solution) -> None:
    """No two on one place, whatever the graph."""
    for graph in (transition_graph(sliding), transition_graph(driven).most_visited(14)):
        places = list(places_of(graph).values())
        for i, (x, y) in enumerate(places):
            assert all((x - u) ** 2 + (y - v) ** 2 > 0.2**2 for u, v in places[:i])


@pytest.mark.slow
def test_every_cause_has_a_colour() -> None:
    from nonsmooth.solution import draw_graph

    assert len(set(draw_graph._COLOURS)) == len(CAUSES)
