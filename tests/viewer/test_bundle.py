"""The bundle is what its sources give."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path

import pytest

from tests.viewer.bundle import BUNDLE, RECORD, build, bundled, sources


def test_the_bundle_was_made_of_these_sources() -> None:
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    remedy = "run python -m tests.viewer.bundle"
    assert record["sources"] == sources(), remedy
    assert record["bundle"] == bundled(), remedy


def test_it_asks_for_nothing_outside_and_holds_its_licence() -> None:
    text = BUNDLE.read_text(encoding="utf-8")
    assert "</script" not in text.lower().replace("<\\/script", "")
    assert "SPDX-License-Identifier: MIT" in text


@pytest.mark.skipif(
    shutil.which("npm") is None or "CI" not in os.environ, reason="fetches the bundler: where CI is set"
)
def test_a_build_gives_the_same_bundle(tmp_path: Path) -> None:
    build(tmp_path / "viewer.js")
    assert hashlib.sha256((tmp_path / "viewer.js").read_bytes()).hexdigest() == bundled()
