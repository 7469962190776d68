"""Random systems by the thousand, looked at by checks that share nothing with the engine.

    python -m tests.benchmarks.random_systems FIRST COUNT [--family NAME --workers N --seconds S --out FOLDER]

runs the systems of the numbers FIRST to FIRST + COUNT - 1 in N worker processes, each with S seconds.  Two of three
systems tumble, one is of a family whose bodies are flush.  With --family all are of one family, and with --family flush
of any family of flush bodies.  The results go to FOLDER/results.jsonl as they come; the same command goes on where it
was interrupted.  At the end there are tables of the ends and of their causes by family, FOLDER/table.md, and for each
way to end badly up to K systems (--minimise K), made as small as they get, as scripts that stand alone.

Refused counts, besides what is refused when it is built, a run that ends, with nothing wrong in what was computed, at
what its laws have no answer to, and says so by name: an impact of several contacts under a law of one, and a body that
is squeezed between driven ones.  Of the latter no run of rigid bodies can come to the end: two driven bodies come
nearer to each other along a line that both friction cones hold, so that the distance of two points of one rigid body
would have to shrink.  What such a pair of bodies does in nature is to break, or to give: a compliant law computes that.
"""

import functools

from tests.benchmarks.random_systems.campaign import Draws, campaign, parser_of
from tests.benchmarks.random_systems.generate import (
    FAMILIES,
    case_of,
    family_of,
    flush_case_of,
    flush_family_of,
)

FLUSH = "flush"
"""Name of all flush families together."""


def main() -> None:
    """Run a campaign as the command line says."""
    parser = parser_of(__doc__)
    parser.add_argument("--family", choices=(*FAMILIES, FLUSH), help="of which family all systems are")
    given = parser.parse_args()
    if given.family is None:
        campaign(Draws(case_of, family_of), given)
    elif given.family == FLUSH:
        campaign(Draws(flush_case_of, flush_family_of), given)
    else:
        campaign(Draws(functools.partial(case_of, family=given.family), lambda seed: str(given.family)), given)


if __name__ == "__main__":
    main()
