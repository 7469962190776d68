"""Count words and words a sentence of pages: ``python docs/count_words.py [--since COMMIT] [--flags] [PAGE ...]``.

Without pages: README.md and all of docs/pages. ``--since`` compares with a commit, ``--flags`` lists long sentences
and words that a plainer one replaces.

What counts
-----------
1. Left out: code between fences, lines indented by four blanks or more outside of lists, display formulas between
   ``$$``, comments, images, include lines (``--8<--``) and ``:::`` blocks of the reference.
2. A link counts as its text.  Inline code counts as one word, and so does an inline formula.
3. A word is a run of characters between blanks that has a letter or a digit.
4. *Words* of a page: all words of its headings, paragraphs, list items and table cells.
5. *Words a sentence*: only paragraphs and list items, as headings and cells are rarely sentences.  A sentence ends with
   ``.``, ``?`` or ``!`` before a blank, or with its paragraph, item or cell; not behind the abbreviations of
   ``_SHORT`` and initials.  A colon or semicolon does not end it.
6. *Long*: a sentence of more than 25 words, in cells too.
7. *Word*: a word that a plainer one replaces (``_TABLE``).  Words that also have their usual meaning (unit, wall, way,
   plain) are looked for in the forms that are private here; the rest by the word.
"""

from __future__ import annotations

import argparse
import re
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
LONGEST = 25
"""Words of the longest sentence that is not flagged."""
_SHORT = ("e.g", "i.e", "cf", "vs", "Fig", "Figs", "Eq", "Eqs", "vol", "pp", "Proc", "Soc", "Dyn", "approx", "ed")

_TABLE = {
    r"\bheaps?\b(?= of (?:floats|integers|the engine))|\btwo heaps\b|\bthe heap `": "workspace",
    r"\bcatalogue of contacts\b|\bslots?\b": "declared contacts, active contacts",
    r"\bpools?\b": "candidate features",
    r"\blistings?\b(?!`)": "neighbour list",
    r"\bcourses?\b": "body with its own step",
    r"\b(?:fly|flies|flew|flying|take[s]? off|lands?|landings?|in flight)\b": "ballistic motion; leaves, enters",
    r"\bleaps?\b": "jump of the contact point",
    r"\baveraged\b|\baverag(?:e|ing) (?:of|its|the) forces?\b|\bmean forces\b": "time-stepping fallback",
    r"\ba closing\b|\bclosings\b|\bclosing (?:of an accumulation|steps?)\b": "end of a Zeno sequence",
    r"\bcrowd(?:ed|s)?\b": "event accumulation",
    r"\bcan fall\b|\bfalls? of a gap\b": "bound of the gap's acceleration",
    r"\blevers?\b": "radius of the support",
    r"\bway left\b|\bshorter way\b|\bway out\b|\bway round\b": "distance, displacement bound",
    r"\bdoubtful\b|\bastray\b|\bbeyond\b": "ill-conditioned; not facing; distance past the boundary",
    r"\brubs?\b|\brubbed\b|\bbooked\b": "dissipated, accounted",
    r"\bmobility\b": "effective inverse mass",
    r"\btold\b|\btells?\b|\bsaid\b|\bsays?\b|\basked\b|\basks?\b": "arguments, messages, request; states, needs",
    r"\bpatience\b": "work budget",
    r"\bblamed?\b|\bculprits?\b": "failing function",
    r"\bcertificates?\b": "residual check",
    r"(?-i:\b(?:Strobe|Crossing|Ribbon|Corner|Margins|Target)\b)": "the names of writing.md",
    r"\bwhole numbers?\b|\bthe whole\b": "integer, all",
    r"\btwins?\b|\bspent\b|\bwary\b": "the field's word",
    r"\bnought\b|\bexplained\b|\bexplains?\b": "within a named tolerance",
    r"\bnext to none\b|\bare none\b|\bis none\b|\bneither\b": "say what a thing is",
}
_PATTERNS = {re.compile(pattern, re.IGNORECASE): better for pattern, better in _TABLE.items()}


