"""Code blocks of the pages: commands have options that exist, and TOML is valid.

`tests/system/test_documented_commands.py` runs the commands of docs/stations.md; `test_from_arrays.py` runs
the Python of docs/runs.md. A block that is not checked has ``<!-- not checked: REASON -->`` above it.
"""

import re
import shlex
import tomllib
from pathlib import Path

import pytest
from firetwin import cli, errors
from firetwin.farm.arguments import split_options

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"(?:^<!-- not checked: (.+?) -->\n)?^```([^\n]*)\n(.*?)^```", re.M | re.S)
SETUP = re.compile(r"python3 -m venv \w+$|[.\w]+/bin/pip install ")
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
PROGRAM = re.compile(r"(?:\.venv/bin/|firetwin/bin/|films/bin/)?firetwin ")


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
        cli._parser().parse_args(cli._current_names(split_options(words[1:])[0]))
    except SystemExit as error:
        return "" if error.code == 0 else "has arguments that do not exist"
    except errors.UsageError as error:
        return str(error)
    return ""


def faults(text):
    """Faults of the blocks of a page, each with its line."""
    found = []
    for reason, kind, code in BLOCK.findall(text):
        if reason or kind.strip() in ("mermaid", "text", "python"):
            continue
        if kind.strip() == "toml":
            try:
                tomllib.loads(code)
            except tomllib.TOMLDecodeError as error:
                found.append(f"{code}: {error}")
            continue
        found += [f"{line}: {why}" for line in code.splitlines() if (why := fault(line))]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_shown_commands_have_valid_arguments_or_a_mark(page):
    found = faults(page.read_text("utf-8"))
    assert not found, (
        f"{page.name}: correct these, or mark the block <!-- not checked: REASON -->:\n" + "\n".join(found)
    )


def test_a_wrong_option_and_a_block_without_a_mark_are_found(capsys):
    assert "do not exist" in faults("```sh\nfiretwin info RUN --nonsense\n```\n")[0]
    assert "not a command" in faults("```\nsbatch job\n```\n")[0]
    assert "no extra nonsense" in faults("```\n.venv/bin/pip install 'firetwin[nonsense]'\n```\n")[0]
    assert faults("```toml\na = \n```\n")
    assert not faults(
        "<!-- not checked: needs Slurm -->\n```\nsbatch job\n```\n```sh\nfiretwin info RUN\n```\n"
    )
