"""Open Job Description: a job template, which `openjd run` executes on one machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ... import files
from ...errors import UsageError
from ...shot.schema.frame_list import FrameList
from ..plan import FILE, job_dir
from ._engine import Batch, Engine, firetwin_command

_GRACE = 60  # s from SIGTERM to SIGKILL
_CHUNK_SECONDS = 600  # target run time of a command that runs several tasks


class OpenJD(Engine):
    """Steps bake, render and assemble; a scheduler can run several tasks with one command."""

    name = "openjd"
    help = "Open Job Description: openjd run"

    def write(self, batch: Batch) -> list[str]:
        """Write the template and its parameter values."""
        folder = self.folder(batch.out)
        path, values = folder / "template.json", folder / "parameters.json"
        files.write_text(path, json.dumps(template(batch), indent=1) + "\n")
        files.write_text(
            values, json.dumps(paths(batch) | {"Program": firetwin_command()[0]}, indent=1) + "\n"
        )
        return ["openjd", "run", str(path), "--job-param", f"file://{values}", *batch.options]

    def cancel(self, out: Path) -> list[str]:
        """Refuse: `openjd run` runs in the foreground."""
        raise UsageError(f"{out}: stop openjd run with Ctrl-C or SIGTERM, which ends its tasks")


def paths(batch: Batch) -> dict[str, str]:
    """Return the path parameters, which a scheduler maps to the paths of each machine."""
    return {"Out": str(batch.out), "Job": str(job_dir(batch.out) / FILE), "Scene": batch.job.scene}


def template(batch: Batch) -> dict[str, Any]:
    """Build a job template of specification jobtemplate-2023-09 with TASK_CHUNKING."""
    _, *arguments = firetwin_command()
    steps: list[dict[str, Any]] = []
    for stage in ("bake", "render"):
        if numbers := batch.stage(stage):
            before = [each["name"] for each in steps]
            run = _step(stage.title(), [*arguments, "farm", "task"], ["{{Task.Param.Tasks}}"], before)
            steps.append(run | {"parameterSpace": _space(numbers)})
    steps.append(_step("Assemble", [*arguments, "farm", "assemble"], [], [each["name"] for each in steps]))
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "extensions": ["TASK_CHUNKING"],
        "name": f"Firetwin {Path(batch.job.scene).stem}"[:128],
        "parameterDefinitions": [
            _path("Out", "DIRECTORY", "OUT"),
            _path("Job", "FILE", "IN"),
            _path("Scene", "FILE", "IN"),
            {"name": "Program", "type": "STRING", "default": "python"},
        ],
        "steps": steps,
    }


def _path(name: str, kind: str, flow: str) -> dict[str, str]:
    return {"name": name, "type": "PATH", "objectType": kind, "dataFlow": flow}


def _step(name: str, command: list[str], last: list[str], before: list[str]) -> dict[str, Any]:
    """Build a step that runs a Firetwin command on the mapped path of the scene file."""
    action = {
        "command": "{{Param.Program}}",
        "args": [*command, "--scene", "{{Param.Scene}}", "{{Param.Out}}", *last],
        "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": _GRACE},
    }
    step: dict[str, Any] = {"name": name, "script": {"actions": {"onRun": action}}}
    return step | ({"dependencies": [{"dependsOn": each} for each in before]} if before else {})


def _space(numbers: list[int]) -> dict[str, Any]:
    chunks = {
        "defaultTaskCount": 1,
        "targetRuntimeSeconds": _CHUNK_SECONDS,
        "rangeConstraint": "CONTIGUOUS",
    }
    tasks = {"name": "Tasks", "type": "CHUNK[INT]", "range": FrameList.of(numbers), "chunks": chunks}
    return {"taskParameterDefinitions": [tasks]}


ENGINE = OpenJD
