"""``--trust``: whether a file or folder may name code that is not an installed plug-in."""

from __future__ import annotations

import argparse

HELP = (
    "load the Python files and functions that the file or folder names; without it only names of installed plug-ins "
    "are taken, so that nothing of another person's file runs"
)


def add_to(command: argparse.ArgumentParser) -> None:
    """Add the option to the parser of a command."""
    command.add_argument("--trust", action="store_true", help=HELP)
