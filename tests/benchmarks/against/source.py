"""Size of a source tree, read from its text alone: nothing is imported."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FOLDERS = ("nonsmooth", "bodies", "laws", "scenarios", "tests")
_ENGINE = Path("nonsmooth/engine")


@dataclass(frozen=True)
class Size:
    """Files, lines of code, and public names at the level of modules."""

    files: int = 0
    lines: int = 0
    names: int = 0

    def __add__(self, other: Size) -> Size:
        return Size(self.files + other.files, self.lines + other.lines, self.names + other.names)


def lines_of_code(text: str) -> int:
    """Return how many lines hold code: no blank, no comment, no docstring, no string that stands by itself."""
    lines = enumerate(text.split("\n"), 1)
    rows = {number for number, line in lines if line.strip() and not line.lstrip().startswith("#")}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            rows.difference_update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return len(rows)


def public_names(text: str) -> set[str]:
    """Return the public names of classes, functions and values that a module defines."""
    found: set[str] = set()
    for node in ast.parse(text).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            found.add(node.name)
        else:
            found.update(name for name, _ in _assigned(node))
    return {name for name in found if not name.startswith("_")}


def numeric_constants(text: str) -> set[str]:
    """Return the names of values of a module that are a number, or computed from numbers and other such names."""
    found = (row for node in ast.parse(text).body for row in _assigned(node))
    return {name for name, value in found if value is not None and _is_numeric(value)}


def sizes(tree: Path) -> dict[str, Size]:
    """Return the sizes of the folders of a tree, and of the folders in the package, by their paths."""
    rows: dict[str, Size] = {}
    for path in _modules(tree, FOLDERS):
        size = _size(path.read_text(encoding="utf-8"))
        for key in _keys(path.relative_to(tree)):
            rows[key] = rows.get(key, Size()) + size
    return rows


def engine_constants(tree: Path) -> int:
    """Return how many named numeric constants the modules of the engine have."""
    texts = (path.read_text(encoding="utf-8") for path in _modules(tree, (_ENGINE.as_posix(),)))
    return sum(len(numeric_constants(text)) for text in texts)


def table(this: dict[str, Size], other: dict[str, Size]) -> Iterator[str]:
    """Yield the lines of the table in Markdown: the folders, and those of the package that differ."""
    yield "| folder | files | lines of code | public names |"
    yield "|---|---|---|---|"
    for key in sorted({*this, *other}):
        a, b = this.get(key, Size()), other.get(key, Size())
        if "/" not in key or a != b:
            cells = (change(getattr(b, name), getattr(a, name)) for name in ("files", "lines", "names"))
            yield f"| {key} | {' | '.join(cells)} |"


def change(other: int, this: int) -> str:
    """Return a count of both sides, once if it is the same."""
    return str(this) if this == other else f"{other} → {this} ({this - other:+d})"


@functools.cache
def _size(text: str) -> Size:
    # most modules are the same on both sides
    return Size(1, lines_of_code(text), len(public_names(text)))


def _keys(path: Path) -> list[str]:
    """Return the rows of the table to which a module belongs."""
    whole, *rest = path.parts
    if whole != FOLDERS[0]:
        return [whole]
    return [whole, f"{whole}/{rest[0] if len(rest) > 1 else '*.py'}"]


def _modules(tree: Path, folders: tuple[str, ...]) -> Iterator[Path]:
    for folder in folders:
        yield from sorted((tree / folder).rglob("*.py"))


def _assigned(node: ast.stmt) -> Iterator[tuple[str, ast.expr | None]]:
    """Yield the names that a statement gives values, and the value."""
    if isinstance(node, ast.Assign):
        for target in node.targets:
            yield from ((one.id, node.value) for one in [target] if isinstance(one, ast.Name))
            if isinstance(target, ast.Tuple):
                values = node.value.elts if isinstance(node.value, ast.Tuple) else [None] * len(target.elts)
                pairs = zip(target.elts, values, strict=False)
                yield from ((one.id, value) for one, value in pairs if isinstance(one, ast.Name))
    elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        yield node.target.id, node.value


def _is_numeric(value: ast.expr) -> bool:
    """Tell whether an expression consists of numbers, names and operators, with a number among them."""
    nodes = list(ast.walk(value))
    known = (ast.Constant, ast.Name, ast.Attribute, ast.UnaryOp, ast.BinOp, ast.operator, ast.unaryop, ast.expr_context)
    numbers = [node.value for node in nodes if isinstance(node, ast.Constant)]
    plain = all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in numbers)
    return bool(numbers) and plain and all(isinstance(node, known) for node in nodes)
