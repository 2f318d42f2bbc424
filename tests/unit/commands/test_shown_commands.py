"""Code blocks of the pages: commands have options that exist, TOML is valid, and all run or have a mark.

`tests/system/test_documented_commands.py` runs them; `test_from_arrays.py` runs the Python of docs/runs.md.
`tests/helpers/shown_code.py` explains the marks.
"""

import re
import shlex
import tomllib

import pytest
from firetwin import cli, errors
from shown_code import PAGES, PROGRAM, ROOT, RUN, blocks

SETUP = re.compile(r"python3 -m venv \w+$|[.\w]+/bin/pip install ")
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]


def fault(line):
    """Why a line is not a command of ours whose arguments are valid; empty if it is."""
    words = shlex.split(line, comments=True)
    if not words:
        return ""
    if (ROOT / words[0]).suffix == ".sh":
        return "" if (ROOT / words[0]).is_file() else "there is no such script"
    if SETUP.match(line):
        unknown = [extra for extra in re.findall(r"firetwin\[(\w+)\]", line) if extra not in EXTRAS]
        return f"pyproject.toml has no extra {unknown[0]}" if unknown else ""
    if not PROGRAM.match(line):
        return "is not a command of Firetwin"
    try:
        cli.parse(words[1:])
    except SystemExit as error:
        return "" if error.code == 0 else "has arguments that do not exist"
    except errors.UsageError as error:
        return str(error)
    return ""


def faults(text):
    """Faults of the blocks of a page, each with its line."""
    errors = []
    for block in blocks(text):
        if block.mark == "not checked" or block.kind in ("mermaid", "text", "python"):
            continue
        if block.kind == "toml":
            try:
                tomllib.loads(block.code)
            except tomllib.TOMLDecodeError as error:
                errors.append(f"{block.code}: {error}")
            continue
        errors += [f"{line}: {why}" for line in block.code.splitlines() if (why := fault(line))]
    return errors


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_shown_commands_have_valid_arguments_or_a_mark(page):
    found = faults(page.read_text("utf-8"))
    assert not found, (
        f"{page.name}: correct these, or mark the block <!-- not checked: REASON -->:\n" + "\n".join(found)
    )


@pytest.mark.parametrize(
    "page", [each for each in PAGES if each.name not in {*RUN, "README.md"}], ids=lambda path: path.name
)
def test_commands_and_python_run_or_have_a_mark(page):
    """README.md has no space for marks: docs/pipelines.md and docs/index.md have its commands with theirs."""
    idle = [line for each in blocks(page.read_text("utf-8")) if each.is_code for line in each.lines()]
    assert not idle, f"{page.name}: run these in test_documented_commands.py, or mark them: {idle}"


def test_marks_exclude_blocks_and_lines():
    text = (
        "```sh\na\nb --x\n```\n<!-- not run: slow -->\n```\nc\n```\n"
        "<!-- not run (--x): slow -->\n```\nd\ne --x\n```\n"
    )
    assert [list(each.lines()) for each in blocks(text)] == [["a", "b --x"], [], ["d"]]
    assert [each.reason for each in blocks(text)] == ["", "slow", "slow"]
    assert not faults("<!-- run by a.py -->\n```python\nx\n```\n")


def test_a_wrong_option_and_a_block_without_a_mark_are_found(capsys):
    assert "do not exist" in faults("```sh\nfiretwin info RUN --nonsense\n```\n")[0]
    assert "not a command" in faults("```\nsbatch job\n```\n")[0]
    assert "no extra nonsense" in faults("```\n.venv/bin/pip install 'firetwin[nonsense]'\n```\n")[0]
    assert faults("```toml\na = \n```\n")
    assert not faults(
        "<!-- not checked: needs Slurm -->\n```\nsbatch job\n```\n```sh\nfiretwin info RUN\n```\n"
    )
