"""Passages of prose: docstrings, comments and messages of Python and C++, and the text of pages."""

from __future__ import annotations

import ast
import bisect
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from rules import CELL, DOCSTRING, TEXT


class Passage(NamedTuple):
    """Lines that are read together, the number of the first, and the kind of text."""

    line: int
    lines: list[str]
    kind: str = TEXT


def without_code(text: str) -> str:
    """Replace code in backticks and addresses by X."""
    return re.sub(r"https?://\S+", "X", re.sub(r"(`+)[^`]+\1", "X", text))


def paragraphs(text: str, line: int, last: int, kind: str = TEXT) -> Iterator[Passage]:
    """Split a docstring or message at empty lines; no passage begins after the line `last`."""
    lines = text.splitlines()
    first = None
    for i, content in enumerate([*lines, ""]):
        if content.strip() and first is None:
            first = i
        elif not content.strip() and first is not None:
            yield Passage(min(line + first, last), [each.strip() for each in lines[first:i]], kind)
            first, kind = None, TEXT


def _docstrings(nodes: list[ast.AST]) -> dict[int, str]:
    """Find docstrings: the identity of their nodes, and the kind of text."""
    kinds = {}
    for node in nodes:
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and node.body:
            first = node.body[0]
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                is_function = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
                is_property = is_function and any("property" in ast.unparse(d) for d in node.decorator_list)
                kinds[id(first.value)] = DOCSTRING if is_function and not is_property else TEXT
    return kinds


COMMENT_OR_STRING = re.compile(  # of Python
    r"(?P<quote>\"\"\"|'''|\"|')(?:\\.|(?!(?P=quote))[^\\])*(?P=quote)|#(?P<comment>[^\n]*)", re.DOTALL
)


def read_python(text: str) -> Iterator[Passage]:
    """Read docstrings, message strings of at least four words and comments of Python or a stub."""
    nodes = list(ast.walk(ast.parse(text)))
    docstrings = _docstrings(nodes)
    pieces = set()
    for node in nodes:  # an f-string comes before its pieces
        if isinstance(node, ast.JoinedStr):
            pieces.update(id(value) for value in node.values)
            content = "".join(v.value if isinstance(v, ast.Constant) else "X" for v in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in pieces:
            content = node.value
        else:
            continue
        kind = docstrings.get(id(node))
        if kind or content.count(" ") >= 3:
            yield from paragraphs(content, node.lineno, node.end_lineno or node.lineno, kind or TEXT)
    yield from join_comments(find_comments(text, COMMENT_OR_STRING))


HASH_OR_STRING = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'|(?:^|(?<=\s))#(?P<comment>[^\n]*)", re.MULTILINE)


def read_hash_comments(text: str) -> Iterator[Passage]:
    """Read comments of a shell script or of TOML."""
    yield from join_comments(find_comments(text, HASH_OR_STRING))


def find_comments(text: str, pattern: re.Pattern[str]) -> Iterator[tuple[int, bool, str]]:
    """Find comments after #: number of the line, True if nothing else is on the line, and text."""
    starts = line_starts(text)
    for match in pattern.finditer(text):
        if match["comment"] is not None and not match["comment"].startswith("!"):
            number = bisect.bisect_right(starts, match.start())
            is_alone = not text[starts[number - 1] : match.start()].strip()
            yield number, is_alone, match["comment"].lstrip("#: ")


def line_starts(text: str) -> list[int]:
    """Return the positions at which lines begin."""
    return [0, *(match.end() for match in re.finditer("\n", text))]


def join_comments(comments: Iterable[tuple[int, bool, str]]) -> Iterator[Passage]:
    """Join comments on successive lines of their own."""
    block: list[tuple[int, str]] = []
    for number, is_alone, content in comments:
        if block and not (is_alone and number == block[-1][0] + 1):
            yield Passage(block[0][0], [each for _, each in block])
            block = []
        block.append((number, content))
        if not is_alone:
            yield Passage(number, [content])
            block = []
    if block:
        yield Passage(block[0][0], [each for _, each in block])


CPP = re.compile(
    r'//(?P<comment>[^\n]*)|/\*(?P<block>.*?)\*/|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"'
    r"|(?P<string>\"(?:\\.|[^\"\\\n])*\"(?:\s*\"(?:\\.|[^\"\\\n])*\")*)|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'",
    re.DOTALL,
)


def read_cpp(text: str) -> Iterator[Passage]:
    """Read comments and string literals of at least five words of C++."""
    starts = line_starts(text)
    comments = []
    for match in CPP.finditer(text):
        number = bisect.bisect_right(starts, match.start())
        last = bisect.bisect_right(starts, match.end())
        if match["comment"] is not None:
            is_alone = not text[starts[number - 1] : match.start()].strip()
            comments.append((number, is_alone, match["comment"].lstrip("/< ").strip()))
        elif content := match["block"] or match["raw"]:
            yield from paragraphs(re.sub(r"(?m)^\s*\* ?", "", content), number, last)
        elif match["string"]:
            content = "".join(re.findall(r'"((?:\\.|[^"\\\n])*)"', match["string"]))
            if content.count(" ") >= 4:
                yield from paragraphs(content, number, last)
    yield from join_comments(comments)


def read_page(text: str) -> Iterator[Passage]:
    """Read paragraphs, list items, headings and cells of tables of a page, without code."""
    text = re.sub(r"<!--.*?-->", lambda match: re.sub(r"[^\n]", "", match[0]), text, flags=re.DOTALL)
    first, block, is_code = 0, [], False
    for number, line in enumerate([*text.splitlines(), ""], 1):
        content = re.sub(r"\]\([^)]*\)", "]", line).strip()
        is_fence = content.startswith(("```", "~~~"))
        is_row = content.startswith("|")
        is_start = re.match(r"[-*+] |\d+\. |#", content) is not None
        if block and (not content or is_fence or is_row or is_start):
            yield Passage(first, block)
            block = []
        is_code ^= is_fence
        if is_code or is_fence or not content:
            continue
        if is_row:
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", without_code(content).strip("|"))]
            has_number = any(re.match(r"[\d.,]+(?: |$|[x%])", cell) for cell in cells[1:])
            for i, cell in enumerate(cells):
                yield Passage(number, [cell], CELL if has_number and i == 0 else TEXT)
            continue
        if not block:
            first = number
        block.append(re.sub(r"^(?:[-*+] |\d+\. )", "", content))


READERS = {
    ".py": read_python,
    ".pyi": read_python,
    ".hpp": read_cpp,
    ".cpp": read_cpp,
    ".md": read_page,
    ".sh": read_hash_comments,
    ".toml": read_hash_comments,
}
