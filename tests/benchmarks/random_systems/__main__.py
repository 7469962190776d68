"""Random systems by the thousand, looked at by checks that share nothing with the engine.

    python -m tests.benchmarks.random_systems FIRST COUNT [--workers N --seconds S --out FOLDER --minimise K]

runs the systems of the numbers FIRST to FIRST + COUNT - 1 in N worker processes, each with S seconds.  The results go
to FOLDER/results.jsonl as they come; the same command goes on where it was interrupted.  At the end there is a table of
the ends by cause, FOLDER/table.md, and for each way to end badly up to K systems, made as small as they get, as
scripts that stand alone.
"""

import sys

from tests.benchmarks.random_systems.campaign import main
from tests.benchmarks.random_systems.generate import case_of

if __name__ == "__main__":
    main(case_of, __doc__, sys.argv[1:])
