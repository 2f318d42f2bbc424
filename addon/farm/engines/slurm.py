"""Slurm: a job array for each stage, with dependencies. Options are those that 22.05 and later know."""

from __future__ import annotations

import re
import shlex
import subprocess
from collections import defaultdict
from pathlib import Path

from ... import files
from ...errors import UsageError
from ...shot.schema import frame_list
from . import _shell
from ._engine import Batch, Engine, find_command

LARGEST = 1001  # Slurm's own MaxArraySize: indices are below it
_WARNING = 120  # s before the time limit at which a task is told to end
_TRIES = 3  # how often a task is put into the queue again

_TASK = (
    """\
#!/bin/bash
# Runs task BASE + SLURM_ARRAY_TASK_ID of the job: sbatch --array=... {name} BASE
"""
    + _shell.RUN
    + """\
run {command} farm task {out} $(($1 + ${{SLURM_ARRAY_TASK_ID:-0}}))
status=$?
# 75: no device or disk now; 143: the time limit is near. A task that was cancelled is not RUNNING any more.
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
# Submits the job; options of sbatch that follow are for all of it.
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
defaults=(--signal=B:TERM@{warning}) # of tasks; options given above win
bake= render=
{lines}
defaults=()
submit "${{render:+afterany$render}}" --job-name=firetwin-assemble --output={logs}/%x-%j.out \\
  {assemble} >/dev/null
echo "submitted Slurm jobs $(tr '\\n' ' ' <"$ids")"
"""


class Slurm(Engine):
    """Arrays of at most `MaxArraySize` tasks: bake, then render, then assemble whatever became of those."""

    name = "slurm"
    help = "Slurm: sbatch with job arrays"

    def write(self, batch: Batch) -> list[str]:
        """Write the scripts."""
        folder = self.folder(batch.out)
        (folder / "log").mkdir(parents=True, exist_ok=True)
        names = {
            name: shlex.quote(str(folder / name)) for name in ("task.sh", "assemble.sh", "jobs.txt", "log")
        }
        about = {"command": shlex.join(find_command()), "out": shlex.quote(str(batch.out)), "tries": _TRIES}
        files.write_text(folder / "task.sh", _TASK.format(name="task.sh", **about))
        files.write_text(folder / "assemble.sh", _ASSEMBLE.format(**about))
        submit = _SUBMIT.format(
            options=shlex.join(batch.options),
            ids=names["jobs.txt"],
            logs=names["log"],
            warning=_WARNING,
            lines="\n".join(_lines(batch, names["task.sh"], largest())),
            assemble=names["assemble.sh"],
        )
        files.write_text(folder / "submit.sh", submit)
        return ["bash", str(folder / "submit.sh")]

    def cancel(self, out: Path) -> list[str]:
        """Cancel all jobs that were submitted last."""
        ids = self.folder(out) / "jobs.txt"
        found = ids.read_text("utf-8").split() if ids.exists() else []
        if not found:
            raise UsageError(f"{out}: nothing was submitted to Slurm from here")
        return ["scancel", *found]


def arrays(numbers: list[int], most: int) -> list[tuple[int, str]]:
    """Bases and lists of indices, as --array takes them, of task numbers; indices are below `most`."""
    parts = defaultdict(list)
    for number in numbers:
        parts[number // most * most].append(number)
    return [(base, frame_list.write(number - base for number in part)) for base, part in parts.items()]


def largest() -> int:
    """How many tasks an array may have here."""
    try:
        shown = subprocess.run(["scontrol", "show", "config"], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.SubprocessError):
        return LARGEST
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", shown.stdout, re.MULTILINE)
    return max(int(found[1]), 1) if found else LARGEST


def _lines(batch: Batch, script: str, most: int) -> list[str]:
    """Lines that submit the arrays of each stage, and gather their numbers."""
    lines = []
    for stage, after in (("bake", ""), ("render", "${bake:+afterok$bake}")):
        wait = f'"{after}" --kill-on-invalid-dep=yes' if after else '""'
        for base, listed in arrays(batch.stage(stage), most):
            call = (
                f'submit {wait} "${{array[@]}}" --job-name=firetwin-{stage} --array={listed} {script} {base}'
            )
            lines.append(f"{stage}={'$' + stage}:$({call})")
    return lines


ENGINE = Slurm
