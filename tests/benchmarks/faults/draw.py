"""Faults to plant: a sign, a factor, an index or a comparison in a function of the engine, the bodies or the laws."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

AREAS = ("nonsmooth/engine", "bodies", "laws")
KINDS = ("sign", "factor", "index", "comparison")
_SIGNS: dict[type[ast.AST], str] = {ast.Add: "-", ast.Sub: "+"}
_COMPARISONS: dict[type[ast.AST], str] = {
    ast.Lt: ">=",
    ast.LtE: ">",
    ast.Gt: "<=",
    ast.GtE: "<",
    ast.Eq: "!=",
    ast.NotEq: "==",
}
_FACTOR = 1.5
"""Factor of a planted number: large enough to be wrong, small enough to look right."""


@dataclass(frozen=True)
class Fault:
    """One replaced piece of a line.

    Attributes
    ----------
    file : str
        Path in the tree.
    line, column : int
        Where the piece begins, line from 1, column from 0 in bytes of UTF-8.
    before, after : str
        The piece, and what replaces it.
    kind : str
        One of :data:`KINDS`.
    """

    file: str
    line: int
    column: int
    before: str
    after: str
    kind: str

    def plant(self, tree: Path) -> None:
        """Write the fault into the tree.

        Raises
        ------
        ValueError
            If the line has another piece at this place.
        """
        path = tree / self.file
        lines = path.read_bytes().splitlines(keepends=True)
        old, begin, end = lines[self.line - 1], self.column, self.column + len(self.before.encode())
        if old[begin:end] != self.before.encode():
            raise ValueError(f"{self.file}:{self.line} has {old[begin:end]!r} where {self.before!r} was drawn")
        lines[self.line - 1] = old[:begin] + self.after.encode() + old[end:]
        path.write_bytes(b"".join(lines))

    def __str__(self) -> str:
        return f"{self.file}:{self.line} {self.kind}: {self.before} -> {self.after}"


def draw(tree: Path, seed: int, count: int) -> list[Fault]:
    """Return faults of a seed, as many of each area; an area's kinds are drawn alike, then the places.

    Parameters
    ----------
    tree : Path
        Folder of the project.
    seed : int
        The same seed and tree give the same faults.
    count : int
        How many.
    """
    chance = random.Random(seed)
    places = {area: _places(tree, area) for area in AREAS}
    drawn: dict[Fault, None] = {}
    while len(drawn) < count:
        kinds = places[AREAS[len(drawn) % len(AREAS)]]
        drawn.setdefault(chance.choice(kinds[chance.choice(KINDS)]))
    return list(drawn)


def _places(tree: Path, area: str) -> dict[str, list[Fault]]:
    found: dict[str, list[Fault]] = {kind: [] for kind in KINDS}
    for path in sorted((tree / area).rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        for fault in _of_file(path.relative_to(tree).as_posix(), text):
            found[fault.kind].append(fault)
    return found


def _of_file(file: str, text: str) -> Iterator[Fault]:
    lines = text.encode().splitlines()
    for function in ast.walk(ast.parse(text)):
        if isinstance(function, ast.FunctionDef):
            for statement in function.body:
                for node in _computing(statement):
                    yield from _of_node(file, lines, node)


def _computing(statement: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a statement, without messages, annotations and functions inside, which are walked apart."""
    if isinstance(statement, ast.Raise | ast.JoinedStr | ast.FunctionDef | ast.Assert):
        return
    yield statement
    for name, field in ast.iter_fields(statement):
        for child in field if isinstance(field, list) else [field]:
            if name not in ("annotation", "returns") and isinstance(child, ast.AST):
                yield from _computing(child)


def _of_node(file: str, lines: list[bytes], node: ast.AST) -> Iterator[Fault]:
    if isinstance(node, ast.BinOp) and type(node.op) in _SIGNS:
        yield from _between(file, lines, node.left, node.right, _SIGNS[type(node.op)], "sign")
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield Fault(file, node.lineno, node.col_offset, "-", "+", "sign")
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _COMPARISONS:
        yield from _between(file, lines, node.left, node.comparators[0], _COMPARISONS[type(node.ops[0])], "comparison")
    elif isinstance(node, ast.Constant) and type(node.value) is float and node.value != 0.0:
        yield _number(file, lines, node, repr(_FACTOR * node.value), "factor")
    elif isinstance(node, ast.Subscript):
        for part in node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]:
            if isinstance(part, ast.Constant) and type(part.value) is int:
                yield _number(file, lines, part, str(abs(part.value - 1)), "index")


def _between(file: str, lines: list[bytes], left: ast.expr, right: ast.expr, after: str, kind: str) -> Iterator[Fault]:
    """Yield the fault of an operator between two operands of one line."""
    if left.end_lineno != right.lineno or left.end_col_offset is None:
        return
    gap = lines[right.lineno - 1][left.end_col_offset : right.col_offset]
    before = gap.strip(b" ()").decode()
    if before in ("+", "-", "<", "<=", ">", ">=", "==", "!="):
        column = left.end_col_offset + gap.index(before.encode())
        yield Fault(file, right.lineno, column, before, after, kind)


def _number(file: str, lines: list[bytes], node: ast.Constant, after: str, kind: str) -> Fault:
    before = lines[node.lineno - 1][node.col_offset : node.end_col_offset].decode()
    return Fault(file, node.lineno, node.col_offset, before, after, kind)
