"""The check of wording: each rule hits its example and leaves the other, and hits have the right line."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests/prose"))

import passages  # noqa: E402
import report  # noqa: E402
import rules  # noqa: E402


def broken(text, kind):
    return [rule.name for _, _, rule in report.check_passage(passages.Passage(1, [text], kind))]


@pytest.mark.parametrize("rule", rules.RULES, ids=lambda rule: rule.name)
def test_a_rule_hits_its_example_and_leaves_the_other(rule):
    assert rule.name in broken(rule.hit, rule.kinds[0])
    assert not broken(rule.leave, rule.kinds[0])


def test_a_rule_for_docstrings_leaves_comments():
    assert broken("How far the front is.", rules.DOCSTRING)
    assert not broken("How far the front is.", rules.TEXT)


PYTHON = '''\
"""A module, and what is in it."""

x = 1  # of its own


def f():
    """Return x.

    Where none is given, it is 0.
    """
    # The first line of this comment ends before the name, which
    # is told by the header.
    raise ValueError(f"the file {x} is no decoded tile of {x}; delete it")


class A:
    @property
    def b(self):
        """How far the front is, in ``what is code``."""
'''
CPP = """\
/// Its threshold is that of
/// fuel.
int a = 1'000;  // as 'b' is no c
/* One block
 * is found. */
auto text = "The tiles are "
            "kept in the cache";
auto path = "what is";
"""
PAGE = """\
# What it writes

A paragraph that goes on, where
there is no wind, and `what is code`.

- An item, beside [what is linked](beside.md).

```sh
echo what is code
```

| quantity | value |
|---|---|
| error of a mesh is of its setting | 0.5 m |
| what it reads | text |
"""
SHELL = """\
#!/usr/bin/env bash
# The table of what is
# missing.
echo "# what is $#"  # beside it
"""


@pytest.mark.parametrize(
    ("read", "text", "lines"),
    [
        (passages.read_python, PYTHON, [1, 3, 9, 12, 13]),
        (passages.read_cpp, CPP, [1, 3, 5, 6]),
        (passages.read_page, PAGE, [3, 6, 6, 14, 15]),
        (passages.read_hash_comments, SHELL, [2, 4]),
    ],
    ids=["python", "cpp", "page", "shell"],
)
def test_hits_have_the_line_of_their_first_word(read, text, lines):
    assert sorted(line for passage in read(text) for line, _, _ in report.check_passage(passage)) == lines


def test_python_may_not_say_is_no_x_at_any_rate(tmp_path, monkeypatch, capsys):
    (tmp_path / "a.py").write_text('"""' + "Word. " * 9000 + '"""\n\nX = "the file is no tile; delete it"\n')
    monkeypatch.setattr(report, "ROOT", tmp_path)
    monkeypatch.setattr(sys, "argv", ["prose", "a.py"])
    assert report.main() == 1
    assert "a.py:3: " in capsys.readouterr().out


NAMES = """\
class Here:
    pass


def far(found):
    def inner(known):
        return known

    made = 1
    # A comment.
    return inner(made) + found


def near():
    known = [made for made in range(3)]
    return known
"""


@pytest.mark.parametrize(("old", "status"), [("", 1), ("found", 1), ("Here", 1), ("found|Here", 0)])
def test_names_that_live_long_and_definitions_fail_with_their_lines(
    tmp_path, monkeypatch, capsys, old, status
):
    (tmp_path / "addon").mkdir()
    (tmp_path / "addon/a.py").write_text(re.sub(old, "fire", NAMES) if old else NAMES)
    monkeypatch.setattr(report, "ROOT", tmp_path)
    monkeypatch.setattr(sys, "argv", ["prose", "addon"])
    assert report.main() == status
    error = capsys.readouterr().err
    assert ("a.py:1: Here, for 0 lines" in error) == ("Here" not in old)
    assert ("a.py:5: found, for 6 lines" in error) == ("found" not in old)
    assert "known" not in error


@pytest.mark.parametrize(("words", "status"), [(500, 1), (1000, 0)])
def test_a_rate_over_the_limit_fails_with_the_line_and_a_hint(tmp_path, monkeypatch, capsys, words, status):
    (tmp_path / "README.md").write_text("\n" + "word " * (words - 2) + "anew.\n")
    monkeypatch.setattr(report, "ROOT", tmp_path)
    monkeypatch.setattr(sys, "argv", ["prose", "README.md"])
    assert report.main() == status
    out, error = capsys.readouterr()
    assert ("README.md:2: " in out and "again" in out and "2.0 hits" in error) == bool(status)


def test_the_table_has_folders_of_two_levels_and_pages():
    command = [sys.executable, ROOT / "tests/prose", "--table", "docs/how", "addon/shot"]
    table = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    places = {line.split()[0] for line in table.splitlines()}
    assert {"addon/shot", "docs/how/smoke.md", "all"} <= places
