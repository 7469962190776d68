"""The commands: name, module and summary of each.

``nonsmooth --help`` imports only this table. The module of a command is imported when the command is used.
"""

from __future__ import annotations

from collections.abc import Mapping

COMMANDS: Mapping[str, tuple[str, str]] = {
    "list": ("show", "what is installed, plug-ins included"),
    "show": ("show", "parameters with units, defaults, ranges, and what is assumed"),
    "check": ("check", "check whether a component has the properties that it must have"),
    "run": ("run", "run a scenario"),
    "view": ("export", "play a run in the browser"),
    "export": ("export", "write a run for other programs"),
    "resume": ("run", "continue an interrupted run to the same end"),
    "save": ("export", "write a scenario to a file that `run` reads"),
    "figures": ("figures", "draw all figures of a scenario"),
    "sweep": ("study", "run a scenario over parameters"),
    "basin": ("study", "find which starts lead to which attractor"),
    "study": ("study", "show, continue, check or draw a stored study"),
    "orbit": ("orbit", "find a periodic orbit and its multipliers"),
    "continue": ("orbit", "follow a periodic orbit along a parameter"),
    "bifurcation": ("orbit", "sample a motion once a period for each value of a parameter"),
    "compile": ("compile", "compile the engine ahead of the first run"),
    "new": ("new", "write a package to start from"),
}
"""Name of a command -> its module in this package, and its summary in the help."""
