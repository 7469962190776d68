"""Every notebook runs from its first cell to its last, and is kept without what it shows."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
_SECONDS = 240
"""The longest time of a cell."""
_MISSING = "the extra notebooks is not installed"


def _cells(path: Path) -> list[dict[str, Any]]:
    cells: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return cells


def _text(cell: dict[str, Any]) -> str:
    return "".join(cell["source"])


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_kept_without_outputs(path: Path) -> None:
    code = [cell for cell in _cells(path) if cell["cell_type"] == "code"]
    assert [cell["outputs"] for cell in code] == [[]] * len(code)
    assert {cell["execution_count"] for cell in code} == {None}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_each_cell_is_introduced_and_something_is_asserted(path: Path) -> None:
    cells = _cells(path)
    for before, cell in pairwise(cells):
        assert "markdown" in (before["cell_type"], cell["cell_type"]), _text(cell)
    assert any("assert" in _text(cell) for cell in cells if cell["cell_type"] == "code")


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No cell fails or warns; those that end with a run show it in a frame."""
    nbformat, nbclient, _ = (
        pytest.importorskip(name, reason=_MISSING) for name in ("nbformat", "nbclient", "ipykernel")
    )
    # kernels, settings and history of whoever runs the tests are left alone
    for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR"):
        monkeypatch.setenv(name, str(tmp_path / name))
    # pictures go into the notebook
    monkeypatch.delenv("MPLBACKEND", raising=False)
    notebook = nbformat.read(path, as_version=4)
    place = tmp_path / "work"
    place.mkdir()
    nbclient.NotebookClient(
        notebook, timeout=_SECONDS, kernel_name="python3", resources={"metadata": {"path": str(place)}}
    ).execute()

    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    complaints = [output["text"] for output in outputs if output.get("name") == "stderr"]
    assert not any("Warning" in text for text in complaints), complaints
    assert any("image/png" in output.get("data", {}) for output in outputs)
    if path.stem in ("dumbbell", "mesh"):
        assert notebook.cells[-1]["outputs"][-1]["data"]["text/html"].startswith("<iframe srcdoc=")


def test_the_page_names_every_notebook() -> None:
    page = (DOCS / "pages" / "notebooks.md").read_text(encoding="utf-8")
    assert len(NOTEBOOKS) >= 4
    for path in NOTEBOOKS:
        assert f"`docs/notebooks/{path.name}`" in page
