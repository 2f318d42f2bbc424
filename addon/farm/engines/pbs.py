"""PBS Pro and OpenPBS: a job array per stage, with dependencies."""

from __future__ import annotations

import re
import shlex
import subprocess
from pathlib import Path

from ... import files
from ...errors import UsageError
from . import _shell
from ._engine import Batch, Engine, firetwin_command

DEFAULT_MAX_ARRAY_SIZE = 10_000  # default max_array_size of PBS servers
_TRIES, _PAUSE = 3, 60  # attempts at a task that has no GPU or disk space, and s between them

_TASK = (
    """\
#!/bin/bash
# Runs the task at the index of the array; Slurm's qsub emulation sets a different variable.
tasks=({numbers})
number=${{tasks[${{PBS_ARRAY_INDEX:-${{SLURM_ARRAY_TASK_ID:-0}}}}]}}
exec >>{logs}/{stage}-"$number".out 2>&1
"""
    + _shell.RUN
    + """\
for try in {tries}; do # users of PBS cannot requeue a running job
  run {command} farm task {out} "$number"
  status=$?
  [[ $status = 75 && $try != {last} && -z $ended ]] && run sleep {pause} || break
done
exit "$status"
"""
)

_ASSEMBLE = """\
#!/bin/bash
exec >>{logs}/assemble.out 2>&1
exec {command} farm assemble {out}
"""

_SUBMIT = """\
#!/bin/bash
# Submits the job; arguments are options of qsub for all its parts.
set -euo pipefail
shopt -s inherit_errexit
cd {folder}
options=({options} "$@")
: >jobs.txt
submit() {{ # submit ARGUMENTS...: prints :ID, for lists of dependencies
  local id
  id=$(qsub -r y -j oe "${{options[@]}}" "$@")
  echo "$id" >>jobs.txt
  echo ":$id"
}}
bake= render=
# The first stage is held until everything is submitted: jobs cannot depend on a job that has ended.
{lines}
submit {after} -N firetwin-film assemble.sh >/dev/null
{release}
echo "submitted PBS jobs $(tr '\\n' ' ' <jobs.txt)"
"""

_CANCEL = """\
#!/bin/bash
# Deletes the jobs that have not ended.
status=0
while read -r id; do
  if qstat "$id" >/dev/null 2>&1; then
    qdel "$id" || status=1
  fi
done <{ids}
exit "$status"
"""


class PBS(Engine):
    """Arrays of at most `max_array_size` tasks: bake, render, then assemble even if tasks have failed."""

    name = "pbs"
    help = "PBS Pro, OpenPBS: qsub with job arrays"

    def write(self, batch: Batch) -> list[str]:
        """Write the scripts."""
        folder = self.folder(batch.out)
        (folder / "log").mkdir(parents=True, exist_ok=True)
        about = {
            "command": shlex.join(firetwin_command()),
            "out": shlex.quote(str(batch.out)),
            "logs": shlex.quote(str(folder / "log")),
        }
        lines = []
        for stage in ("bake", "render"):
            every, most = batch.stage(stage), max_array_size()
            for start in range(0, len(every), most):
                numbers, name = every[start : start + most], f"{stage}-{start // most + 1}.sh"
                files.write_text(folder / name, _task(stage, numbers, about))
                lines.append(_submit_line(batch, stage, name, len(numbers)))
        files.write_text(folder / "assemble.sh", _ASSEMBLE.format(**about))
        submit = _SUBMIT.format(
            folder=shlex.quote(str(folder)),
            options=shlex.join(batch.options),
            lines="\n".join(lines),
            after='-W "depend=afterany$bake$render"' if lines else "",
            release=f"qrls ${{{_first(batch)}//:/ }}" if lines else ":",
        )
        files.write_text(folder / "submit.sh", submit)
        return ["bash", str(folder / "submit.sh")]

    def cancel(self, out: Path) -> list[str]:
        """Return the command that deletes the last submitted jobs."""
        folder = self.folder(out)
        if not (folder / "jobs.txt").exists():
            raise UsageError(f"{out}: no job was submitted to PBS from this folder")
        files.write_text(folder / "cancel.sh", _CANCEL.format(ids=shlex.quote(str(folder / "jobs.txt"))))
        return ["bash", str(folder / "cancel.sh")]


def max_array_size() -> int:
    """Find the maximum number of tasks in an array."""
    try:
        shown = subprocess.run(["qstat", "-Bf"], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.SubprocessError):
        return DEFAULT_MAX_ARRAY_SIZE
    found = re.search(r"max_array_size\s*=\s*(\d+)", shown.stdout)
    return max(int(found[1]), 1) if found else DEFAULT_MAX_ARRAY_SIZE


def _first(batch: Batch) -> str:
    """Return the first stage of a batch."""
    return "bake" if batch.stage("bake") else "render"


def _task(stage: str, numbers: list[int], about: dict[str, str]) -> str:
    """Write the script of an array, with its task numbers: qsub passes no arguments to scripts."""
    tries = range(1, _TRIES + 1)
    return _TASK.format(
        numbers=" ".join(map(str, numbers)),
        stage=stage,
        tries=" ".join(map(str, tries)),
        last=tries[-1],
        pause=_PAUSE,
        **about,
    )


def _submit_line(batch: Batch, stage: str, script: str, count: int) -> str:
    """Write the line that submits an array, or a plain job for a single task, as PBS requires."""
    order = "-h" if stage == _first(batch) else '-W "depend=afterok$bake"'
    array = f"-J 0-{count - 1} " if count > 1 else ""
    return f"{stage}=${stage}$(submit {order} {array}-N firetwin-{stage} {script})"


ENGINE = PBS
