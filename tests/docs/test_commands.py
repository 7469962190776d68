"""The commands of the documentation run, in order, from an empty folder, in an environment of their own."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.environments import ROOT, Environment

PAGES = ROOT / "docs" / "pages"
SESSIONS = ("plugins/friction_law.md", "howto/scenario_file.md")
"""Pages whose bash blocks are one session."""

_BLOCK = re.compile(
    r"^```(?P<kind>bash|toml|yaml)\n(?P<text>.*?)^```\n(?:\nprints\n\n```text\n(?P<output>.*?)^```\n)?", re.M | re.S
)
_NAME = re.compile(r"# (\S+\.(?:toml|yaml))\n")
_MARK = "---- end of a block ----"


def _blocks(page: Path) -> list[re.Match[str]]:
    return list(_BLOCK.finditer(page.read_text(encoding="utf-8")))


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """Return an environment without plug-ins."""
    return Environment(tmp_path_factory.mktemp("commands") / "environment")


@pytest.mark.slow
@pytest.mark.parametrize("name", SESSIONS)
def test_the_commands_of_a_page_do_what_it_says(name: str, environment: Environment, tmp_path: Path) -> None:
    """A toml or yaml block with a file name in its first line is that file; the bash blocks are one session."""
    script = ["set -e"]
    blocks = _blocks(PAGES / name)
    assert any(block["kind"] == "bash" for block in blocks)
    for block in blocks:
        if block["kind"] != "bash":
            named = _NAME.match(block["text"])
            if named is not None:
                (tmp_path / named[1]).write_text(block["text"], encoding="utf-8")
        else:
            script += [block["text"], f"echo '{_MARK}'"]
    printed = environment.run("\n".join(script), tmp_path)[0].split(f"{_MARK}\n")
    told = [block["output"] for block in blocks if block["kind"] == "bash"]
    for text, output in zip(told, printed[:-1], strict=True):
        assert text is None or text == output


@pytest.mark.slow
def test_the_law_of_the_page_is_the_one_that_is_written(environment: Environment, tmp_path: Path) -> None:
    environment.nonsmooth("new", "plugin", "felt", folder=tmp_path)
    law = (tmp_path / "felt" / "felt" / "friction.py").read_text(encoding="utf-8")
    assert f"```python\n{law}```\n" in (PAGES / "plugins" / "friction_law.md").read_text(encoding="utf-8")
    assert len(law.splitlines()) <= 25
