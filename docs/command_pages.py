"""Make the reference of the command line: every command with its options and an example."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

from parameter_tables import markdown

from nonsmooth.cli.commands import COMMANDS
from nonsmooth.cli.parse.options import Command, CommandGroup, Option

EXAMPLES = {
    "compile": "nonsmooth compile",
    "list": "nonsmooth list bodies",
    "show": "nonsmooth show dumbbell",
    "check": "nonsmooth check coulomb --set friction=0.3",
    "run": "nonsmooth run dumbbell --set mode=drift --out results",
    "view": "nonsmooth view dumbbell --set mode=flutter",
    "export": "nonsmooth export dumbbell drift.webp --speed 0.2 --view corner",
    "resume": "nonsmooth resume results",
    "save": "nonsmooth save dumbbell dumbbell.toml",
    "figures": "nonsmooth figures tippe_top --out figures",
    "sweep": "nonsmooth sweep dumbbell --over friction=0.1:0.4:13 --set t_end=2 --out friction.zarr",
    "basin": "nonsmooth basin dumbbell --over beta0=0:0.4:40 --over phase=0:6:40 --set mode=free --out basin.zarr",
    "study status": "nonsmooth study status basin.zarr",
    "study resume": "nonsmooth study resume basin.zarr",
    "study verify": "nonsmooth study verify basin.zarr",
    "study draw": "nonsmooth study draw basin.zarr",
    "orbit": "nonsmooth orbit dumbbell --set mode=drift --period 0.04 --settle 1 --within z,ry,vy,vz,wy",
    "continue": "nonsmooth continue bouncing_ball --set start_phase=1.1 --set speed=0.19 --period 0.04 --within z,vz "
    "--over gamma=0.3:1.2 --out branch",
    "bifurcation": "nonsmooth bifurcation bouncing_ball --set start_phase=1 --set speed=0.25 "
    "--over gamma=0.5:2.2:200 --period 0.04 --at 0.02 --show vz --out diagram",
    "new plugin": "nonsmooth new plugin felt",
}
"""A request for each command and subcommand."""
_HEAD = ("option", "value", "default", "meaning")


def commands() -> Iterator[tuple[str, str, Command]]:
    """Yield name, summary and options of each command, and of the subcommands of a group."""
    for name, (module, text) in COMMANDS.items():
        found: Command | CommandGroup = import_module(f"nonsmooth.cli.commands.{module}").COMMANDS[name]
        if isinstance(found, Command):
            yield name, text, found
        else:
            for part, command in found.parts.items():
                yield f"{name} {part}", command.text, command


def command_page() -> str:
    """Markdown of all commands, a section each."""
    return "\n\n".join(_section(name, text, command) for name, text, command in commands()) + "\n"


def _section(name: str, text: str, command: Command) -> str:
    summary = f"{text[:1].upper()}{text[1:]}."
    example = f"```bash\n{EXAMPLES[name]}\n```"
    table = markdown([_HEAD, *map(_row, command.options)]) if command.options else "This command has no options."
    for option in command.options:
        table = table.replace(f"\n| {option.name} |", f"\n| `{option.name}` |")
    return "\n\n".join([f"## {name}", summary, example, table])


def _row(option: Option) -> tuple[str, ...]:
    if option.choices:
        value = "one of " + ", ".join(option.choices)
    elif option.kind is None:
        value = "no value"
    else:
        value = option.metavar or option.place.upper()
    if option.repeats:
        value += ", repeatable"
    if option.is_required or not (option.name.startswith("-") or option.choices):
        default = "required"
    elif option.kind is None or option.default is None:
        default = ""
    else:
        default = f"{option.default:g}" if isinstance(option.default, float) else str(option.default)
    return option.name, value, default, option.text
