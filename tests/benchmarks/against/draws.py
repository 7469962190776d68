"""Write random systems as data: ``python -m tests.benchmarks.against.draws FIRST COUNT FILE``.

Only the working tree draws; both sides read the file.
"""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path

from tests.benchmarks.described.cases import describe
from tests.benchmarks.random_systems.generate import case_of


def main() -> None:
    """Write one system a line."""
    warnings.simplefilter("ignore")
    first, count, file = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    lines = (json.dumps(describe(case_of(seed))) for seed in range(first, first + count))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
