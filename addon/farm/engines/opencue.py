"""OpenCue: a pyoutline script with the stages as layers and the tasks as frames."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from ... import files
from ...errors import UsageError
from ...shot.schema.frame_list import FrameList
from ._engine import Batch, Engine, firetwin_command

_SCRIPT = """\
# Launches the film on OpenCue with pyoutline: python launch.py [NAME=VALUE ...]
# NAME is an option of layers (cores, memory, gpus, tags, ...) or of the job (show, shot, server, ...).
import os
import sys

import outline
from outline.cuerun import OutlineLauncher
from outline.depend import DependType
from outline.modules.shell import Shell

NAME = {name!r}
LAYERS = {layers!r}  # name, command, task numbers as frames
OF_LAYERS = {of_layers!r}


def build(options):
    \"\"\"Create the launcher of the job.\"\"\"
    given = dict(option.split("=", 1) for option in options)
    for_layers = {{key: given.pop(key) for key in OF_LAYERS if key in given}}
    if "gpus" in for_layers:
        for_layers["gpus"] = int(for_layers["gpus"])
    job = outline.Outline(NAME)
    before = []
    for name, command, frames in LAYERS:
        layer = Shell(name, command=command, range=frames, chunk=1, **for_layers)
        job.add_layer(layer)
        for each in before:
            layer.depend_on(each, DependType.LayerOnLayer)
        before.append(layer)
    return OutlineLauncher(job, **given)


if __name__ == "__main__":
    launched = build(sys.argv[1:]).launch(use_pycuerun=False)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "jobs.txt"), "w") as file:
        file.writelines(job.name() + "\\n" for job in launched)
    print("launched OpenCue job", *(job.name() for job in launched))
"""
_OF_LAYERS = ("cores", "gpu_memory", "gpus", "memory", "service", "tags", "timeout", "timeout_llu")


class OpenCue(Engine):
    """Layers bake, render and assemble, each dependent on the previous ones."""

    name = "opencue"
    help = "OpenCue: a pyoutline job"

    def write(self, batch: Batch) -> list[str]:
        """Write the script."""
        path = self.folder(batch.out) / "launch.py"
        about = {"name": _job_name(batch), "layers": list_layers(batch), "of_layers": _OF_LAYERS}
        files.write_text(path, _SCRIPT.format(**about))
        return ["python3", str(path), *batch.options]

    def cancel(self, out: Path) -> list[str]:
        """Return the command that kills the last launched job."""
        jobs = self.folder(out) / "jobs.txt"
        if not jobs.exists():
            raise UsageError(f"{out}: no job was launched on OpenCue from this folder")
        return ["cueadmin", "-force", "-kill", *files.read_text(jobs).split()]


def _job_name(batch: Batch) -> str:
    """Make a job name that OpenCue accepts."""
    return re.sub(r"[^a-z0-9_]+", "_", f"firetwin_{Path(batch.job.scene).stem}".lower())


def list_layers(batch: Batch) -> list[tuple[str, str, str]]:
    """List name, command and frames of each layer; the command is quoted for a worker's shell."""
    out = shlex.quote(str(batch.out))
    farm = f"{shlex.join(firetwin_command())} farm"
    layers = [
        (stage, f"{farm} task {out} #IFRAME#", FrameList.of(numbers))
        for stage in ("bake", "render")
        if (numbers := batch.stage(stage))
    ]
    return [*layers, ("assemble", f"{farm} assemble {out}", "1-1")]


ENGINE = OpenCue
