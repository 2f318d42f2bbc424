"""Text that goes out: whatever a file holds, one line that no terminal acts upon."""

import argparse
import unicodedata

import pytest
from firetwin import argument_types, escaped, progress
from firetwin.run import citations
from hypothesis import example, given
from hypothesis import strategies as st


@given(st.text())
@example("a\x1b[31mred\nnew\x9b31m\u202eabc\u2028\u2066\x7f\ufeff")
def test_nothing_that_a_terminal_acts_upon_is_left(text):
    shown = escaped.escaped(text)
    assert not {"Cc", "Cf", "Zl", "Zp"} & {unicodedata.category(character) for character in shown}
    assert shown.splitlines() == ([shown] if shown else [])
    assert escaped.escaped(shown) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ('plain "text" of a run\\b, 12 °C', 'plain "text" of a run\\b, 12 °C'),
        ("a\x1b[31m\n\tb", "a\\x1b[31m\\n\\tb"),
        ("\x85\x9b31m", "\\x85\\x9b31m"),
        ("\u202egpj.exe\u2069", "\\u202egpj.exe\\u2069"),
        ("\U000e0041", "\\U000e0041"),
        ("日本 é 🔥", "日本 é 🔥"),
        ("run\udcff", "run\udcff"),  # a byte of a name; it goes out as that byte
    ],
)
def test_what_is_shown(text, shown):
    assert escaped.escaped(text) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("https://user:pa@ss@host/a?key=abc&x=1 is bad", "https://...@host/a?key=...&x=1 is bad"),
        ("mail a@b.org of https://h/x", "mail a@b.org of https://h/x"),
        ("https://h/{z}?key=${FIRETWIN_KEY_A}", "https://h/{z}?key=${FIRETWIN_KEY_A}"),
        ("https://h:80/a@b?x=1&access_token=t0k", "https://h:80/a@b?x=1&access_token=..."),
    ],
)
def test_a_message_has_no_secret_of_a_url(text, shown):
    assert escaped.message(text) == shown


def test_citations_are_escaped_for_people(capsys):
    citations.show([{"kind": "run", "text": "a\u202eb\x1b[31m"}], as_json=False)
    assert capsys.readouterr().out == "run           a\\u202eb\\x1b[31m\n"


@pytest.mark.parametrize("text", ["0001-01-01T00:00+14:00", "9999-12-31T23:59-12:00", "999-01-01T00:00Z"])
def test_times_of_options_have_years_of_runs(text):
    with pytest.raises(argparse.ArgumentTypeError, match=r"years 1000 to 9998|must be a time"):
        argument_types.moment(text)


def test_a_long_message_keeps_its_beginning_and_its_end():
    shown = escaped.message("file.toml: " + "x" * 100_000 + "; do this")
    assert len(shown) < 2100
    assert shown.startswith("file.toml: xxx")
    assert shown.endswith("xxx; do this")


class Terminal:
    """Texts for a terminal."""

    def __init__(self):
        self.text = ""

    def isatty(self):
        return True

    def write(self, text):
        self.text += text

    def flush(self):
        pass


def test_messages_and_progress_are_escaped(capsys):
    progress.say("a\x1b[31m\nb")
    progress.Reporter()(1, 1, "work\x1b[2J", "last: \x9bc")
    assert capsys.readouterr().err.splitlines() == [
        "firetwin: a\\x1b[31m\\nb",
        "firetwin: work\\x1b[2J, took 0 s, last: \\x9bc",
    ]


def test_results_are_escaped_on_a_terminal_and_are_what_they_are_elsewhere(capsys, monkeypatch):
    progress.result("a\x1b[31m\nb")
    assert capsys.readouterr().out == "a\x1b[31m\nb\n"
    terminal = Terminal()
    monkeypatch.setattr("sys.stdout", terminal)
    progress.result("a\x1b[31m\nb")
    assert terminal.text == "a\\x1b[31m\nb\n"
