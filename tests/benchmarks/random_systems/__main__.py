"""Random systems by the thousand, looked at by checks that share nothing with the engine.

    python -m tests.benchmarks.random_systems FIRST COUNT [--workers N --seconds S --out FOLDER --minimise K]

runs the systems of the numbers FIRST to FIRST + COUNT - 1 in N worker processes, each with S seconds.  The results go
to FOLDER/results.jsonl as they come; the same command goes on where it was interrupted.  At the end there is a table of
the ends by cause, FOLDER/table.md, and for each way to end badly up to K systems, made as small as they get, as
scripts that stand alone.

Refused counts, besides what is refused when it is built, a run that ends, with nothing wrong in what was computed, at
what its laws have no answer to, and says so by name: an impact of several contacts under a law of one, and a body that
is squeezed between driven ones.  Of the latter no run of rigid bodies can come to the end: two driven bodies come
nearer to each other along a line that both friction cones hold, so that the distance of two points of one rigid body
would have to shrink.  What such a pair of bodies does in nature is to break, or to give: a compliant law computes that.
"""

import sys

from tests.benchmarks.random_systems.campaign import main
from tests.benchmarks.random_systems.generate import case_of

if __name__ == "__main__":
    main(case_of, __doc__, sys.argv[1:])
