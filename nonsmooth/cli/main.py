"""``nonsmooth``: reads the request, hands it to a command, turns errors into lines and exit statuses."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Sequence
from importlib.metadata import version

from nonsmooth.cli.commands import (
    basin,
    bifurcation,
    check,
    export,
    figures,
    list,
    new,
    orbit,
    resume,
    run,
    save,
    show,
    study,
    sweep,
    view,
)
from nonsmooth.cli.telling.messages import complain, warn_plainly
from nonsmooth.errors import InvalidInput, MissingPackagesError, NonsmoothError, NonsmoothWarning

DONE, FAILED, WRONG_REQUEST = 0, 1, 2
"""Exit statuses."""

_COMMANDS = (list, show, check, run, view, export, resume, save, figures, sweep, basin, study, orbit, bifurcation, new)


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = argparse.ArgumentParser(
        prog="nonsmooth",
        description="Event-driven multibody dynamics with friction and energetic multiple impacts.",
        epilog="Exit status: 0 done, 1 the run failed or was interrupted (what was computed is kept), or a property "
        "does not hold, 2 the request was wrong.",
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"nonsmooth {version('nonsmooth')}")
    commands = top.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for command in _COMMANDS:
        command.add_to(commands)
    return top


def main(words: Sequence[str] | None = None) -> int:
    """Run one command; return the exit status.

    Parameters
    ----------
    words : sequence of str, optional
        The words after the program's name; those of the process by default.
    """
    arguments = parser().parse_args(words)
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
