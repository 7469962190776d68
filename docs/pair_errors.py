"""Write the errors of contact pairs, by method: ``python docs/pair_errors.py`` makes docs/parts/pair_errors.md.

``python -m tests.benchmarks.contact_accuracy`` measures the errors. The stored ones are in docs/pages/figures.
"""

from __future__ import annotations

import csv
from pathlib import Path

from parameter_tables import markdown

DOCS = Path(__file__).parent
STORED = DOCS / "pages" / "figures" / "contact_accuracy.csv"
PART = DOCS / "parts" / "pair_errors.md"
COLUMNS = "gap [m]", "normal [rad]", "witness [m]", "first rate", "second rate", "query [µs]"
METHODS = {
    "closed form": "a closed form",
    "Newton's method for one angle": "Newton's method for one angle",
    "Newton's method on the support functions": "Newton's method on both support functions",
    "": "a walk over features, with Newton's method on one support function",
}
"""Groups of the methods that kinematics name, by their first words; the last one holds all others."""


def stored() -> list[dict[str, str]]:
    """Return the stored rows, one for each pair of shapes and features."""
    with STORED.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def by_method() -> str:
    """Return the largest errors of each group of pairs as a table of Markdown."""
    groups: dict[str, list[dict[str, str]]] = {name: [] for name in METHODS.values()}
    for row in stored():
        groups[next(name for start, name in METHODS.items() if row["found by"].startswith(start))].append(row)
    table = [("gap found by", "pairs", *COLUMNS)]
    for name, rows in groups.items():
        largest = [max((row[column] for row in rows), key=float) for column in COLUMNS]
        table.append((name, str(len(rows)), *largest))
    return markdown(table)


def main() -> None:
    """Write the part."""
    PART.parent.mkdir(exist_ok=True)
    PART.write_text(f"{by_method()}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
