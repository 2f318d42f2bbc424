"""Open Job Description: a job template, which `openjd run` executes on one machine."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from ... import files
from ...errors import UsageError
from ...shot.schema.frame_list import FrameList
from ..plan import FILE, job_dir
from ._engine import Batch, Engine, firetwin_command

_HOSTS = {
    "os": "attr.worker.os.family",
    "cores": "amount.worker.vcpu",
    "memory": "amount.worker.memory",
    "gpus": "amount.worker.gpu",
    "gpu_memory": "amount.worker.gpu.memory",
}
"""Options for requirements of hosts, and their names in the specification. Only render tasks need GPUs."""
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
        _, options = split_options(batch.options)
        return ["openjd", "run", str(path), "--job-param", f"file://{values}", *options]

    def cancel(self, out: Path) -> list[str]:
        """Refuse: `openjd run` runs in the foreground."""
        raise UsageError(f"{out}: stop openjd run with Ctrl-C or SIGTERM, which ends its tasks")


def paths(batch: Batch) -> dict[str, str]:
    """Return the path parameters, which a scheduler maps to the paths of each machine."""
    return {"Out": str(batch.out), "Job": str(job_dir(batch.out) / FILE), "Scene": batch.job.scene}


def template(batch: Batch) -> dict[str, Any]:
    """Build a job template of specification jobtemplate-2023-09 with TASK_CHUNKING."""
    _, *arguments = firetwin_command()
    needs, _ = split_options(batch.options)
    steps: list[dict[str, Any]] = []
    for stage in ("bake", "render"):
        if numbers := batch.stage(stage):
            before = [each["name"] for each in steps]
            run = _step(stage.title(), [*arguments, "farm", "task"], ["{{Task.Param.Tasks}}"], before)
            hosts = _host(needs if stage == "render" else _without_gpu(needs))
            steps.append(run | {"parameterSpace": _space(numbers)} | hosts)
    last = _step("Assemble", [*arguments, "farm", "assemble"], [], [each["name"] for each in steps])
    steps.append(last | _host(_without_gpu(needs)))
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


def split_options(options: tuple[str, ...]) -> tuple[dict[str, str], list[str]]:
    """Separate requirements of hosts, such as ``gpus=1``, from options of the command.

    Raises
    ------
    UsageError
        The value of a requirement is invalid.
    """
    needs: dict[str, str] = {}
    rest = []
    for each in options:
        name, found, value = each.partition("=")
        if not found or name not in _HOSTS:
            rest.append(each)
            continue
        needs[name] = value
        _requirement(name, value)
    return needs, rest


def _requirement(name: str, value: str) -> dict[str, Any]:
    """Convert a requirement: memory in MiB, an operating system, or a number."""
    key = _HOSTS[name]
    if name == "os":
        if value not in ("linux", "windows", "macos"):
            raise UsageError(f"os={value}: write linux, windows or macos")
        return {"name": key, "anyOf": [value]}
    size = re.fullmatch(r"(\d+(?:\.\d+)?)([MG]?)", value)
    if not size or float(size[1]) <= 0.0:
        raise UsageError(f"{name}={value}: write a number above 0, of memory with M or G, such as 16G")
    scale = 1024 if size[2] == "G" else 1
    return {"name": key, "min": int(float(size[1]) * scale)}


def _host(needs: dict[str, str]) -> dict[str, Any]:
    """Return the host requirements of a step; empty without any."""
    amounts = [_requirement(name, value) for name, value in needs.items() if name != "os"]
    attributes = [_requirement(name, value) for name, value in needs.items() if name == "os"]
    found = {"amounts": amounts, "attributes": attributes}
    return {"hostRequirements": {name: each for name, each in found.items() if each}} if needs else {}


def _without_gpu(needs: dict[str, str]) -> dict[str, str]:
    return {name: value for name, value in needs.items() if not name.startswith("gpu")}


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
