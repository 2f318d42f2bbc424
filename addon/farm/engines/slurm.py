"""Slurm: a job array per stage, with dependencies. Needs Slurm 22.05 or later."""

from __future__ import annotations

import re
import shlex
import subprocess
from collections import defaultdict
from pathlib import Path

from ... import files
from ...errors import UsageError
from ...shot.schema.frame_list import FrameList
from . import _shell
from ._engine import Batch, Engine, firetwin_command

DEFAULT_MAX_ARRAY_SIZE = 1001  # default MaxArraySize of Slurm: indices are below it
_WARNING = 120  # s before the time limit, when a task receives SIGTERM
_TRIES = 3  # requeues of a task

_TASK = (
    """\
#!/bin/bash
# Runs task BASE + SLURM_ARRAY_TASK_ID of the job: sbatch --array=... {name} BASE
"""
    + _shell.RUN
    + """\
run {command} farm task {out} $(($1 + ${{SLURM_ARRAY_TASK_ID:-0}}))
status=$?
# 75: no GPU or disk space; 143: the time limit is near. A cancelled task is no longer RUNNING.
if [[ $status = 75 || $status = 143 ]] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt {tries} ] &&
  [ "$(squeue -h -j "$SLURM_JOB_ID" -o %T)" = RUNNING ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$status"
"""
)

_ASSEMBLE = """\
#!/bin/bash
exec {command} farm assemble {out}
"""

_SUBMIT = """\
#!/bin/bash
# Submits the job; arguments are options of sbatch for all its parts.
set -euo pipefail
shopt -s inherit_errexit
options=({options} "$@")
ids={ids}
: >"$ids"
submit() {{ # submit DEPENDENCY ARGUMENTS...: prints the number of the Slurm job
  local number
  number=$(sbatch --parsable --requeue --open-mode=append ${{1:+"--dependency=$1"}} \\
    "${{defaults[@]}}" "${{options[@]}}" "${{@:2}}")
  number=${{number%%;*}}
  echo "$number" >>"$ids"
  echo "$number"
}}
array=(--output={logs}/%x-%A_%a.out)
defaults=(--signal=B:TERM@{warning}) # for tasks; the options above override them
bake= render=
{lines}
defaults=()
submit "${{render:+afterany$render}}" --job-name=firetwin-assemble --output={logs}/%x-%j.out \\
  {assemble} >/dev/null
echo "submitted Slurm jobs $(tr '\\n' ' ' <"$ids")"
"""


class Slurm(Engine):
    """Arrays of at most `MaxArraySize` tasks: bake, render, then assemble even if tasks have failed."""

    name = "slurm"
    help = "Slurm: sbatch with job arrays"

    def write(self, batch: Batch) -> list[str]:
        """Write the scripts."""
        folder = self.folder(batch.out)
        (folder / "log").mkdir(parents=True, exist_ok=True)
        names = {
            name: shlex.quote(str(folder / name)) for name in ("task.sh", "assemble.sh", "jobs.txt", "log")
        }
        about = {
            "command": shlex.join(firetwin_command()),
            "out": shlex.quote(str(batch.out)),
            "tries": _TRIES,
        }
        files.write_text(folder / "task.sh", _TASK.format(name="task.sh", **about))
        files.write_text(folder / "assemble.sh", _ASSEMBLE.format(**about))
        submit = _SUBMIT.format(
            options=shlex.join(batch.options),
            ids=names["jobs.txt"],
            logs=names["log"],
            warning=_WARNING,
            lines="\n".join(_submit_lines(batch, names["task.sh"], max_array_size())),
            assemble=names["assemble.sh"],
        )
        files.write_text(folder / "submit.sh", submit)
        return ["bash", str(folder / "submit.sh")]

    def cancel(self, out: Path) -> list[str]:
        """Return the command that cancels the last submitted jobs."""
        ids = self.folder(out) / "jobs.txt"
        found = files.read_text(ids).split() if ids.exists() else []
        if not found:
            raise UsageError(f"{out}: no job was submitted to Slurm from this folder")
        return ["scancel", *found]


def split_arrays(numbers: list[int], most: int) -> list[tuple[int, str]]:
    """Split task numbers into arrays: base number, and list of indices below `most` for --array."""
    parts = defaultdict(list)
    for number in numbers:
        parts[number // most * most].append(number)
    return [(base, FrameList.of(number - base for number in part)) for base, part in parts.items()]


def max_array_size() -> int:
    """Find the limit of array indices (MaxArraySize) on this cluster."""
    try:
        shown = subprocess.run(["scontrol", "show", "config"], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.SubprocessError):
        return DEFAULT_MAX_ARRAY_SIZE
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", shown.stdout, re.MULTILINE)
    return max(int(found[1]), 1) if found else DEFAULT_MAX_ARRAY_SIZE


def _submit_lines(batch: Batch, script: str, most: int) -> list[str]:
    """Write the lines that submit the arrays of each stage and collect their job numbers."""
    lines = []
    for stage, after in (("bake", ""), ("render", "${bake:+afterok$bake}")):
        wait = f'"{after}" --kill-on-invalid-dep=yes' if after else '""'
        for base, listed in split_arrays(batch.stage(stage), most):
            call = (
                f'submit {wait} "${{array[@]}}" --job-name=firetwin-{stage} --array={listed} {script} {base}'
            )
            lines.append(f"{stage}={'$' + stage}:$({call})")
    return lines


ENGINE = Slurm
