"""A bit that changes on the disk is noticed in every file of a result and of a study, or nothing of it is used."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.results.output import SOLUTION, Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.solution.events import COLUMNS
from nonsmooth.studies.study_folder import StudyFolder
from tests.results.runs import balls
from tests.studies import ball

FLIPS = 300
"""Bits that are flipped, one after another, of the files of one folder."""


def _of_solution(folder: Path) -> dict[str, Any]:
    """All that nonsmooth reads of a run."""
    solution, stored = ns.open_solution(folder.parent), SolutionFolder.opened(Output(folder.parent))
    found = {name: getattr(solution.events, name) for name in COLUMNS}
    found |= {"rows": solution.recorded.rows, "text": stored.system_text(), "attributes": repr(stored.attributes)}
    found |= {f"state {name}": getattr(solution.state, name) for name in ("time", "q", "u", "modes", "features")}
    assert solution.state.continuation is not None
    return found | {"difference": solution.state.continuation.difference.packed()}


def _of_study(folder: Path) -> dict[str, Any]:
    """All that nonsmooth reads of a study."""
    stored = StudyFolder(folder)
    found = {name: stored.read(name) for name in (*stored.variables, *stored.coordinates)}
    return found | {"texts": repr(stored.texts()), "attributes": repr(stored.attributes), "done": stored.committed()}


def _equal(one: dict[str, Any], other: dict[str, Any]) -> bool:
    return all(np.asarray(value).tolist() == np.asarray(other[name]).tolist() for name, value in one.items())


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    place = tmp_path_factory.mktemp("flipped")
    ns.simulate(balls(), 0.1, output=place / "run")
    ball.study(4).run(place / "study.zarr", executor="serial", chunk=2)
    return {"run": place / "run" / SOLUTION, "study": place / "study.zarr"}


READ: dict[str, Callable[[Path], dict[str, Any]]] = {"run": _of_solution, "study": _of_study}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", READ)
def test_a_flipped_bit_is_noticed_or_not_used(kind: str, seed: int, folders: dict[str, Path], tmp_path: Path) -> None:
    folder = tmp_path / kind / folders[kind].name
    shutil.copytree(folders[kind], folder)
    read, draw = READ[kind], np.random.default_rng(seed)
    sound, files = read(folder), sorted(path for path in folder.rglob("*") if path.is_file() and path.stat().st_size)
    told: list[tuple[Path, str]] = []
    for _ in range(FLIPS):
        path = files[draw.integers(len(files))]
        content = path.read_bytes()
        bits = bytearray(content)
        bits[draw.integers(len(bits))] ^= 1 << int(draw.integers(8))
        path.write_bytes(bits)
        try:
            assert _equal(sound, read(folder)), path
        except ns.InvalidInput as error:
            told.append((path, str(error)))
        path.write_bytes(content)
    for path, message in told:
        assert str(folder if path.name == "zarr.json" else path) in message
    # the metadata of single arrays, about half of the files, are for other readers
    assert len(told) > FLIPS / 4


def test_a_flipped_bit_of_each_chunk_is_named(folders: dict[str, Path]) -> None:
    """With the file and what to do, in each array of a run."""
    folder = folders["run"]
    chunks = sorted(folder.glob("*/c*"))
    assert len(chunks) > 20
    for path in chunks:
        sound = path.read_bytes()
        turned = bytearray(sound)
        turned[len(turned) // 2] ^= 4
        path.write_bytes(turned)
        with pytest.raises(ns.InvalidInput, match=r"must be a whole chunk.*checksum.*take it from a copy") as told:
            SolutionFolder.opened(Output(folder.parent))._arrays.read(path.parent.name)
        assert str(path) in str(told.value)
        path.write_bytes(sound)
    assert ns.open_solution(folder.parent).status == "done"
