"""HTCondor: a DAG with a node per task and a final node, which assembles even if tasks have failed."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from pathlib import Path

from ... import files
from ...errors import UsageError
from ._engine import Batch, Engine, firetwin_command

_TRIES = 3  # requeues of a task that has no GPU or disk space
_GRACE = 60  # s from SIGTERM to SIGKILL

_DESCRIPTION = """\
universe = vanilla
executable = {executable}
arguments = {arguments}
transfer_executable = false
should_transfer_files = NO
kill_sig = SIGTERM
job_max_vacate_time = {grace}
log = log/nodes.log
output = log/{name}.out
error = log/{name}.out
batch_name = firetwin
{more}
queue
"""

_RETRY = """\
max_retries = {tries}
retry_until = ExitCode =!= 75
"""

_SUBMIT = """\
#!/bin/bash
# Submits the job; arguments are options of condor_submit_dag.
set -euo pipefail
cd {folder}
condor_submit_dag -force {options} "$@" film.dag | tee submitted.txt
grep -o 'submitted to cluster [0-9]*' submitted.txt | grep -o '[0-9]*$' >jobs.txt
"""


class HTCondor(Engine):
    """PARENT and CHILD order bake before render; a FINAL node assembles."""

    name = "htcondor"
    help = "HTCondor: condor_submit_dag with a node for each task"

    def write(self, batch: Batch) -> list[str]:
        """Write the DAG, the descriptions of its nodes and a script that submits it.

        Raises
        ------
        UsageError
            The name of the output folder contains a macro of HTCondor, or it or an option has several lines.
        """
        if "$(" in str(batch.out):
            raise UsageError(f"{batch.out}: HTCondor would expand $( as a macro; choose another --out")
        if not all(each.isprintable() for each in (str(batch.out), *batch.options)):
            raise UsageError("--out: HTCondor reads each line as a command; choose a name of one line")
        folder = self.folder(batch.out)
        (folder / "log").mkdir(parents=True, exist_ok=True)
        lines = [each for each in batch.options if "=" in each and not each.startswith("-")]
        options = [each for each in batch.options if each not in lines]
        out, retry = str(batch.out), _RETRY.format(tries=_TRIES).splitlines()
        task = _describe("$(stage)-$(number)", ["task", out, "$(number)"], [*retry, *lines])
        files.write_text(folder / "task.sub", task)
        files.write_text(folder / "assemble.sub", _describe("assemble", ["assemble", out], lines))
        files.write_text(folder / "film.dag", _write_dag(batch))
        submit = _SUBMIT.format(folder=shlex.quote(str(folder)), options=shlex.join(options))
        files.write_text(folder / "submit.sh", submit)
        return ["bash", str(folder / "submit.sh")]

    def cancel(self, out: Path) -> list[str]:
        """Return the command that removes the last submitted DAG with its nodes."""
        jobs = self.folder(out) / "jobs.txt"
        found = files.read_text(jobs).split() if jobs.exists() else []
        if not found:
            raise UsageError(f"{out}: no job was submitted to HTCondor from this folder")
        return ["condor_rm", *found]


def _describe(name: str, last: list[str], more: Iterable[str]) -> str:
    """Write the submit description of nodes."""
    program, *first = firetwin_command()
    macros = {"$(number)"}
    arguments = " ".join(each if each in macros else quote_argument(each) for each in [*first, "farm", *last])
    return _DESCRIPTION.format(
        executable=program.replace("$", "$(DOLLAR)"),
        arguments=f'"{arguments}"',
        grace=_GRACE,
        name=name,
        more="\n".join(more),
    )


def quote_argument(text: str) -> str:
    """Quote an argument for HTCondor's double-quoted argument lists."""
    text = text.replace('"', '""').replace("'", "''").replace("$", "$(DOLLAR)")
    return f"'{text}'"


def _write_dag(batch: Batch) -> str:
    """Write a node t1, t2, ... per task, and the edges from bakes to renders."""
    stages = {stage: batch.stage(stage) for stage in ("bake", "render")}
    lines = []
    for stage, numbers in stages.items():
        for number in numbers:
            lines += [f"JOB t{number} task.sub", f'VARS t{number} stage="{stage}" number="{number}"']
    before, after = (" ".join(f"t{number}" for number in stages[stage]) for stage in stages)
    if before and after:
        lines.append(f"PARENT {before} CHILD {after}")
    return "\n".join([*lines, "FINAL assemble assemble.sub"]) + "\n"


ENGINE = HTCondor
