"""``nonsmooth compile``: what it says, and the bar of the first compilation."""

from __future__ import annotations

import io
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.native.kernel import PLAIN

Call = Callable[..., tuple[int, str, str]]
pytestmark = pytest.mark.skipif(PLAIN, reason="nothing is compiled")


def test_an_engine_that_is_compiled(call: Call) -> None:
    status, output, errors = call("compile")
    assert status == 0
    assert f"all {len(ENTRY_POINTS)} functions were compiled already; they are kept in " in output
    assert errors == ""


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("is_terminal", [True, False])
def test_the_first_compilation_counts_functions(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, is_terminal: bool
) -> None:
    """A process that writes two files takes the place of the compiler."""
    from nonsmooth.engine.native import code_files, entry_points
    from nonsmooth.notices import say

    say.cache_clear()
    stream = _Terminal() if is_terminal else io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    for module in (code_files, entry_points):
        monkeypatch.setattr(module, "folders", lambda: ([tmp_path], tmp_path))
    monkeypatch.setattr(entry_points, "KEEPS_FILES", True)
    monkeypatch.setattr(entry_points, "_LINES", 1.0)
    text = (
        "import pathlib, time\n"
        "for name in ('advance', 'locate'):\n"
        f"    time.sleep(0.7); (pathlib.Path({str(tmp_path)!r}) / f'{{name}}.code').touch()\n"
        "time.sleep(0.4)"
    )
    monkeypatch.setattr(entry_points, "_helper", lambda names: subprocess.Popen([sys.executable, "-c", text]))
    entry_points.compile_apart(("advance", "locate", "resolve", "collide"))
    told = stream.getvalue()
    if is_terminal:
        assert "compiling the engine once: 1 of 4 functions" in told
        assert "2 of 4 functions" in told
        assert "50%, about" in told
    else:
        first, second, *_ = told.splitlines()
        assert first == "compiling the engine once for this machine (20 s to 3 minutes) ..."
        assert re.fullmatch(r"compiling the engine once: 1 of 4 functions \(25%, about \d+ s to go\)", second)
