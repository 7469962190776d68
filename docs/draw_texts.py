"""Draw texts at random, to judge whether a reader understands each at first reading.

    python docs/draw_texts.py --seed 1 --count 30 --since COMMIT nonsmooth bodies laws scenarios
    python docs/draw_texts.py --seed 1 --count 30 README.md docs/pages nonsmooth

Texts are docstrings, comments and notes of constants in Python files, and paragraphs, list items and rows of tables in
pages.  With ``--since`` only those count of which a line changed after the commit.  The same seed draws the same texts.
With ``--context N`` each text is printed in its place, with N lines before and behind it.
"""

from __future__ import annotations

import argparse
import ast
import io
import random
import re
import subprocess
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_DIRECTIVE = re.compile(r"# (type|noqa|fmt|pragma|mypy|ruff)")
_CODE = re.compile(
    r"^```.*?^```|^ {4}.*?$|^--8<--.*?$|^:::.*?$|^!\[.*?$|^<.*?$|^\|[-| :]+\|$", re.MULTILINE | re.DOTALL
)
"""Parts of a page without prose: code, commands, included files, pictures, HTML, rulers of tables."""


class Text(NamedTuple):
    """A text with the lines that it has in its file, from 1, and the line of code to which it belongs."""

    path: str
    lines: range
    owner: str
    words: str


def changed_lines(commit: str) -> dict[str, set[int]]:
    """Numbers of the lines that differ from a commit, from 1, by file."""
    command = ["git", "diff", "--unified=0", "--find-renames=40%", commit]
    changed: dict[str, set[int]] = {}
    name, line = "", 0
    for row in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        if row.startswith("+++ "):
            name = row.removeprefix("+++ b/")
        elif match := re.match(r"@@ .*?\+(\d+)", row):
            line = int(match[1])
        elif row.startswith("+"):
            changed.setdefault(name, set()).add(line)
            line += 1
    return changed


def texts_of_code(path: str, source: str) -> Iterator[Text]:
    """Docstrings, notes of constants and comments of a Python file."""
    rows = source.splitlines()
    for node in ast.walk(ast.parse(source)):
        body = getattr(node, "body", None)
        if not isinstance(body, list):
            continue
        for number, child in enumerate(body):
            if isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant) and type(child.value.value) is str:
                owner = body[number - 1] if number else node
                line = getattr(owner, "lineno", 0)
                lines = range(child.lineno, (child.end_lineno or child.lineno) + 1)
                yield Text(path, lines, rows[line - 1].strip() if line else "the module", child.value.value)
    block: list[tokenize.TokenInfo] = []
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type != tokenize.COMMENT or _DIRECTIVE.match(token.string):
            continue
        if block and token.start != (block[-1].start[0] + 1, block[-1].start[1]):
            yield _comment(path, rows, block)
            block = []
        block.append(token)
    if block:
        yield _comment(path, rows, block)


def _comment(path: str, rows: list[str], block: list[tokenize.TokenInfo]) -> Text:
    """Comment of several lines, which belongs to the line of code after it."""
    first, last = block[0].start[0], block[-1].start[0]
    return Text(
        path, range(first, last + 1), rows[min(last, len(rows) - 1)].strip(), "\n".join(t.string for t in block)
    )


def texts_of_page(path: str, source: str) -> Iterator[Text]:
    """Paragraphs, list items and rows of tables of a page, each with the heading above it."""
    plain = _CODE.sub(lambda match: "\n" * match[0].count("\n"), source)
    heading = ""
    for match in re.finditer(r"(?:^(?!\s*$).+\n?)+", plain, re.MULTILINE):
        first = plain.count("\n", 0, match.start()) + 1
        rows = match[0].splitlines()
        if rows[0].startswith("#"):
            heading = rows.pop(0)
            first += 1
        is_list = bool(rows) and rows[0].lstrip().startswith(("|", "- ", "* ", "1. "))
        for number, row in enumerate(rows if is_list else ["\n".join(rows)] if rows else []):
            start = first + number
            yield Text(path, range(start, start + row.count("\n") + 1), heading, row)


def draw(names: list[str], since: str, seed: int, count: int) -> list[Text]:
    """Draw ``count`` texts of the files and folders ``names``."""
    tracked = subprocess.run(["git", "ls-files", *names], capture_output=True, text=True, check=True).stdout.split()
    changed = changed_lines(since) if since else None
    found: list[Text] = []
    for path in tracked:
        if path.endswith((".py", ".md")):
            texts = texts_of_code if path.endswith(".py") else texts_of_page
            found += texts(path, Path(path).read_text("utf-8"))
    if changed is not None:
        found = [text for text in found if not changed.get(text.path, set()).isdisjoint(text.lines)]
    return random.Random(seed).sample(found, min(count, len(found)))


def main() -> None:
    """Print the drawn texts, numbered, with file, line and owner."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+", help="files and folders")
    parser.add_argument("--since", default="", metavar="COMMIT", help="only texts that changed after this commit")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--context", type=int, default=0, metavar="N", help="lines to print before and behind a text")
    given = parser.parse_args()
    for number, text in enumerate(draw(given.names, given.since, given.seed, given.count), 1):
        print(f"[{number}] {text.path}:{text.lines.start}\n    of: {text.owner}\n{text.words}\n")
        if given.context:
            rows = Path(text.path).read_text("utf-8").splitlines()
            before, behind = max(0, text.lines.start - 1 - given.context), text.lines.stop - 1 + given.context
            print("    in its place:", *rows[before:behind], "", sep="\n    | ")


if __name__ == "__main__":
    main()
