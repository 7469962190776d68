"""Make the generated parts of the site: ``python docs/build_pages.py [NAME ...]``.

Each scenario is run with its defaults.  Its view and picture go to docs/pages/gallery/views, where pages link to them;
its parameters, and the criteria as this run meets them, to docs/parts, from which pages include them.
The commands of the reference (``command_pages.py``) go there, too.
"""

from __future__ import annotations

import io
import shlex
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

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
_FRAMES, _SHOWN = 25, 10
"""Pictures of a run, and which of them is shown."""


def build(name: str) -> str:
    """Write the parts of a scenario; return its card."""
    owner = registry.load("scenarios", name)
    PARTS.mkdir(exist_ok=True)
    VIEWS.mkdir(exist_ok=True)
    views = [_view(name, owner, given) for given in OTHERS.get(name, ({},))]
    scenario, solution = _run(owner, {})
    _picture(solution, VIEWS / f"{name}.webp")
    (PARTS / f"{name}.view.md").write_text("\n".join(views), encoding="utf-8")
    numbers = [
        f"## Parameters of `{name}`",
        table(owner),
        f"## Criteria of `{name}`, as a run with the defaults meets them",
        _criteria(scenario.acceptance(solution)),
    ]
    (PARTS / f"{name}.numbers.md").write_text("\n\n".join(numbers) + "\n", encoding="utf-8")
    page = f"{_PAGES.get(name, name)}.md"
    picture = f"[![{owner.title}]({VIEWS.name}/{name}.webp)]({page})"
    return f"-   {picture}\n\n    [{owner.title}]({page}): {first_line(owner)}\n"


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
    rows = [("number", "value", "from", "to", "source", "")]
    for one in found:
        value, lower, upper = (f"{x:.9g}" for x in (one.value, one.lower, one.upper))
        rows.append((one.name, value, lower, upper, one.source, "met" if one.fulfilled else "NOT MET"))
    return markdown(rows)


def main() -> None:
    """Build the scenarios named, or all and the list of them."""
    PARTS.mkdir(exist_ok=True)
    (PARTS / "commands.md").write_text(command_page(), encoding="utf-8")
    names = sys.argv[1:] or sorted(registry.names("scenarios"))
    # the first one alone, as it compiles the engine
    cards = [build(names[0])]
    with ProcessPoolExecutor() as workers:
        cards += workers.map(build, names[1:])
    if not sys.argv[1:]:
        text = "\n".join(['<div class="grid cards" markdown>\n', *cards, "</div>\n"])
        (PARTS / "gallery.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
