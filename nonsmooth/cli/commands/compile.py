"""``nonsmooth compile``: compiles the engine now, so that the first run on this machine need not compile it."""

from __future__ import annotations

import argparse

from nonsmooth.cli.parse.options import Command
from nonsmooth.cli.report.messages import say
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.native.code_files import read
from nonsmooth.engine.native.folders import folders
from nonsmooth.engine.native.kernel import PLAIN


def _compile(arguments: argparse.Namespace) -> bool:
    """Compile and load all functions of the engine that are not on disk; print how many, and where they are kept."""
    if PLAIN:
        say("nothing to compile: NONSMOOTH_PLAIN=1 runs the engine in Python")
        return True
    # the machine code is only there if the engine is compiled
    from nonsmooth.engine.native.machine_code import entry_addresses

    missing = sum(read(name) is None for name in ENTRY_POINTS)
    entry_addresses()
    place = folders()[1]
    done = f"{missing} functions compiled" if missing else f"all {len(ENTRY_POINTS)} functions were compiled already"
    say(f"the engine is ready: {done}; they are kept in {place}" if place else f"{done}, but could not be kept")
    return place is not None


COMMANDS = {"compile": Command(_compile, ())}
