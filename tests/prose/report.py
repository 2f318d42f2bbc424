"""Check docstrings, comments, messages and pages for wording that readers must read twice.

``.venv/bin/python tests/prose`` lists the hits of each folder and page with more than 1.5 hits per 1,000
words, and fails if there are any, if Python says "is no X", or if names.py finds a name; ``--table`` prints
words and rate of every folder and page; ``--list [PATH ...]`` prints every hit. The rules are in rules.py,
each with a hint and two examples that a test checks.
"""

from __future__ import annotations

import argparse
import bisect
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import names
from passages import READERS, Passage, without_code
from rules import RULES, Rule

ROOT = Path(__file__).parents[2]
LIMIT = 1.5  # hits per 1,000 words
SOURCES = (
    "addon",
    "cpp",
    "data",
    "docs",
    "examples",
    "tests",
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
)
SKIPPED = {
    "leaflet",
    "three",
    "out",
    "__pycache__",
    "prose",
    "test_prose.py",
}  # foreign text, examples of the rules


class Hit(NamedTuple):
    """A rule that a line breaks."""

    path: str
    line: int
    words: str
    rule: Rule


def find_files(paths: Iterable[str]) -> list[Path]:
    """Find every file below the paths that has a reader."""
    files = set()
    for path in (ROOT / name for name in paths):
        for each in path.rglob("*") if path.is_dir() else [path]:
            if each.suffix in READERS and not SKIPPED & set(each.relative_to(ROOT).parts):
                files.add(each)
    return sorted(files)


def check_passage(passage: Passage) -> Iterator[tuple[int, str, Rule]]:
    """Find the line and words of each hit."""
    text, starts = "", []
    for line in passage.lines:
        starts.append(len(text))
        text += line + " "
    text = re.sub(r"(`+)([^`]+)\1", lambda match: "X" + " " * (len(match[0]) - 1), text)  # keeps positions
    for rule in RULES:
        if passage.kind in rule.kinds:
            for match in rule.pattern.finditer(text):
                around = text[max(0, match.start() - 30) : match.end() + 40]
                yield passage.line + bisect.bisect_right(starts, match.start()) - 1, around, rule


def count(paths: Iterable[str] = SOURCES) -> tuple[dict[str, int], list[Hit]]:
    """Count the words of each folder (two levels) and page, and find their hits."""
    words: dict[str, int] = defaultdict(int)
    hits = []
    for path in find_files(paths):
        name = path.relative_to(ROOT).as_posix()
        for passage in READERS[path.suffix](path.read_text(encoding="utf-8")):
            words[place(name)] += sum(len(without_code(line).split()) for line in passage.lines)
            hits += [Hit(name, line, around, rule) for line, around, rule in check_passage(passage)]
    return words, hits


def place(name: str) -> str:
    """Return the folder of a source file, at most two levels deep; a page is its own."""
    return name if name.endswith(".md") else "/".join(name.split("/")[:-1][:2]) or name


def show(hits: Iterable[Hit]) -> None:
    """Print hits by rule, after the hint of the rule."""
    by_rule = defaultdict(list)
    for hit in hits:
        by_rule[hit.rule].append(hit)
    for rule, broken in by_rule.items():
        print(f"{rule.name}; write {rule.instead}")
        for hit in sorted(broken):
            print(f"  {hit.path}:{hit.line}: {' '.join(hit.words.split())}")


def main() -> int:
    """Print the table or the hits; return 1 if a place is over the limit."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("paths", nargs="*", default=SOURCES)
    parser.add_argument("--table", action="store_true", help="print words and rate of every folder and page")
    parser.add_argument("--list", action="store_true", help="print every hit")
    arguments = parser.parse_args()
    words, hits = count(arguments.paths)
    by_place: dict[str, list[Hit]] = defaultdict(list)
    for hit in hits:
        by_place[place(hit.path)].append(hit)
    rates = {name: 1000 * len(by_place[name]) / max(number, 1) for name, number in words.items()}
    if arguments.table:
        print(f"{'folder or page':32} {'rate':>6} {'hits':>6} {'words':>8}")
        for name in sorted(rates, key=lambda name: -rates[name]):
            print(f"{name:32} {rates[name]:6.1f} {len(by_place[name]):6} {words[name]:8}")
        total = sum(words.values())
        print(f"{'all':32} {1000 * len(hits) / max(total, 1):6.1f} {len(hits):6} {total:8}")
        return 0
    if arguments.list:
        show(hits)
        return 0
    over = {name: rate for name, rate in rates.items() if rate > LIMIT}
    strict = [hit for hit in hits if hit.rule.is_strict and hit.path.endswith(".py")]
    show({*strict, *(hit for name in over for hit in by_place[name])})
    messages = [f"{name}: {rate:.1f} hits per 1,000 words, at most {LIMIT}" for name, rate in over.items()]
    messages += [
        f"{name.path}:{name.line}: {name.name}, for {name.lines} lines; write what the object is"
        for name in names.collect(ROOT)
    ]
    messages += [f"{len(strict)} hits of a rule that Python may not break"] * bool(strict)
    print(*messages, sep="\n", end="\n" * bool(messages), file=sys.stderr)
    return int(bool(messages))
