"""Make the generated parts of pages: ``python docs/build_pages.py [NAME ...]``.

Each scenario is run with its defaults.  Its view and picture go to docs/pages/gallery/views, where pages link to them;
its parameters, and the criteria as this run meets them, to docs/parts, from which pages include them. So do the
matrix of shapes that touch each other (:mod:`shape_matrix`) and the errors of contacts (:mod:`pair_errors`). So do the
commands of the reference (:mod:`command_pages`).
"""

from __future__ import annotations

import io
import shlex
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import pair_errors
import shape_matrix
from command_pages import command_page
from parameter_tables import markdown, table
from PIL import Image

import nonsmooth as ns
from nonsmooth.cli.docstrings import first_line
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.plugins import registry

DOCS = Path(__file__).parent
VIEWS = DOCS / "pages" / "gallery" / "views"
PARTS = DOCS / "parts"
OTHERS: dict[str, tuple[dict[str, str], ...]] = {"dumbbell": ({"mode": "drift"}, {"mode": "jump"}, {"mode": "flutter"})}
"""Parameters to view where one run with the defaults does not show what a scenario is for."""
_PAGES = {"rocking_block_3d": "rocking_block"}
"""Pages that are not named as their scenario."""
_BY_APPEAL = [
    "dominoes",
    "newtons_cradle",
    "dice_throw",
    "tippe_top",
    "rolling_disc",
    "woodpecker",
    "egg_on_table",
    "rattleback",
    "dumbbell",
    "bouncing_ball",
    "ball_box",
    "mesh_drop",
    "rocking_block",
    "rocking_block_3d",
    "bouncing_trimer",
    "slider_crank",
    "polyhedron_stack",
    "block_on_belt",
    "two_link_arm",
    "sliding_rod",
    "bead_column",
    "disc_ball",
    "mesh_dumbbell",
]
"""Order of the cards of the gallery; scenarios not listed here follow by name."""
_FRAMES, _SHOWN = 25, 10
"""Pictures of a run, and which of them is shown."""


def build(name: str) -> tuple[str, list[tuple[str, ...]]]:
    """Write the parts of a scenario; return its card and the rows of its criteria."""
    owner = registry.load("scenarios", name)
    PARTS.mkdir(exist_ok=True)
    VIEWS.mkdir(exist_ok=True)
    views = [_view(name, owner, given) for given in OTHERS.get(name, ({},))]
    scenario, solution = _run(owner, {})
    _picture(solution, VIEWS / f"{name}.webp")
    (PARTS / f"{name}.view.md").write_text("\n".join(views), encoding="utf-8")
    criteria = scenario.acceptance(solution)
    numbers = [
        f"## Parameters of `{name}`",
        table(owner),
        f"## Criteria of `{name}`, as a run with the defaults meets them",
        _criteria(criteria),
    ]
    (PARTS / f"{name}.numbers.md").write_text("\n\n".join(numbers) + "\n", encoding="utf-8")
    page = f"{_PAGES.get(name, name)}.md"
    picture = f"[![{owner.title}]({VIEWS.name}/{name}.webp)]({page})"
    card = f"-   {picture}\n\n    [{owner.title}]({page}): {first_line(owner)}\n"
    return card, [(owner.title, *_row(one)) for one in criteria]


def _run(owner: type[Scenario], given: dict[str, str]) -> tuple[Any, ns.Solution]:
    scenario: Any = owner(**given)
    return scenario, ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)


def _view(name: str, owner: type[Scenario], given: dict[str, str]) -> str:
    """Write the page that plays a run; return the Markdown that shows it."""
    words = [f"{key}={value}" for key, value in given.items()]
    scenario, solution = _run(owner, given)
    title = ", ".join([scenario.title, *words])
    path = solution.to_html(VIEWS / f"{'-'.join([name, *given.values()])}.html", title=title)
    link = f"{VIEWS.name}/{path.name}"
    command = shlex.join(["nonsmooth", "view", name, *(part for word in words for part in ("--set", word))])
    size = path.stat().st_size / 1e6
    return (
        f'<iframe class="view" src="{link}" title="{title}" loading="lazy"></iframe>\n\n'
        f"`{command}` plays this, {scenario.t_end:g} s with {len(solution.events)} events; "
        f"[on a page of its own]({link}), {size:.1f} MB.\n"
    )


def _picture(solution: ns.Solution, path: Path) -> None:
    duration = solution.t_end - float(solution.t[0])
    solution.export(path, size=360, frames_per_second=1, speed=duration / (_FRAMES - 1))
    with Image.open(io.BytesIO(path.read_bytes())) as picture:
        picture.seek(_SHOWN)
        picture.convert("RGB").save(path, quality=85)


def _criteria(found: tuple[Criterion, ...]) -> str:
    rows = [("number", "value", "from", "to", "source", "result")]
    rows += [(*_row(one), "met" if one.fulfilled else "NOT MET") for one in found]
    return markdown(rows)


def _row(one: Criterion) -> tuple[str, ...]:
    value, lower, upper = (f"{x:.9g}" for x in (one.value, one.lower, one.upper))
    return one.name, value, lower, upper, one.source


def main() -> None:
    """Build the scenarios named, or all and the list of them."""
    PARTS.mkdir(exist_ok=True)
    (PARTS / "commands.md").write_text(command_page(), encoding="utf-8")
    names = sys.argv[1:] or sorted(
        registry.names("scenarios"),
        key=lambda name: (name not in _BY_APPEAL, name in _BY_APPEAL and _BY_APPEAL.index(name), name),
    )
    # the first one alone, as it compiles the engine
    built = [build(names[0])]
    with ProcessPoolExecutor() as workers:
        built += workers.map(build, names[1:])
    if not sys.argv[1:]:
        text = "\n".join(['<div class="grid cards" markdown>\n', *(card for card, _ in built), "</div>\n"])
        (PARTS / "gallery.md").write_text(text, encoding="utf-8")
        criteria = [row for _, rows in built for row in rows]
        head = ("scenario", "number", "value", "from", "to", "source")
        (PARTS / "criteria.md").write_text(f"{markdown([head, *criteria])}\n", encoding="utf-8")
        shape_matrix.main()
        pair_errors.main()


if __name__ == "__main__":
    main()
