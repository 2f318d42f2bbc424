"""PBS Pro and OpenPBS: a job array for each stage, with dependencies."""

from __future__ import annotations

import re
import shlex
import subprocess
from pathlib import Path

from ... import files
from ...errors import UsageError
from . import _shell
from ._engine import Batch, Engine, find_command

LARGEST = 10_000  # max_array_size of a server that says nothing
_TRIES, _PAUSE = 3, 60  # of a task that has no device or disk now, and s between

_TASK = (
    """\
#!/bin/bash
# Runs the task at the array's index; Slurm's own qsub gives another variable.
tasks=({numbers})
number=${{tasks[${{PBS_ARRAY_INDEX:-${{SLURM_ARRAY_TASK_ID:-0}}}}]}}
exec >>{logs}/{stage}-"$number".out 2>&1
"""
    + _shell.RUN
    + """\
for try in {tries}; do # users of PBS may not put a job that runs back into the queue
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
# Submits the job; options of qsub that follow are for all of it.
set -euo pipefail
shopt -s inherit_errexit
cd {folder}
options=({options} "$@")
: >jobs.txt
submit() {{ # submit ARGUMENTS...: prints :ID, as lists of dependencies have it
  local id
  id=$(qsub -r y -j oe "${{options[@]}}" "$@")
  echo "$id" >>jobs.txt
  echo ":$id"
}}
bake= render=
# What comes first is held until all is submitted: a job that has ended is none to depend on.
{lines}
submit {after} -N firetwin-film assemble.sh >/dev/null
{release}
echo "submitted PBS jobs $(tr '\\n' ' ' <jobs.txt)"
"""

_CANCEL = """\
#!/bin/bash
# Deletes those jobs that have not ended.
status=0
while read -r id; do
  if qstat "$id" >/dev/null 2>&1; then
    qdel "$id" || status=1
  fi
done <{ids}
exit "$status"
"""


class PBS(Engine):
    """Arrays of at most `max_array_size` tasks: bake, then render, then assemble whatever became of those."""

    name = "pbs"
    help = "PBS Pro, OpenPBS: qsub with job arrays"

    def write(self, batch: Batch) -> list[str]:
        """Write the scripts."""
        folder = self.folder(batch.out)
        (folder / "log").mkdir(parents=True, exist_ok=True)
        about = {
            "command": shlex.join(find_command()),
            "out": shlex.quote(str(batch.out)),
            "logs": shlex.quote(str(folder / "log")),
        }
        lines = []
        for stage in ("bake", "render"):
            every, most = batch.stage(stage), find_largest()
            for start in range(0, len(every), most):
                numbers, name = every[start : start + most], f"{stage}-{start // most + 1}.sh"
                files.write_text(folder / name, _task(stage, numbers, about))
                lines.append(_line(batch, stage, name, len(numbers)))
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
        """Delete all jobs that were submitted last."""
        folder = self.folder(out)
        if not (folder / "jobs.txt").exists():
            raise UsageError(f"{out}: nothing was submitted to PBS from here")
        files.write_text(folder / "cancel.sh", _CANCEL.format(ids=shlex.quote(str(folder / "jobs.txt"))))
        return ["bash", str(folder / "cancel.sh")]


def find_largest() -> int:
    """How many tasks an array may have here."""
    try:
        shown = subprocess.run(["qstat", "-Bf"], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.SubprocessError):
        return LARGEST
    found = re.search(r"max_array_size\s*=\s*(\d+)", shown.stdout)
    return max(int(found[1]), 1) if found else LARGEST


def _first(batch: Batch) -> str:
    """The stage that waits for no other."""
    return "bake" if batch.stage("bake") else "render"


def _task(stage: str, numbers: list[int], about: dict[str, str]) -> str:
    """The script of an array: users of PBS cannot give arguments to scripts."""
    tries = range(1, _TRIES + 1)
    return _TASK.format(
        numbers=" ".join(map(str, numbers)),
        stage=stage,
        tries=" ".join(map(str, tries)),
        last=tries[-1],
        pause=_PAUSE,
        **about,
    )


def _line(batch: Batch, stage: str, script: str, count: int) -> str:
    """The line that submits an array. One of a single task is none to PBS."""
    order = "-h" if stage == _first(batch) else '-W "depend=afterok$bake"'
    array = f"-J 0-{count - 1} " if count > 1 else ""
    return f"{stage}=${stage}$(submit {order} {array}-N firetwin-{stage} {script})"


ENGINE = PBS
