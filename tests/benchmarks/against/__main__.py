"""Compare the working tree with another commit: ``python -m tests.benchmarks.against COMMIT``.

It prints one report in Markdown:

bits
    Hashes of coordinates, event times and impulses of all scenarios at reduced length and of random systems: which
    differ, in what, and which bodies, joints and laws of contacts that closed they have.  A run that fails on both
    sides with the same message is equal if what it computed until then is.  A system that a side did not finish in
    time is named and not compared.
speed
    Processor time of some scenes in two processes that live on, run in turn: ratios of single runs.
processes
    Compiling the engine with an empty cache, import and first run, the command line, memory.
source
    Files, lines of code (no blank, comment or docstring), public names by folder; numeric constants of the engine.

"This" is the working tree as it is when the command begins, uncommitted changes included.  "Other" is any revision
that git knows.  Both are copied into a temporary folder, which is removed at the end; each has its own cache there.
Both run with the interpreter and the installed dependencies of this command; the copy comes first on the path of its
processes, with entry points made from its own ``pyproject.toml``.  A commit that names other dependencies gets an
environment of its own, which pip fills.

Both sides run the same systems.  The working tree draws the random ones and writes them as data; the scenes are data in
``scenes``.  Each side builds them with its own adapter, ``tests/benchmarks/described``; a commit that has none gets
this side's.  The processes are started from this side's ``tests/benchmarks/against`` on either side.

``--quick`` makes fewer repetitions and runs fewer random systems.  It begins with copies of the user's cache: what is
compiled there of either side is not compiled again, nor is the time of compiling measured.

``--folder`` names a folder that is kept.  A second comparison finds what was compiled for either side there, and does
not measure how long it takes to compile.

Other programs on the machine lengthen all times.  Ratios suffer least, as both sides run in turn.  It needs Linux.
"""

from __future__ import annotations

import argparse

from tests.benchmarks.against.compare import FULL, QUICK, compare


def main() -> None:
    """Read the command line, compare, print."""
    words = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.against",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    words.add_argument("commit", help="the other commit: any revision that git knows")
    words.add_argument("--quick", action="store_true", help="in some two minutes in place of ten")
    words.add_argument("--systems", type=int, help=f"number of random systems [{FULL.systems}, quick {QUICK.systems}]")
    words.add_argument("--first", type=int, default=0, help="number of the first random system")
    words.add_argument("--folder", help="keep copies and caches in this folder")
    words.add_argument("--json", metavar="FILE", help="write the figures to this file, too")
    given = words.parse_args()
    for line in compare(given, QUICK if given.quick else FULL):
        print(line, flush=True)


if __name__ == "__main__":
    main()
