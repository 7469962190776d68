"""``nonsmooth``: parses a request, executes its command, turns errors into lines and exit statuses."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from nonsmooth.cli.commands import COMMANDS
from nonsmooth.cli.report.messages import complain, discard_output, warn_plainly
from nonsmooth.errors import InvalidInput, MissingPackagesError, NonsmoothError, NonsmoothWarning, UnknownName

DONE, FAILED, WRONG_REQUEST = 0, 1, 2
"""Exit statuses: the command succeeded, the command failed, and the arguments are wrong, respectively."""


class _Version(argparse.Action):
    """Action of ``--version``: prints the installed version. Only this action reads the metadata of packages."""

    def __call__(self, parser: argparse.ArgumentParser, *given: Any) -> None:
        from importlib.metadata import version

        print(f"nonsmooth {version('nonsmooth')}")
        parser.exit()


def _command(words: Sequence[str]) -> str:
    """Name of the command in a request; "" if it has none."""
    return next((word for word in words if not word.startswith("-")), "")


def parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser of all commands. Only the command that the request names gets its options."""
    top = argparse.ArgumentParser(
        prog="nonsmooth",
        description="Event-driven multibody dynamics with friction and energetic multiple impacts.",
        epilog="Exit status: 0 done, 1 the run failed or was interrupted (what was computed is kept), or a property "
        "does not hold, 2 the request was wrong.",
        allow_abbrev=False,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = top.add_subparsers(title="commands", required=True, metavar="COMMAND")
    named = _command(words)
    for name, (module, text) in COMMANDS.items():
        command = commands.add_parser(name, help=text, allow_abbrev=False)
        if name == named:
            import_module(f"nonsmooth.cli.commands.{module}").COMMANDS[name].fill(command)
    return top


def main(words: Sequence[str] | None = None) -> int:
    """Execute one command; return the exit status: 0 after success, 1 after a failure, 2 if the arguments are wrong.

    Parameters
    ----------
    words : sequence of str, optional
        Arguments after the program's name; by default ``sys.argv[1:]``.
    """
    try:
        try:
            return _execute(sys.argv[1:] if words is None else words)
        finally:
            if sys.stdout is not None:
                # flush here, so that a closed pipe raises its error in this block: argparse does not flush its help
                sys.stdout.flush()
    except BrokenPipeError:
        # the reader has closed the pipe because it needs no more lines, as `head` does
        discard_output()
        return DONE


def _execute(words: Sequence[str]) -> int:
    """Execute one command; return the exit status of :func:`main`. Errors become lines on standard error."""
    named = _command(words)
    if named and named not in COMMANDS:
        complain(str(UnknownName("command", named, COMMANDS)))
        return WRONG_REQUEST
    arguments, unknown = parser(words).parse_known_args(words)
    if unknown:
        arguments.refuse(arguments, unknown[0])
    with warnings.catch_warnings():
        warnings.simplefilter("always", NonsmoothWarning)
        warnings.showwarning = warn_plainly(warnings.showwarning)
        try:
            return DONE if arguments.execute(arguments) else FAILED
        except (InvalidInput, MissingPackagesError) as error:
            complain(" ".join(str(error).split()))
            return WRONG_REQUEST
        except NonsmoothError as error:
            complain(str(error))
            return FAILED
        except KeyboardInterrupt:
            complain("interrupted")
            return FAILED
