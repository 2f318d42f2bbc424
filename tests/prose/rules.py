"""Rules of wording: patterns, each with a hint and two examples that test_prose.py checks."""

from __future__ import annotations

import re
from typing import NamedTuple

DOCSTRING, TEXT, CELL = "docstring of a function", "text", "cell of a table of numbers"


class Rule(NamedTuple):
    """A pattern, what to write instead, a sentence that it hits and one that it leaves."""

    name: str
    pattern: re.Pattern[str]
    instead: str
    hit: str
    leave: str
    kinds: tuple[str, ...] = (DOCSTRING, TEXT, CELL)

    @property
    def is_strict(self) -> bool:
        """True if Python may not have a single hit."""
        return "no X" in self.name


def _rule(name: str, pattern: str, instead: str, hit: str, leave: str, *kinds: str) -> Rule:
    return Rule(name, re.compile(pattern), instead, hit, leave, kinds or (DOCSTRING, TEXT, CELL))


SENTENCE = r"(?:^|(?<=[.;:] )|(?<=[.;:]  ))"
WRITTEN = r"(?:file|folder|line|key|name|value|number|text|setting|section|figure|option|module|row)s?"

RULES = (
    _rule(
        "sentence begins with Of, What, Whether or Where",
        SENTENCE + r"(?:Of|What|Whether|Where)\b(?![^.?]*\?)(?!-if)",
        "begin with the subject or a verb; a condition begins with If",
        "Of a run are read its times. Where none is given, it is 0.",
        "What is a run? If no time is given, it is 0.",
    ),
    _rule(
        "what + clause for a noun",
        r"\bwhat (?:is|was|are|were|has|have|had|it|they|this|these|that|we|a|an|the|comes?|came|goes"
        r"|follows|remains|begins|stands|lies|needs?|makes?|takes?|does|changed|belongs)\b(?![^.?]*\?)",
        'a noun: "gaps" for "what is missing"',
        "It returns what is missing in the folder.",
        "It writes a what-if scene and says what went wrong, what to do. Do you know what it needs?",
    ),
    _rule(
        "is no X",
        r"(?<![Tt]here )\b(?:is|are|was|were) no (?!longer|more|less|fewer|later|earlier|larger|smaller"
        r"|better|worse|further|higher|lower|need|such|other)\w+",
        '"is not a X"',
        "The content is no decoded tile.",
        "There is no tile, and the error is no larger than before.",
    ),
    _rule(
        "holds no X, has no place, no X: ...",
        r"\b(?:holds?|held) no (?!longer\b|numbers\b)\w+|\bha(?:s|ve|d) no place\b|^(?:X: )?no [A-Z]\w+: ",
        '"contains no X", "not a X: ..."',
        "The archive holds no tour and has no place here.",
        "The archive contains no tour and is not a KMZ file.",
    ),
    _rule(
        "passive of machine behaviour",
        r"\b(?:is|are|was|were|be|been|being) (?:also |then |never |only )?"
        r"(?:told|said|asked|found|kept|given off|looked at|put|hung|taken along)\b",
        "the active verb: prints, reports, requests, finds, caches, emits",
        "The width is told by the header, and the frame is kept.",
        "The header gives the width. The file was not found.",
    ),
    _rule(
        "where for if",
        r"\bwhere (?:it|there|that|this|they|one|none|nothing|no \w+) "
        r"(?:is|are|was|were|has|have|had|can|cannot|would|may|does|exists?)\b",
        "if for a condition, where for a place, when for a time",
        "Zero where there is no wind.",
        "Zero if the run has no wind. Trees are drawn where the run has canopy fuel.",
    ),
    _rule(
        "vague or dated word",
        r"(?<!\w)(?:things?|alike|lacks?(?! of)|lacked|lacking|anew|beside|in vain|likewise|thereof|wholly"
        r"|(?:is|are|was|were|stays?) whole(?=[.,;:)]|$| (?:and|or|if|once)\b))(?![\w-])",
        "the noun; equal; miss, have no; again; next to, compared with; complete, intact",
        "The file lies beside the run and is whole.",
        "Heights are whole decimetres, nothing else, next to the run; for lack of memory.",
    ),
    _rule(
        "its own, by itself",
        r"\b(?:of (?:its|their|our) own|of (?:ours|theirs)|by (?:itself|themselves))\b",
        'the adjective: "a separate process", "alone"',
        "It runs in a process of its own.",
        "It runs in a separate process; a file of your own is read.",
    ),
    _rule(
        "that of, those of",
        r"\b(?:that which|those of|that of|the ones? of|those which)\b",
        "repeat the noun, or restructure",
        "Its threshold, that of fuel, is lower.",
        "The threshold of fuel is lower, and those below it are ignored.",
    ),
    _rule(
        "stands or lies for is",
        rf"\b{WRITTEN} (?:stands?|lies|lie|sits?)\b",
        "is, are placed, appears",
        "The names stand in the manifest.",
        "The names are in the manifest; trees stand on slopes.",
    ),
    _rule(
        "docstring of a function begins with a clause",
        r"^(?:How|If|When|That|Which|Who|Why|As|Whatever|So)\b",
        "begin with a verb in the imperative",
        "How far the front is.",
        "Return the distance to the front.",
        DOCSTRING,
    ),
    _rule(
        "row of a table of numbers is a clause",
        r"\b(?:is|are|was|were|has|have|stands?|lies)\b",
        'the quantity: "Largest mesh error / tolerance"',
        "largest error of a mesh is of its setting",
        "largest mesh error / tolerance",
        CELL,
    ),
)