def prose(text: str) -> list[tuple[int, str, str]]:
    """Return (line, kind, text) of every heading, paragraph, item and cell; kind is "heading", "prose" or "cell"."""
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    found: list[tuple[int, str, str]] = []
    held: list[str] = []
    began = 0
    fenced = formula = in_list = block = False

    def flush() -> None:
        if held:
            found.append((began, "prose", " ".join(held)))
            held.clear()

    for number, line in enumerate(text.splitlines(), 1):
        bare = line.strip()
        if re.match(r"(```|~~~)", bare):
            flush()
            fenced = not fenced
            continue
        if fenced:
            continue
        if bare.startswith("$$") or formula:
            flush()
            formula ^= bare.count("$$") % 2 == 1
            continue
        if not bare:
            flush()
            block = False
            continue
        if bare.startswith(("--8<--", ":::")) or block:
            flush()
            block = block or bare.startswith(":::")
            continue
        item = re.match(r"\s*([-*+]|\d+\.)\s+", line)
        if line.startswith("    ") and not in_list:
            flush()
            continue
        if bare.startswith("|"):
            flush()
            if not re.fullmatch(r"[|\s:-]+", bare):
                cells = re.split(r"(?<!\\)\|", bare.strip("|"))
                found.extend((number, "cell", cell.strip()) for cell in cells if cell.strip())
            continue
        if bare.startswith("#"):
            flush()
            in_list = False
            found.append((number, "heading", bare.lstrip("# ")))
            continue
        if item:
            flush()
            in_list = True
            began = number
            held.append(line[item.end() :])
            continue
        if not held:
            in_list = in_list and line.startswith("  ")
            began = number
        held.append(bare.lstrip("> "))
    flush()
    return [(number, kind, plain(words)) for number, kind, words in found if plain(words)]


def plain(text: str) -> str:
    """Return the text without Markdown: links as their text, code and formulas as one word."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"``[^`]+``|`[^`]*`", "CODE", text)
    text = re.sub(r"\$[^$]+\$", "FORMULA", text)
    return re.sub(r"[*_]{1,2}(\S.*?)[*_]{1,2}", r"\1", text).strip()


def words(text: str) -> list[str]:
    """Return the words of a text."""
    return [word for word in text.split() if any(character.isalnum() for character in word)]


def sentences(text: str) -> list[str]:
    """Return the sentences of a paragraph, item or cell that have a word."""
    parts, last = [], 0
    for end in re.finditer(r"[.?!][)\"']*(?=\s|$)", text):
        before = text[last : end.start()].split()
        word = before[-1].strip("(") if before else ""
        initial = re.fullmatch(r"[A-Z]", word) and end.end() < len(text)
        if end.group()[0] == "." and (word in _SHORT or initial):
            continue
        parts.append(text[last : end.end()])
        last = end.end()
    parts.append(text[last:])
    return [part.strip() for part in parts if words(part)]


class Count(NamedTuple):
    """Words of a page, those in its sentences, its sentences, and its flags."""

    words: int
    inside: int
    sentences: int
    flags: tuple[str, ...]

    @property
    def cells(self) -> list[str]:
        """Words, words a sentence, long sentences, words to replace."""
        long = sum(" long (" in flag for flag in self.flags)
        average = f"{self.inside / max(self.sentences, 1):.1f}"
        return [str(self.words), average, str(long), str(len(self.flags) - long)]


def count(name: str, text: str) -> Count:
    """Return the counts of a page."""
    total = inside = n_sentences = 0
    flags: list[str] = []
    for number, kind, part in prose(text):
        total += len(words(part))
        for sentence in sentences(part):
            n = len(words(sentence))
            if kind == "prose":
                inside, n_sentences = inside + n, n_sentences + 1
            if n > LONGEST and kind != "heading":
                flags.append(f"{name}:{number}: long ({n}): {sentence[:90]}")
        for pattern, better in _PATTERNS.items():
            flags.extend(f"{name}:{number}: word: {m.group()!r} -> {better}" for m in pattern.finditer(part))
    return Count(total, inside, n_sentences, tuple(flags))


def together(counts: Iterable[Count]) -> Count:
    """Return the counts of several pages as one."""
    rows = list(counts)
    flags = tuple(flag for row in rows for flag in row.flags)
    return Count(sum(row.words for row in rows), sum(r.inside for r in rows), sum(r.sentences for r in rows), flags)


def committed(commit: str, name: str) -> str:
    """Return the text of a page at a commit; "" if it had none."""
    found = subprocess.run(["git", "show", f"{commit}:{name}"], cwd=ROOT, capture_output=True, text=True, check=False)
    return found.stdout


def main() -> None:
    """Print a table with a row a page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--since", metavar="COMMIT", help="compare with a commit")
    parser.add_argument("--flags", action="store_true", help="list long sentences and words to replace")
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE")
    given = parser.parse_args()
    pages = given.pages or [ROOT / "README.md", *sorted((ROOT / "docs/pages").rglob("*.md"))]
    names = [path.resolve().relative_to(ROOT).as_posix() for path in pages]
    after = [count(name, path.read_text(encoding="utf-8")) for name, path in zip(names, pages, strict=True)]
    before = [count(name, committed(given.since, name)) for name in names] if given.since else after
    print("| page | words | words a sentence | long sentences | words to replace |\n|---|---|---|---|---|")
    for name, old, new in zip(
        [*names, "together"], [*before, together(before)], [*after, together(after)], strict=True
    ):
        pairs = zip(old.cells, new.cells, strict=True)
        print(f"| {name} | " + " | ".join(f"{a} -> {b}" if given.since else b for a, b in pairs) + " |")
    if given.flags:
        print(*together(after).flags, sep="\n")


if __name__ == "__main__":
    main()
