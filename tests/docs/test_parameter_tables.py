"""The reference shows what parameters are, not the calls that declare them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

griffe: Any = pytest.importorskip("griffe", reason="the extra docs is not installed")

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def law() -> Any:
    """Return a law whose parameters are declared by helpers, and whose docstring has a section."""
    extensions = griffe.load_extensions(ROOT / "docs" / "parameter_tables.py")
    return griffe.load("laws", search_paths=[ROOT], extensions=extensions)["impact.energetic.EnergeticImpact"]


def test_signature_has_the_defaults(law: Any) -> None:
    defaults = {parameter.name: parameter.default for parameter in law.parameters}
    assert defaults == {"self": None, "restitution": None, "stiffness": "1.0", "exponent": "1.5", "duration": "2e-05"}


def test_table_has_unit_and_range_before_the_sections(law: Any) -> None:
    text, *sections = law.docstring.parse("numpy")
    row = "| restitution | required | 1 | >= 0 and &lt;= 1 | energetic coefficient of restitution e |"
    assert row in text.value.splitlines()
    assert r"| contact time T\_c of the accumulation rule (33) |" in text.value
    assert [section.title for section in sections] == ["References"]
