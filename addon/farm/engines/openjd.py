"""Open Job Description: a job template, which `openjd run` runs on one machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ... import files
from ...errors import UsageError
from ...shot.schema import frame_list
from ..plan import FILE, place
from ._engine import Batch, Engine, find_command

_GRACE = 60  # s from the notice to a task until it is ended for certain
_CHUNK_SECONDS = 600  # an engine that may, gives tasks one after the other to a command for so long


class OpenJD(Engine):
    """Steps bake, render and assemble; an engine may run several tasks with one command."""

    name = "openjd"
    help = "Open Job Description: openjd run"

    def write(self, batch: Batch) -> list[str]:
        """Write the template and the values of its parameters."""
        folder = self.folder(batch.out)
        path, values = folder / "template.json", folder / "parameters.json"
        files.write_text(path, json.dumps(template(batch), indent=1) + "\n")
        files.write_text(values, json.dumps(paths(batch) | {"Program": find_command()[0]}, indent=1) + "\n")
        return ["openjd", "run", str(path), "--job-param", f"file://{values}", *batch.options]

    def cancel(self, out: Path) -> list[str]:
        """There is nothing to tell: `openjd run` runs while one waits for it."""
        raise UsageError(f"{out}: openjd run ends its tasks by Ctrl-C or SIGTERM")


def paths(batch: Batch) -> dict[str, str]:
    """Values of the parameters that are paths: an engine maps them to those of another machine."""
    return {"Out": str(batch.out), "Job": str(place(batch.out) / FILE), "Scene": batch.job.scene}


def template(batch: Batch) -> dict[str, Any]:
    """A job template of specification jobtemplate-2023-09 with TASK_CHUNKING."""
    _, *arguments = find_command()
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
    """A step that runs a command of ours; the scene file is where the engine has mapped it to."""
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
    tasks = {"name": "Tasks", "type": "CHUNK[INT]", "range": frame_list.write(numbers), "chunks": chunks}
    return {"taskParameterDefinitions": [tasks]}


ENGINE = OpenJD
