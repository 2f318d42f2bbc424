"""The glossary: its places exist, and files are named by its terms."""

import re
from pathlib import Path

import pytest
from firetwin import cli
from firetwin.shot import passes, schema
from firetwin.shot.settings import Settings

ROOT = Path(__file__).parents[3]
GLOSSARY = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
ROWS = [line.split(" | ") for line in GLOSSARY.splitlines() if line.startswith("| ") and "`" in line]
NO_NAMES = (
    *(
        "sight",
        "seen",
        "hidden",
        "alone",
        "beside",
        "claim",
        "claims",
        "shown",
        "whole",
        "outlook",
        "moments",
    ),
    *("boxes", "headway", "made", "needed", "classic", "standing", "fate", "openings", "aims", "named"),
)
"""Words that say too little about a module, such as `claims` for leases."""
RIDDLES = (
    *("what is far", "can tell", "is told", "are told", "thing", "somebody", "no camera sees", "who wants"),
    *("where it is", "where it ends", "how far", "how long", "how strong", "how much", "how many"),
    *("moment", "edge of the world", "the world", "as it stands", "goes on", "take away", "beside the first"),
    *("made up", "made-up", "nowhere", "for ever", "whatever", "wherever", "rivals", "know no", "knows no"),
)
"""Phrases that replace a term of the field or a plain sentence."""


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0].strip("| "))
def test_a_term_is_where_the_glossary_says(row):
    places = re.findall(r"`((?:addon|cpp|tests|data)[\w/.]*)`", row[-1])
    assert places or "field" in row[-1] or "setting" in row[-1]
    for place in places:
        assert (ROOT / place).exists(), place


def test_no_term_is_there_twice():
    terms = [term.strip() for row in ROWS for term in row[0].strip("| ").split(",")]
    assert len(terms) == len(set(terms)) >= 60


def test_modules_of_the_add_on_are_named_by_terms():
    wrong = [path for path in (ROOT / "addon").rglob("*.py") if path.stem.strip("_") in NO_NAMES]
    assert not wrong


def helps_of_settings():
    """Help of every section, key, choice and kind of camera, by name."""
    for section, part in schema.walk(Settings):
        name = ".".join((*section, part.name))
        yield name, part.key.help
        yield from ((f"{name} = {choice}", words) for choice, words in part.key.names().items())
        kinds = part.key.variants() if part.key.variants else {}
        yield from ((f"{name}: {kind}", schema.summary(made)) for kind, made in kinds.items())


def help_of_command(line, capsys):
    """Return the output of a command line with --help."""
    with pytest.raises(SystemExit):
        cli.main([*line, "--help"])
    return capsys.readouterr().out


def riddles(text):
    return [phrase for phrase in RIDDLES if re.search(rf"\b{phrase}s?\b", text, re.IGNORECASE)]


def test_helps_of_settings_and_passes_hold_no_riddle():
    helps = [*helps_of_settings(), *passes.helps().items()]
    assert len(helps) > 200
    assert not {name: found for name, text in helps if (found := riddles(text))}


def test_helps_of_commands_hold_no_riddle(capsys):
    overview = help_of_command([], capsys)
    commands = re.findall(r"^    (\w+)  ", overview, re.MULTILINE)
    assert {"sample", "render", "score", "bench"} <= set(commands)
    helps = {"firetwin": overview} | {name: help_of_command([name], capsys) for name in commands}
    lines = {name: " ".join(text.split()) for name, text in helps.items()}
    assert not {name: found for name, text in lines.items() if (found := riddles(text))}
